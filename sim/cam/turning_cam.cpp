#include "sim/cam/turning_cam.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::sim {
namespace {

constexpr double kLongestRefinement = 0.3;  // [rad]
constexpr int kNormalsOfSearch = 128;

}  // namespace

TurningCam::TurningCam(const Problem& problem)
    : shape_(cam_shape(problem)),
      axis_(problem.cam.value_or(Cam{}).centre),
      phase_(problem.cam.value_or(Cam{}).phase),
      speed_(problem.cam.value_or(Cam{}).speed),
      radius_(problem.cam.value_or(Cam{}).radius),
      eccentricity_(problem.cam.value_or(Cam{}).eccentricity),
      is_disc_(shape_->is_disc()) {}

double TurningCam::place(double t, Vec2 normal) const {
    const double turn = alpha(t, normal);
    return shape_->arc(turn - kFullTurn * std::floor(turn / kFullTurn));
}

OsculatingDisc TurningCam::disc(double t, Vec2 normal) const {
    if (is_disc_) {
        const Vec2 arm = eccentricity_ * unit(angle(t));
        return {axis_ + arm, -speed_ * perp(arm), radius_};
    }
    const CamPoint at = shape_->at(alpha(t, normal));
    const Vec2 arm = (at.h - at.radius) * normal + at.slope * perp(normal);
    return {axis_ + arm, -speed_ * perp(arm), at.radius};
}

OsculatingDisc TurningCam::nearest(double t, Vec2 point, Vec2 normal) const {
    if (is_disc_) return disc(t, normal);
    const double psi = angle(t), c = std::cos(psi), s = std::sin(psi);
    const Vec2 d = point - axis_, in_cam{c * d.x + s * d.y, c * d.y - s * d.x};
    return disc(t, unit(psi + nearest_normal(in_cam, alpha(t, normal))));
}

// A point P in the cam's frame lies P·n(α) − h(α) beyond the tangent at α, and the largest of these is its distance
// from the outline. The normal there is α, from the guess or from the best of equally spaced normals.
double TurningCam::nearest_normal(Vec2 point, double alpha) const {
    const double guess = alpha;
    if (refine_normal(point, alpha)) return alpha;
    double best = guess, farthest = dot(point, unit(guess)) - shape_->at(guess).h;
    for (int i = 0; i < kNormalsOfSearch; ++i) {
        const double a = kFullTurn * i / kNormalsOfSearch, beyond = dot(point, unit(a)) - shape_->at(a).h;
        if (beyond > farthest) {
            best = a;
            farthest = beyond;
        }
    }
    alpha = best;
    return refine_normal(point, alpha) ? alpha : best;
}

// Newton's method for the largest P·n − h, whose second derivative is −(P·n − h + ρ). False: it does not lead to a
// tangent that separates the point from the cam.
bool TurningCam::refine_normal(Vec2 point, double& alpha) const {
    for (int i = 0; i < kMostIterations; ++i) {
        const CamPoint at = shape_->at(alpha);
        const Vec2 n = unit(alpha);
        const double curvature = dot(point, n) - at.h + at.radius;
        if (!(curvature > 0)) return false;
        const double step = (dot(point, perp(n)) - at.slope) / curvature;
        alpha += std::clamp(step, -kLongestRefinement, kLongestRefinement);
        if (std::fabs(step) < kNegligible) return true;
    }
    return false;
}

}  // namespace beamcam::sim
