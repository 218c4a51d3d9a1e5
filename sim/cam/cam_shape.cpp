#include "sim/cam/cam_shape.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "sim/cam/profile_spans.hpp"

namespace beamcam::sim {
namespace {

constexpr int kCount = 10;  // coefficients of a piece, nodes of its fit

double reduced(double alpha) {
    const double turn = alpha - kFullTurn * std::floor(alpha / kFullTurn);
    return turn < kFullTurn ? turn : 0;
}

template <std::size_t n>
double polynomial(const std::array<double, n>& c, double z) {
    double value = c[n - 1];
    for (std::size_t k = n - 1; k-- > 0;) value = value * z + c[k];
    return value;
}

template <std::size_t n>
double polynomial_slope(const std::array<double, n>& c, double z) {
    double value = static_cast<double>(n - 1) * c[n - 1];
    for (std::size_t k = n - 1; k-- > 1;) value = value * z + static_cast<double>(k) * c[k];
    return value;
}

// Interpolation at the zeros of the Chebyshev polynomial T₁₀. The coefficients of T₀ … T₉ decrease fast where the
// function is smooth, so that their sums into coefficients of z⁰ … z⁹ lose no digits. Source: Trefethen, "Approximation
// Theory and Approximation Practice", ch. 2 and 3.
struct Interpolation {
    using Matrix = std::array<std::array<double, kCount>, kCount>;
    std::array<double, kCount> nodes;
    Matrix transform;    // row j: the weights of the values at the nodes in the coefficient of Tⱼ
    Matrix chebyshev{};  // row j: the coefficients of zᵏ in Tⱼ

    Interpolation() {
        chebyshev[0][0] = chebyshev[1][1] = 1;
        for (std::size_t j = 2; j < kCount; ++j)
            for (std::size_t k = 0; k < kCount; ++k)
                chebyshev[j][k] = (k > 0 ? 2 * chebyshev[j - 1][k - 1] : 0) - chebyshev[j - 2][k];
        for (std::size_t i = 0; i < kCount; ++i) {
            const double angle = (2 * static_cast<double>(i) + 1) * std::numbers::pi / (2 * kCount);
            nodes[i] = std::cos(angle);
            for (std::size_t j = 0; j < kCount; ++j)
                transform[j][i] = (j == 0 ? 1.0 : 2.0) / kCount * std::cos(static_cast<double>(j) * angle);
        }
    }
    std::array<double, kCount> coefficients(const std::array<double, kCount>& values) const {
        std::array<double, kCount> out{};
        const double level = values[kCount / 2];  // differences from it have smaller rounding errors
        out[0] = level;
        for (std::size_t j = 0; j < kCount; ++j) {
            double weight = 0;
            for (std::size_t i = 0; i < kCount; ++i) weight += transform[j][i] * (values[i] - level);
            for (std::size_t k = 0; k <= j; ++k) out[k] += weight * chebyshev[j][k];
        }
        return out;
    }
};

const Interpolation& interpolation() {
    static const Interpolation kInterpolation;
    return kInterpolation;
}

}  // namespace

// Halves an interval until polynomials agree with the exact function.
struct CamShape::Fit {
    // Above the rounding of the formulas, which is largest in ρ; a piece that agrees so far is mostly accurate to
    // rounding.
    static constexpr double kErrorOfHeight = 1.5e-15, kErrorOfRadius = 2e-14;  // of the size
    static constexpr int kMostHalvings = 7;

    const ProfileSpan& span;
    double shift;  // α of the piece and α of the span differ by whole turns
    double size;
    std::vector<Piece>& out;

    Piece interpolated(double from, double to) const {
        Piece piece{from, 0, 0.5 * (from + to), 2 / (to - from), {}, {}, {}};
        Coefficients h, slope, radius;
        for (std::size_t i = 0; i < kCount; ++i) {
            const CamPoint p = span.at(piece.middle + interpolation().nodes[i] / piece.scale + shift);
            h[i] = p.h;
            slope[i] = p.slope;
            radius[i] = p.radius;
        }
        piece.h = interpolation().coefficients(h);
        piece.slope = interpolation().coefficients(slope);
        piece.radius = interpolation().coefficients(radius);
        return piece;
    }
    bool agrees(const Piece& piece) const {
        for (int i = 0; i <= kCount; ++i) {
            const double alpha = piece.middle + std::cos(i * std::numbers::pi / kCount) / piece.scale;
            const CamPoint exact = span.at(alpha + shift), fitted = piece.at(alpha);
            if (!(std::fabs(exact.h - fitted.h) <= kErrorOfHeight * size &&
                  std::fabs(exact.slope - fitted.slope) <= kErrorOfHeight * size &&
                  std::fabs(exact.radius - fitted.radius) <= kErrorOfRadius * size))
                return false;
        }
        return true;
    }
    void cover(double from, double to, int halvings = 0) const {
        const Piece piece = interpolated(from, to);
        if (halvings >= kMostHalvings || agrees(piece)) return out.push_back(piece);
        cover(from, piece.middle, halvings + 1);
        cover(piece.middle, to, halvings + 1);
    }
};

CamPoint CamShape::Piece::at(double alpha) const {
    const double z = (alpha - middle) * scale;
    return {polynomial(h, z), polynomial(slope, z), polynomial(radius, z)};
}

double CamShape::Piece::radius_slope(double alpha) const {
    return scale * polynomial_slope(radius, (alpha - middle) * scale);
}

double CamShape::Piece::arc_at(double alpha) const {
    std::array<double, kCount + 1> integral{};  // of ρ
    for (std::size_t k = 0; k < kCount; ++k) integral[k + 1] = radius[k] / static_cast<double>(k + 1);
    return arc +
           (polynomial(integral, (alpha - middle) * scale) - polynomial(integral, (from - middle) * scale)) / scale;
}

CamShape::CamShape(const Problem& problem)
    : disc_radius_(problem.cam->radius), eccentricity_(problem.cam->eccentricity) {
    std::vector<double> ends;
    double size = disc_radius_ + eccentricity_;
    if (problem.cam->profile) {
        const std::vector<ProfileSpan> spans = spans_of(problem);
        size = 0;
        for (const ProfileSpan& span : spans) {
            const CamPoint p = span.at(span.from);
            size = std::max({size, std::fabs(p.h), std::fabs(p.radius)});
        }
        for (const ProfileSpan& span : spans)
            for (double from = span.from; from < span.to;) {
                const double turn = kFullTurn * std::floor((from + kLongRounding) / kFullTurn);
                const double to = std::min(span.to, turn + kFullTurn);
                if (to - from > kLongRounding)
                    Fit{span, turn, size, pieces_}.cover(std::max(0.0, from - turn), to - turn);
                from = std::max(to, from + kLongRounding);
            }
        std::ranges::sort(pieces_, {}, &Piece::from);
        for (const ProfileSpan& span : spans) ends.push_back(reduced(span.from));
    }
    if (!pieces_.empty()) {
        pieces_.front().from = 0;
        for (std::size_t i = 1; i < pieces_.size(); ++i) pieces_[i].arc = pieces_[i - 1].arc_at(pieces_[i].from);
        first_piece_.resize(2 * pieces_.size());
        for (std::size_t i = 0, piece = 0; i < first_piece_.size(); ++i) {
            const double start = kFullTurn * static_cast<double>(i) / static_cast<double>(first_piece_.size());
            while (piece + 1 < pieces_.size() && pieces_[piece + 1].from <= start) ++piece;
            first_piece_[i] = static_cast<int>(piece);
        }
        const bool has_knots = std::holds_alternative<PointsProfile>(*problem.cam->profile);
        if (!has_knots) find_kinks(ends, size);
    }
    find_extremes();
}

const CamShape::Piece& CamShape::piece(double alpha) const {
    const auto slots = static_cast<double>(first_piece_.size());
    const auto slot = std::min(first_piece_.size() - 1, static_cast<std::size_t>(alpha * (slots / kFullTurn)));
    auto at = pieces_.begin() + first_piece_[slot];
    const auto last = slot + 1 < first_piece_.size() ? pieces_.begin() + first_piece_[slot + 1] : pieces_.end() - 1;
    if (last - at > 4)
        return *(std::upper_bound(at + 1, last + 1, alpha, [](double x, const Piece& p) { return x < p.from; }) - 1);
    while (at < last && (at + 1)->from <= alpha) ++at;
    return *at;
}

CamPoint CamShape::at(double alpha) const {
    if (is_disc()) {
        const Vec2 n = unit(alpha);
        return {disc_radius_ + eccentricity_ * n.x, -eccentricity_ * n.y, disc_radius_};
    }
    const double turn = reduced(alpha);
    return piece(turn).at(turn);
}

double CamShape::radius_slope(double alpha) const {
    if (is_disc()) return 0;
    const double turn = reduced(alpha);
    return piece(turn).radius_slope(turn);
}

double CamShape::arc(double alpha) const {
    if (is_disc()) return disc_radius_ * alpha;
    return alpha < kFullTurn ? piece(alpha).arc_at(alpha) : pieces_.back().arc_at(kFullTurn);
}

std::vector<double> CamShape::intervals() const {
    constexpr int kIntervalsOfDisc = 16;  // each an arc of 22.5°
    std::vector<double> ends;
    for (const Piece& each : pieces_) ends.push_back(each.from);
    if (is_disc())
        for (int i = 0; i < kIntervalsOfDisc; ++i) ends.push_back(kFullTurn * i / kIntervalsOfDisc);
    ends.push_back(kFullTurn);
    return ends;
}

// Compares the pieces on both sides of each end of a span.
void CamShape::find_kinks(const std::vector<double>& ends, double size) {
    // Of the size: beyond the errors of ρ and of its derivative, which is that of a polynomial fitted to rounded
    // values.
    constexpr double kJumpOfRadius = 1e-11, kJumpOfSlope = 1e-7;
    constexpr double kSameAngle = 1e-11;  // [rad]
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const Piece &after = pieces_[i], &before = pieces_[(i + pieces_.size() - 1) % pieces_.size()];
        const auto is_here = [&](double end) {
            const double apart = std::fabs(end - after.from);
            return std::min(apart, kFullTurn - apart) <= kSameAngle;
        };
        if (std::ranges::none_of(ends, is_here)) continue;
        const double there = i == 0 ? kFullTurn : after.from;
        if (std::fabs(after.at(after.from).radius - before.at(there).radius) > kJumpOfRadius * size ||
            std::fabs(after.radius_slope(after.from) - before.radius_slope(there)) > kJumpOfSlope * size)
            kinks_.push_back(after.from);
    }
}

std::shared_ptr<const CamShape> cam_shape(const Problem& problem) {
    if (!problem.cam) return std::make_shared<const CamShape>(Problem{});
    if (!problem.cam->profile) return std::make_shared<const CamShape>(problem);
    struct Kept {
        Profile profile;
        Vec2 centre;
        double offset = 0;
        std::shared_ptr<const CamShape> shape;
    };
    constexpr std::size_t kMostKept = 8;
    static std::mutex mutex;
    static std::deque<Kept> kept;
    const double offset = contact_offset(problem);
    const std::scoped_lock lock(mutex);
    for (const Kept& k : kept)
        if (k.offset == offset && k.centre == problem.cam->centre && k.profile == *problem.cam->profile) return k.shape;
    kept.push_back({*problem.cam->profile, problem.cam->centre, offset, std::make_shared<const CamShape>(problem)});
    if (kept.size() > kMostKept) kept.pop_front();
    return kept.back().shape;
}

void CamShape::find_extremes() {
    if (is_disc()) {
        least_radius_ = largest_radius_ = disc_radius_;
        least_height_ = disc_radius_ - eccentricity_;
        largest_reach_ = disc_radius_ + eccentricity_;
        largest_slope_ = largest_arm_ = eccentricity_;
        return;
    }
    const std::vector<double> ends = intervals();
    const auto largest = [&](auto&& quantity) {
        return largest_over(ends, [&](double alpha) { return quantity(at(alpha)); }).y;
    };
    least_radius_ = -largest([](const CamPoint& p) { return -p.radius; });
    largest_radius_ = largest([](const CamPoint& p) { return p.radius; });
    least_height_ = -largest([](const CamPoint& p) { return -p.h; });
    largest_reach_ = largest([](const CamPoint& p) { return std::hypot(p.h, p.slope); });
    largest_slope_ = largest([](const CamPoint& p) { return std::fabs(p.slope); });
    largest_arm_ = largest([](const CamPoint& p) { return std::hypot(p.h - p.radius, p.slope); });
}

}  // namespace beamcam::sim
