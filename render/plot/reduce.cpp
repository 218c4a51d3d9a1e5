#include "render/plot/reduce.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamcam::render {
namespace {

// [from, to) is unbroken and increases in x.
void columns(std::span<const Vec2> p, double grain, std::vector<Vec2>& out) {
    for (std::size_t i = 0; i < p.size();) {
        const double column = std::floor(p[i].x / grain);
        std::size_t least = i, most = i, last = i;
        while (last + 1 < p.size() && std::floor(p[last + 1].x / grain) == column) {
            ++last;
            if (p[last].y < p[least].y) least = last;
            if (p[last].y > p[most].y) most = last;
        }
        const std::size_t inner[2] = {std::min(least, most), std::max(least, most)};
        out.push_back(p[i]);
        for (const std::size_t k : inner)
            if (k != i && k != last && p[k] != out.back()) out.push_back(p[k]);
        if (last != i) out.push_back(p[last]);
        i = last + 1;
    }
}

void steps(std::span<const Vec2> p, double grain, std::vector<Vec2>& out) {
    for (std::size_t i = 0; i < p.size(); ++i)
        if (i == 0 || i + 1 == p.size() || norm(p[i] - out.back()) >= grain) out.push_back(p[i]);
}

// Applies `reduce_piece` to each unbroken piece and puts a NaN at each break.
template <class ReducePiece>
std::vector<Vec2> by_pieces(std::span<const Vec2> points, ReducePiece reduce_piece) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < points.size();) {
        if (broken(points[i])) {
            if (!out.empty() && !broken(out.back())) out.push_back({std::nan(""), std::nan("")});
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < points.size() && !broken(points[end])) ++end;
        reduce_piece(points.subspan(i, end - i), out);
        i = end;
    }
    return out;
}

// Whether all of `between` lie on the straight line from a to b.
bool straight(Vec2 a, Vec2 b, std::span<const Vec2> between, double tolerance) {
    const Vec2 way = b - a;
    const double length = norm(way);
    return length > 0 && std::all_of(between.begin(), between.end(), [&](Vec2 p) {
               const double along = dot(p - a, way) / length;
               return along >= 0 && along <= length && std::abs(cross(p - a, way)) <= tolerance * length;
           });
}

// Omits points on the line between their neighbours.
std::vector<Vec2> straightened(const std::vector<Vec2>& p, double tolerance) {
    constexpr std::size_t kMostLeftOut = 64;  // along one line, so that the work stays linear
    std::vector<Vec2> out;
    std::size_t kept = 0;  // index of the last one in `out`
    for (std::size_t i = 0; i < p.size(); ++i) {
        const bool inner = i > 0 && i + 1 < p.size() && !broken(p[kept]) && !broken(p[i]) && !broken(p[i + 1]);
        if (inner && i - kept <= kMostLeftOut && straight(p[kept], p[i + 1], {&p[kept + 1], i - kept}, tolerance))
            continue;
        out.push_back(p[i]);
        kept = i;
    }
    return out;
}

// One column of a curve that may be broken.
struct PixelColumn {
    double place = 0;  // in columns
    std::size_t first = 0, last = 0, least = 0, most = 0;
    double way = 0;  // travelled up and down, without breaks
};

PixelColumn column_at(std::span<const Vec2> p, std::size_t first, double width) {
    PixelColumn c{std::floor(p[first].x / width), first, first, first, first};
    for (std::size_t i = first + 1; i < p.size(); ++i) {
        if (broken(p[i])) continue;
        if (std::floor(p[i].x / width) != c.place) break;
        if (!broken(p[i - 1])) c.way += std::abs(p[i].y - p[i - 1].y);
        if (p[i].y < p[c.least].y) c.least = i;
        if (p[i].y > p[c.most].y) c.most = i;
        c.last = i;
    }
    return c;
}

}  // namespace

bool increasing(std::span<const Vec2> points) {
    double before = -std::numeric_limits<double>::infinity();
    for (const Vec2 p : points) {
        if (broken(p)) continue;
        if (p.x < before) return false;
        before = p.x;
    }
    return true;
}

std::vector<Envelope> envelopes(std::span<const Vec2> points, double column) {
    constexpr double kLeastWay = 2.5;          // vertical way of the curve in a column, in its height
    constexpr std::size_t kFewestColumns = 8;  // columns: a single one is drawn as it is
    std::vector<Envelope> all;
    if (points.size() < 4 * kFewestColumns || !increasing(points)) return all;
    Envelope now;
    double before = 0;
    const auto close = [&] {
        if (now.least.size() >= kFewestColumns) all.push_back(std::move(now));
        now = {};
    };
    for (std::size_t i = 0; i < points.size();) {
        if (broken(points[i])) {
            ++i;
            continue;
        }
        const PixelColumn c = column_at(points, i, column);
        i = c.last + 1;
        if (!now.least.empty() && c.place != before + 1) close();
        if (c.way > kLeastWay * (points[c.most].y - points[c.least].y)) {
            if (now.least.empty()) now.first = c.first;
            now.least.push_back(c.least);
            now.most.push_back(c.most);
            now.last = c.last;
            before = c.place;
        } else {
            close();
        }
    }
    close();
    return all;
}

std::vector<Vec2> outline(const Envelope& envelope, std::span<const Vec2> points) {
    std::vector<Vec2> all{points[envelope.first]};
    for (const std::size_t k : envelope.most) all.push_back(points[k]);
    all.push_back(points[envelope.last]);
    for (auto k = envelope.least.rbegin(); k != envelope.least.rend(); ++k) all.push_back(points[*k]);
    return all;
}

std::vector<Vec2> without(const std::vector<Envelope>& envelopes, std::span<const Vec2> points) {
    std::vector<Vec2> all;
    std::size_t next = 0;
    for (const Envelope& envelope : envelopes) {
        for (; next <= envelope.first; ++next) all.push_back(points[next]);
        all.push_back({std::nan(""), std::nan("")});
        next = envelope.last;
    }
    for (; next < points.size(); ++next) all.push_back(points[next]);
    return all;
}

std::vector<Vec2> column_extremes(std::span<const Vec2> points, double width) {
    return by_pieces(points, [&](std::span<const Vec2> piece, auto& out) { columns(piece, width, out); });
}

std::vector<Vec2> reduce(std::span<const Vec2> points, double grain) {
    const std::vector<Vec2> out = by_pieces(points, [&](std::span<const Vec2> piece, auto& kept) {
        increasing(piece) ? columns(piece, grain, kept) : steps(piece, grain, kept);
    });
    constexpr std::size_t kDense = 20'000;  // points: such a dense drawing hides errors of a grain
    return straightened(out, out.size() > kDense ? grain : 0.25 * grain);
}

}  // namespace beamcam::render
