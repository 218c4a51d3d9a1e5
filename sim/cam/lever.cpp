#include "sim/cam/lever.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

Lever::Lever(const Problem& p)
    : shape_(cam_shape(p)),
      distance_(norm(p.cam->centre)),
      direction_(std::atan2(p.cam->centre.y, p.cam->centre.x)),
      offset_(contact_offset(p)) {
    const double a = p.hub.radius, length = p.beam.length, mass = p.beam.line_density() * length;
    inertia_ = p.hub.inertia + mass * (a * a + a * length + length * length / 3);
    weight_ = mass * p.gravity * (a + 0.5 * length);
    const auto* torque = std::get_if<ConstantTorque>(&p.hub.drive);
    torque_ = torque ? torque->value : 0;
    spring_ = p.hub.spring;
    sense_ = p.cam->speed < 0 ? -1 : 1;
    is_driven_ = !is_independent_of_time(p.hub.drive);
}

// (S106): h + d = |C| sin(θ − arg C), and its derivatives by α.
Lever::State Lever::at_normal(double alpha) const {
    State s;
    s.alpha = alpha;
    s.point = shape_->at(alpha);
    const double across = s.point.h + offset_, h2 = s.point.radius - s.point.h;
    const double h3 = shape_->radius_slope(alpha) - s.point.slope;
    const double along = std::sqrt((distance_ - across) * (distance_ + across));  // C·u
    const double t1 = s.point.slope / along, t2 = (h2 + across * t1 * t1) / along;
    const double t3 = (h3 + 3 * across * t1 * t2 + along * t1 * t1 * t1) / along;
    const double turned = 1 / (1 - t1);  // dα/dφ = 1 + θ′
    s.motion.theta = direction_ + std::atan2(across, along);
    s.motion.velocity = t1 * turned;
    s.motion.acceleration = t2 * turned * turned * turned;
    s.motion.jerk = (t3 + 3 * t2 * t2 * turned) * turned * turned * turned * turned;
    s.phi = alpha - s.motion.theta - std::numbers::pi / 2;
    s.foot = along - s.point.slope;
    return s;
}

Lever::State Lever::at(double phi) const {
    const double upright = phi + std::numbers::pi / 2 + direction_;
    return at_normal(increasing_root(
        [&](double alpha) {
            const State s = at_normal(alpha);
            return std::pair(s.phi - phi, 1 / (1 + s.motion.velocity));
        },
        upright, upright + std::numbers::pi / 2));
}

// (S108)
double Lever::pressure_angle(const State& state) const { return std::atan2(offset_, state.foot); }

double Lever::pressing_moment(double theta) const {
    return weight_ * std::cos(theta) - (spring_ ? spring_->torque(theta, 0) : 0) - torque_;
}

double Lever::turn_at_normal(double alpha) const {
    const double phi = at_normal(alpha).phi;
    return phi - kFullTurn * std::floor(phi / kFullTurn);
}

Lever::Summary Lever::summary() const {
    const std::vector<double> ends = shape_->intervals();
    const Vec2 sharpest = largest_over(ends, [&](double a) { return -shape_->at(a).radius; });
    const Vec2 steepest = largest_over(ends, [&](double a) { return pressure_angle(at_normal(a)); });
    return {shape_->least_height(),
            shape_->least_radius(),
            shape_->largest_radius(),
            sharpest.x,
            turn_at_normal(sharpest.x),
            std::max(0.0, steepest.y),
            jump()};
}

// (S107): Jθ″ω² + cθ′ω + M vanishes first where the larger root 1/ω of Jθ″ + cθ′/ω + M/ω² is largest.
std::optional<Lever::Jump> Lever::jump() const {
    if (is_driven_) return std::nullopt;
    const std::vector<double> ends = shape_->intervals();
    const Vec2 least = largest_over(ends, [&](double a) { return -pressing_moment(at_normal(a).motion.theta); });
    if (!(least.y < 0)) return Jump{0, turn_at_normal(least.x)};
    const double damping = spring_ ? sense_ * spring_->damping : 0;
    const Vec2 first = largest_over(ends, [&](double a) {
        const LeverMotion m = at_normal(a).motion;
        const double moment = pressing_moment(m.theta), half = 0.5 * damping * m.velocity / moment;
        const double square = -inertia_ * m.acceleration / moment;  // of 1/ω without damping
        if (damping == 0) return square;
        const double root = half * half + square;
        const double inverse = root < 0 ? root : std::sqrt(root) - half;
        return inverse * std::fabs(inverse);
    });
    if (!(first.y > 0)) return std::nullopt;
    return Jump{1 / std::sqrt(first.y), turn_at_normal(first.x)};
}

}  // namespace beamcam::sim
