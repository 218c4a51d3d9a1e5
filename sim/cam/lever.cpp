#include "sim/cam/lever.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

Lever::Lever(const Problem& p, CamShape shape)
    : shape_(std::move(shape)),
      distance_(norm(p.cam->centre)),
      direction_(std::atan2(p.cam->centre.y, p.cam->centre.x)),
      offset_(contact_offset(p)) {
    const double a = p.hub.radius, length = p.beam.length, mass = p.beam.line_density() * length;
    inertia_ = p.hub.inertia + mass * (a * a + a * length + length * length / 3);
    weight_ = mass * p.gravity * (a + 0.5 * length);
    const auto* torque = std::get_if<ConstantTorque>(&p.hub.drive);
    torque_ = torque ? torque->value : 0;
    is_driven_ = !is_independent_of_time(p.hub.drive);
}

// (S106): h + d = |C| sin(θ − arg C), and its derivatives by α.
Lever::State Lever::at_normal(double alpha) const {
    State s;
    s.alpha = alpha;
    s.point = shape_.at(alpha);
    const double across = s.point.h + offset_, h2 = s.point.radius - s.point.h;
    const double h3 = shape_.radius_slope(alpha) - s.point.slope;
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

double Lever::pressing_moment(double theta) const { return weight_ * std::cos(theta) - torque_; }

// (S107): N x_c = J ω² θ″ + M is smallest where −J θ″/M is largest.
std::optional<Lever::Jump> Lever::jump() const {
    if (is_driven_) return std::nullopt;
    const std::vector<double> ends = shape_.intervals();
    const auto turn = [this](double alpha) {
        const double phi = at_normal(alpha).phi;
        return phi - kFullTurn * std::floor(phi / kFullTurn);
    };
    const Vec2 least = largest_over(ends, [&](double a) { return -pressing_moment(at_normal(a).motion.theta); });
    if (!(least.y < 0)) return Jump{0, turn(least.x)};
    const Vec2 first = largest_over(ends, [&](double a) {
        const State s = at_normal(a);
        return -inertia_ * s.motion.acceleration / pressing_moment(s.motion.theta);
    });
    if (!(first.y > 0)) return std::nullopt;
    return Jump{1 / std::sqrt(first.y), turn(first.x)};
}

}  // namespace beamcam::sim
