#include "sim/sweep/cam_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

constexpr int kSurfacePlaces = 128;       // around the turn, to begin with: then halved where bounds ask for it
constexpr double kSurfaceMargin = 0.005;  // of the range of θ̈_c, by which its bounds may exceed its extrema
constexpr int kMostSurfaceHalvings = 30;  // of the distance of two places, to rounding

CamSurface::CamSurface(const Cam& cam, double reach, double k, double alpha)
    : cam_(cam),
      reach_(reach),
      k_(k),
      alpha_(alpha),
      period_(cam.speed != 0 ? 2 * std::numbers::pi / std::fabs(cam.speed) : 1) {
    const Place start = place(0);
    highest_ = lowest_ = start.acceleration;
    if (cam.speed == 0 || cam.eccentricity == 0) {
        always_pulls_ = start.push < 0;
        return;
    }
    std::vector<Place> places;
    for (int i = 0; i <= kSurfacePlaces; ++i) {
        places.push_back(place(period_ * i / kSurfacePlaces));
        highest_ = std::max(highest_, places.back().acceleration);
        lowest_ = std::min(lowest_, places.back().acceleration);
    }
    places.back() = {period_, start.acceleration, start.push};  // the same without rounding: zeros come in pairs
    const double margin = kSurfaceMargin * (highest_ - lowest_);
    std::vector<double> zeros;
    for (std::size_t i = 1; i < places.size(); ++i) {
        bound_acceleration(places[i - 1], places[i], margin, kMostSurfaceHalvings);
        find_zeros(places[i - 1], places[i], kMostSurfaceHalvings, zeros);
    }
    set_lifts(std::move(zeros), start.push < 0);
}

CamSurface::Place CamSurface::place(double s) const {
    const SurfaceAngle c = at(s);
    return {s, acceleration(c), push(c)};
}

// With B = C + e(cos ψ, sin ψ), ρ = |B|, ℓ² = ρ² − R'²:                                                      (S81)
//   θ_c = atan2(B_y, B_x) + asin(R'/ρ),   θ_c′ = B×B′/ρ² − R' B·B′/(ρ²ℓ),
//   θ_c″ = (B×B″ − 2 (B×B′)(B·B′)/ρ²)/ρ² − R' [(B′·B′ + B·B″)/(ρ²ℓ) − (B·B′)²(2ℓ² + ρ²)/(ρ⁴ℓ³)]
SurfaceAngle CamSurface::at(double s) const {
    const Vec2 arm = cam_.eccentricity * unit(cam_.phase - cam_.speed * s), b = cam_.centre + arm, b1 = perp(arm);
    const double rho2 = dot(b, b), lever2 = rho2 - reach_ * reach_, lever = std::sqrt(lever2);
    const double turn = cross(b, b1), away = dot(b, b1), outward = dot(b, arm);
    SurfaceAngle c;
    c.lever = lever;
    c.angle = std::atan2(b.y * lever + b.x * reach_, b.x * lever - b.y * reach_);  // the sum of the two
    c.slope = (turn - reach_ * away / lever) / rho2;
    const double spread = (cam_.eccentricity * cam_.eccentricity - outward) / lever -
                          away * away * (2 * lever2 + rho2) / (rho2 * lever2 * lever);
    c.bend = (cross(arm, b) - 2 * turn * away / rho2 - reach_ * spread) / rho2;
    return c;
}

double CamSurface::push(const SurfaceAngle& c) const { return acceleration(c) + k_ * std::cos(c.angle) - alpha_; }

// θ_c = atan2(B_y, B_x) + Φ(u), u = ρ², Φ = asin(R'/√u). Of the first term the second derivative is (c² − e²)u′/(2u²),
// c = |C|. Both 1/u and 1/ℓ fall with u and so do the magnitudes of all their derivatives; those of Φ, made of them,
// are largest where u is least. With |u′| <= S, |u″| <= K, u‴ = −u′ and u⁗ = −u″:                                 (S84)
//   |θ_c″| <= ½(c² − e²)S/u² + Φ₁K + Φ₂S²,
//   |θ_c⁗| <= ½(c² − e²)(S/u² + 6SK/u³ + 6S³/u⁴) + Φ₁K + Φ₂(4S² + 3K²) + 6Φ₃S²K + Φ₄S⁴
CamSurface::Bends CamSurface::bends(double from, double to) const {
    const double half = 0.5 * (to - from) * std::fabs(cam_.speed), e = cam_.eccentricity, c = norm(cam_.centre);
    const Vec2 arm = e * unit(cam_.phase - cam_.speed * 0.5 * (from + to)), b = cam_.centre + arm;
    const double most = 2 * c * e;
    const double S = std::min(most, 2 * std::fabs(cross(cam_.centre, arm)) + most * half);
    const double K = std::min(most, 2 * std::fabs(dot(cam_.centre, arm)) + most * half);
    const double u = std::max((c - e) * (c - e), dot(b, b) - S * half), w = u - reach_ * reach_;
    const double p = 1 / u, r = 1 / w, phi = 0.5 * reach_ * p * std::sqrt(r);
    const double phi2 = phi * (p + 0.5 * r), phi3 = phi * (2 * p * p + p * r + 0.75 * r * r),
                 phi4 = phi * (6 * p * p * p + 3 * p * p * r + 2.25 * p * r * r + 1.875 * r * r * r);
    const double turning = 0.5 * (c * c - e * e) * p * p, slope = e / std::sqrt(u) + phi * S;
    const double second = turning * S + phi * K + phi2 * S * S;
    const double fourth = turning * (S + 6 * p * S * (K + p * S * S)) + phi * K + phi2 * (4 * S * S + 3 * K * K) +
                          6 * phi3 * S * S * K + phi4 * S * S * S * S;
    const double speed2 = cam_.speed * cam_.speed;
    return {speed2 * speed2 * fourth, speed2 * (speed2 * fourth + std::fabs(k_) * (second + slope * slope))};
}

// Between two places θ̈_c leaves the line through them by at most an eighth of its largest second derivative times the
// square of their distance. The interval is halved until that is within the margin of the extrema found so far.
void CamSurface::bound_acceleration(const Place& a, const Place& b, double margin, int halvings) {
    const double h = b.s - a.s, strays = 0.125 * h * h * bends(a.s, b.s).acceleration;
    const double high = std::max(a.acceleration, b.acceleration) + strays;
    const double low = std::min(a.acceleration, b.acceleration) - strays;
    if (high <= highest_ && low >= lowest_) return;
    if (strays <= margin || halvings == 0) {
        highest_ = std::max(highest_, high);
        lowest_ = std::min(lowest_, low);
        return;
    }
    const Place middle = place(0.5 * (a.s + b.s));
    bound_acceleration(a, middle, margin, halvings - 1);
    bound_acceleration(middle, b, margin, halvings - 1);
}

// The zeros of f between two places, in order. There is none if f has one sign and strays from its chord by less than
// its values, and one if its slope cannot vanish.
void CamSurface::find_zeros(const Place& a, const Place& b, int halvings, std::vector<double>& zeros) const {
    const double h = b.s - a.s, bend = h * h * bends(a.s, b.s).push;
    const bool passes = (a.push < 0) != (b.push < 0);
    if (!passes && std::min(std::fabs(a.push), std::fabs(b.push)) > 0.125 * bend) return;
    if ((passes && std::fabs(b.push - a.push) > bend) || halvings == 0) {
        const auto f = [&](double s) { return push(at(s)); };
        if (passes) zeros.push_back(find_root(f, a.s, b.s, a.push, b.push));
        return;
    }
    const Place middle = place(0.5 * (a.s + b.s));
    find_zeros(a, middle, halvings - 1, zeros);
    find_zeros(middle, b, halvings - 1, zeros);
}

void CamSurface::set_lifts(std::vector<double> zeros, bool starts_pulled) {
    if (zeros.empty()) {
        always_pulls_ = starts_pulled;
        return;
    }
    if (starts_pulled) std::rotate(zeros.begin(), zeros.begin() + 1, zeros.end());
    for (std::size_t i = 0; i + 1 < zeros.size(); i += 2) {
        const double from = zeros[i], to = zeros[i + 1];
        lifts_.push_back({from, to < from ? to + period_ : to});
    }
    std::ranges::sort(lifts_, {}, &Lift::from);
}

}  // namespace beamcam::sim
