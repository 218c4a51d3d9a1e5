#include "sim/cam/lever.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/base/numerics.hpp"
#include "sim/beam/drive.hpp"

namespace beamcam::sim {

Lever::Lever(const Problem& p)
    : shape_(cam_shape(p)),
      distance_(norm(p.cam->centre)),
      direction_(std::atan2(p.cam->centre.y, p.cam->centre.x)),
      offset_(contact_offset(p)) {
    const double a = p.hub.radius, length = p.beam.length, mass = p.beam.line_density() * length;
    inertia_ = p.hub.inertia + mass * (a * a + a * length + length * length / 3);
    weight_ = mass * p.gravity * (a + 0.5 * length);
    torque_ = DriveLaw(p.hub.drive, p.initial.angle).torque(0);
    spring_ = p.hub.spring;
    sense_ = p.cam->speed < 0 ? -1 : 1;
    is_driven_ = !is_independent_of_time(p.hub.drive);
    side_ = starting_side(p);
}

// The beam at rest starts on the side against which it is pressed, above the cam if on both or on neither; another one
// on the side of its angle, whose whole turns those of the lever are, too.
double Lever::starting_side(const Problem& p) {
    if (p.initial.shape == InitialShape::resting) {
        const bool lifted = pressing_moment(at(-p.cam->phase).motion.theta) < 0;
        side_ = -1;
        return lifted && pressing_moment(at(-p.cam->phase).motion.theta) > 0 ? -1 : 1;
    }
    const DriveLaw drive(p.hub.drive, p.initial.angle);
    const double angle = drive.prescribed() ? drive.motion(0).angle : p.initial.angle;
    direction_ += kFullTurn * std::round((angle - direction_) / kFullTurn);
    return angle < direction_ ? -1 : 1;
}

// (S106): σ(h + d) = |C| sin(θ − arg C), and its derivatives by α.
Lever::State Lever::at_normal(double alpha) const {
    State s;
    s.alpha = alpha;
    s.point = shape_->at(alpha);
    const double across = side_ * (s.point.h + offset_), h1 = side_ * s.point.slope;
    const double h2 = side_ * (s.point.radius - s.point.h), h3 = side_ * (shape_->radius_slope(alpha) - s.point.slope);
    const double along = std::sqrt((distance_ - across) * (distance_ + across));  // C·u
    const double t1 = h1 / along, t2 = (h2 + across * t1 * t1) / along;
    const double t3 = (h3 + 3 * across * t1 * t2 + along * t1 * t1 * t1) / along;
    const double turned = 1 / (1 - t1);  // dα/dφ = 1 + θ′
    s.motion.theta = direction_ + std::atan2(across, along);
    s.motion.velocity = t1 * turned;
    s.motion.acceleration = t2 * turned * turned * turned;
    s.motion.jerk = (t3 + 3 * t2 * t2 * turned) * turned * turned * turned * turned;
    s.phi = alpha - s.motion.theta - side_ * std::numbers::pi / 2;
    s.foot = along - h1;
    return s;
}

Lever::State Lever::at(double phi) const {
    // The lever between its line to C and that turned by a right angle.
    const double low = phi + direction_ + (side_ > 0 ? 0.5 : -1) * std::numbers::pi;
    return at_normal(increasing_root(
        [&](double alpha) {
            const State s = at_normal(alpha);
            return std::pair(s.phi - phi, 1 / (1 + s.motion.velocity));
        },
        low, low + std::numbers::pi / 2));
}

// (S108)
double Lever::pressure_angle(const State& state) const { return std::atan2(offset_, state.foot); }

double Lever::pressing_moment(double theta) const {
    return side_ * (weight_ * std::cos(theta) - (spring_ ? spring_->torque(theta, 0) : 0) - torque_);
}

double Lever::farthest_foot() const {
    return largest_over(shape_->intervals(), [&](double alpha) { return at_normal(alpha).foot; }).y;
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

// (S107): σ(Jθ″ω² + cθ′ω) + M vanishes first where the larger root 1/ω of σ(Jθ″ + cθ′/ω) + M/ω² is largest.
std::optional<Lever::Jump> Lever::jump() const {
    if (is_driven_) return std::nullopt;
    const std::vector<double> ends = shape_->intervals();
    const Vec2 least = largest_over(ends, [&](double a) { return -pressing_moment(at_normal(a).motion.theta); });
    if (!(least.y < 0)) return Jump{0, turn_at_normal(least.x)};
    const double inertia = side_ * inertia_, damping = spring_ ? side_ * sense_ * spring_->damping : 0;
    const Vec2 first = largest_over(ends, [&](double a) {
        const LeverMotion m = at_normal(a).motion;
        const double moment = pressing_moment(m.theta), half = 0.5 * damping * m.velocity / moment;
        const double square = -inertia * m.acceleration / moment;  // of 1/ω without damping
        if (damping == 0) return square;
        const double root = half * half + square;
        const double inverse = root < 0 ? root : std::sqrt(root) - half;
        return inverse * std::fabs(inverse);
    });
    if (!(first.y > 0)) return std::nullopt;
    return Jump{1 / std::sqrt(first.y), turn_at_normal(first.x)};
}

}  // namespace beamcam::sim
