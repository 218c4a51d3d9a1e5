// Bounds of a step of the exponential collocation between its nodes. MODEL.md §12.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/integrate/constants.hpp"
#include "sim/integrate/exponential_segment.hpp"

namespace beamcam::sim {
// Bounds of a function of the modes, of its rate and of its second derivative.
struct Bounded {
    double value = 0, rate = 0, second = 0;
    void add(double factor, const Bounded& q) {
        value += factor * q.value;
        rate += factor * q.rate;
        second += factor * q.second;
    }
};

// Sums over all modes: bounds of displacement and speed of the beam's points, its tangent and its hub by vibration.
struct VibrationBounds {
    double deflection_speed = 0, deflection_acceleration = 0, slope_speed = 0;  // by the shapes' crude bounds
    Bounded deflection, stretch;                                                // stretch: √∫v′²
    double turn = 0, turn_rate = 0, hub_second = 0;
    double slope = 0, slope_rate = 0, curvature = 0;
    double inertia = 0, inertia_rate = 0;  // √|qᵀBq|, √|q̇ᵀBq̇|

    void add(const ModalForm& form, std::size_t i, const Bounded& mode) {
        const double shape = 3 + 3 * std::fabs(form.radius) / form.length;
        deflection_speed += shape * mode.rate;
        deflection_acceleration += shape * mode.second;
        slope_speed += shape * form.beta[i] * mode.rate;
        turn += std::fabs(form.h[i]) * mode.value;
        turn_rate += std::fabs(form.h[i]) * mode.rate;
        deflection.add(form.shape[i], mode);
        if (form.shortening) stretch.add(form.slope_norm[i], mode);
        const double steep = form.shape[i] * form.beta[i];
        slope += steep * mode.value;
        slope_rate += steep * mode.rate;
        curvature += steep * form.beta[i] * mode.value;
        hub_second += std::fabs(form.h[i]) * mode.second;
        inertia += form.inertia_root[i] * mode.value;
        inertia_rate += form.inertia_root[i] * mode.rate;
    }
};

// Bounds of |f|, √(q² + (q̇/ω)²) and |q̇| of the modes of a group. Between two nodes the second, the amplitude of the
// vibration, changes by at most ∫|f|/ω, and by twice the static deflection |f|/ω². Polynomials between nodes stay near
// their nodal values (Lebesgue's constant of Gauss nodes is 3: the spread is added on either side).        (S53)
void ExponentialSegment::find_largest(std::size_t g) const {
    transpose();
    const OscillatorLanes& group = form_->groups[g];
    Lanes force{}, squares{};
    for (std::size_t k = 0; k < kPoints; ++k) {
        const Lanes &x = lanes_q_[g * kPoints + k], &dx = lanes_v_[g * kPoints + k];
        squares = larger(squares, x * x + dx * dx / group.square);
        if (k > 0) force = larger(force, magnitude(lanes_f_[g * kNodes + k - 1]));
    }
    for (std::size_t i = g * kNodes; i < std::min(n_, (g + 1) * kNodes); ++i) {
        const int lane = static_cast<int>(i % kNodes);
        const double w = group.omega[lane];
        Largest& of = largest_[i];
        of.force = kNodeOvershoot * force[lane];
        of.amplitude = std::sqrt(squares[lane]) + of.force / w * std::min(kFarthestFromNode * h, 2 / w);
        of.rate = largest_rate(i, of.amplitude, of.force);
        if (left_out.contains(i)) let_lag(i, of);
    }
}

// A fast vibration turns about its quasi-static deflection, more slowly by its lag.                       (S52b)
void ExponentialSegment::let_lag(std::size_t i, Largest& of) const {
    const double w = form_->oscillators[i].omega, lag = std::fabs(left_out.lag(i));
    const double vibration = of.amplitude + of.force / (w * w);
    of.rate += lag * vibration;
    of.force += (2 * w + lag) * lag * vibration;
}

// Bound of |q̇| where √(q² + (q̇/ω)²) <= amplitude: from a node on, with s <= 1/(fast − slow) and |ṡ| <= 1, decays move
// by no more than the last two terms.
double ExponentialSegment::largest_rate(std::size_t i, double amplitude, double force) const {
    const Oscillator& o = form_->oscillators[i];
    const double vibrating = o.omega * amplitude;
    if (!decays(o)) return vibrating;
    const double at_nodes = std::max(std::fabs(v0[i]), largest(v[i]));
    return std::min(vibrating, at_nodes + (o.omega * vibrating + 2 * force) / decays_of(o).apart());
}

const MotionBounds* ExponentialSegment::bounds() const {
    if (bounds_known_) return &bounds_;
    bounds_known_ = true;
    MotionBounds& b = bounds_;
    b = {};
    VibrationBounds sum;
    for (std::size_t g = 0; g < form_->groups.size(); ++g) find_largest(g);
    for (std::size_t i = 0; i < n_; ++i) {
        const auto& [force, amplitude, speed] = largest_[i];
        const Oscillator& o = form_->oscillators[i];
        sum.add(*form_, i, {amplitude, speed, o.omega * o.omega * amplitude + force + 2 * o.gamma * speed});
    }
    double low = theta_dot[0], high = theta_dot[0];
    for (int k = 1; k < kNodes; ++k) {
        low = std::min(low, theta_dot[k]);
        high = std::max(high, theta_dot[k]);
    }
    const double spread = (high - low) + 1e-6 * std::max(std::fabs(low), std::fabs(high));
    low -= spread;
    high += spread;
    b.ripple = sum.turn;
    b.ripple_rate = sum.turn_rate;
    b.theta_dot = std::max(std::fabs(low), std::fabs(high));
    b.theta_ddot = form_->prescribed ? 4 * (high - low) / h
                                     : std::max(2 * largest(p_dot) / form_->J, hub_acceleration(sum, b.theta_dot));
    bound_points(sum, b);
    b.rate_low = low - sum.turn_rate;
    b.rate_high = high + sum.turn_rate;
    const double first = form_->prescribed ? drive_.motion(t0).angle : theta0;
    b.angle_low = first + std::min(0.0, low) * h - sum.turn;
    b.angle_high = first + std::max(0.0, high) * h + sum.turn;
    return &b;
}

// Θ̈ = [ṗ − 2Θ̇qᵀBq̇]/(J + qᵀBq); no bound where bending may make the inertia zero.
double ExponentialSegment::hub_acceleration(const VibrationBounds& sum, double fastest) const {
    const double least = form_->J - sum.inertia * sum.inertia;
    if (!(least > 0)) return std::numeric_limits<double>::infinity();
    return (kNodeOvershoot * largest(p_dot) + 2 * fastest * sum.inertia * sum.inertia_rate) / least;
}

// The beam shortens, u = −½∫v′² − ½aα², and its points are up to √(reach² + v²) away from the hinge.
void ExponentialSegment::bound_points(const VibrationBounds& sum, MotionBounds& b) const {
    const double a = form_->shortening ? std::fabs(form_->radius) : 0;
    const double beyond =
        0.5 * sum.deflection.value * sum.deflection.value / (std::fabs(form_->radius) + form_->length);
    const double axial = sum.stretch.value * sum.stretch.rate + a * sum.turn * sum.turn_rate;
    const double axial_acceleration = sum.stretch.rate * sum.stretch.rate + sum.stretch.value * sum.stretch.second +
                                      a * (sum.turn_rate * sum.turn_rate + sum.turn * sum.hub_second);
    // The angle of natural modes is another one.
    b.deflection = form_->by_arrays()
                       ? sum.deflection.value + 0.5 * (sum.stretch.value * sum.stretch.value + a * sum.turn * sum.turn)
                       : std::numeric_limits<double>::infinity();
    b.curvature = sum.curvature * (1 + sum.slope);
    b.deflection_speed = std::max(sum.deflection_speed, sum.deflection.rate + axial + b.theta_dot * beyond);
    b.deflection_acceleration =
        std::max(sum.deflection_acceleration,
                 sum.deflection.second + axial_acceleration + (b.theta_ddot + b.theta_dot * b.theta_dot) * beyond);
    b.slope_speed = std::max(sum.slope_speed, sum.slope_rate * (1 + sum.slope));
}

}  // namespace beamcam::sim
