#include "sim/sweep/cam_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "sim/sweep/constants.hpp"

namespace beamcam::sim {

CamSurface::CamSurface(const Cam& cam, double reach, double k, double alpha)
    : cam_(cam),
      reach_(reach),
      k_(k),
      alpha_(alpha),
      period_(cam.speed != 0 ? 2 * std::numbers::pi / std::fabs(cam.speed) : 1) {
    highest_ = -std::numeric_limits<double>::infinity();
    lowest_ = -highest_;
    std::vector<double> pushes;
    for (int i = 0; i < kSurfacePlaces; ++i) {
        const SurfaceAngle c = at(period_ * i / kSurfacePlaces);
        const double value = acceleration(c);
        highest_ = std::max(highest_, value);
        lowest_ = std::min(lowest_, value);
        pushes.push_back(push(c));
    }
    const double margin = kLiftMargin * (highest_ - lowest_);
    highest_ += margin;
    lowest_ -= margin;
    find_lifts(pushes);
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

void CamSurface::find_lifts(const std::vector<double>& pushes) {
    const bool starts_pulled = pushes.front() < 0;
    if (cam_.speed == 0 || cam_.eccentricity == 0) {
        always_pulls_ = starts_pulled;
        return;
    }
    const auto f = [&](double s) { return push(at(s)); };
    std::vector<double> zeros;  // of f
    for (int i = 1; i <= kSurfacePlaces; ++i) {
        const double before = pushes[static_cast<std::size_t>(i - 1)];
        const double now = pushes[static_cast<std::size_t>(i % kSurfacePlaces)];
        if ((before < 0) != (now < 0))
            zeros.push_back(
                find_root(f, period_ * (i - 1) / kSurfacePlaces, period_ * i / kSurfacePlaces, before, now));
    }
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
