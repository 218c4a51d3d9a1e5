// Bounds of a step of the exponential collocation between its nodes. MODEL.md §12.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/integrate/exponential_segment.hpp"
#include "sim/integrate/step_errors.hpp"

namespace beamcam::sim {

// Bounds within a step.
constexpr double kMissedTurning = 1e-6;    // of Θ̇, which its nodal polynomial may miss at any tolerance
constexpr double kFarthestFromNode = 0.1;  // of the step: no instant is farther from the nearest node

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
    Bounded deflection, stretch;  // stretch: √∫v′²
    double turn = 0, turn_rate = 0, hub_second = 0;
    double slope = 0, slope_rate = 0, curvature = 0;
    double inertia = 0, inertia_rate = 0;  // √|qᵀBq|, √|q̇ᵀBq̇|

    void add(const ModalForm& form, std::size_t i, const Bounded& mode) {
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

// Bounds of |f|, √(q² + (q̇/ω)²) and |q̇| of a mode. |P_j| <= 1 and |P_j′| <= j(j + 1)/h on the step, so
// that sums over the Legendre coefficients of the forcing bound it and its rate. Without forcing the amplitude of the
// vibration is constant, or falls by damping. By forcing it changes in a time τ by at most τ|f|/ω, and by at most twice
// the static deflection |f|/ω² and what that changes meanwhile.                                               (S53)
ExponentialSegment::Largest ExponentialSegment::largest_of(std::size_t i) const {
    const Oscillator& o = form_->oscillators[i];
    const double w2 = o.omega * o.omega, time = (o.gamma > 0 ? 2 : 1) * kFarthestFromNode * h;
    const LegendreRange forcing = legendre_range(f[i]);
    const double force = std::fabs(forcing.mean) + forcing.spread;
    const double square = std::max(q0[i] * q0[i] + v0[i] * v0[i] / w2, largest(q[i] * q[i] + v[i] * v[i] * (1 / w2)));
    const double amplitude =
        std::sqrt(square) + std::min(time * force / o.omega, 2 * (force + time * forcing.slope / h) / w2);
    return {force, amplitude, largest_rate(i, amplitude, force)};
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

std::optional<MotionBounds> ExponentialSegment::bounds() const {
    MotionBounds b;
    VibrationBounds sum;
    for (std::size_t i = 0; i < n_; ++i) {
        const auto [force, amplitude, speed] = largest_of(i);
        const Oscillator& o = form_->oscillators[i];
        sum.add(*form_, i, {amplitude, speed, o.omega * o.omega * amplitude + force + 2 * o.gamma * speed});
    }
    const LegendreRange turning = legendre_range(theta_dot);
    b.theta_dot = largest_turning(turning, sum);
    b.theta_ddot = form_->prescribed ? turning.slope / h : hub_acceleration(sum, b.theta_dot);
    bound_points(sum, b);
    return b;
}

// Bound of |Θ̇|, Θ̇ = p/(J + qᵀBq): the polynomial through its nodal values may miss it by all that bending changes, or
// by rounding and the tolerance. No bound where bending may make the inertia zero.
double ExponentialSegment::largest_turning(const LegendreRange& nodal, const VibrationBounds& sum) const {
    const double bent = form_->prescribed ? 0 : sum.inertia * sum.inertia, least = form_->J - bent;
    if (!(least > 0)) return std::numeric_limits<double>::infinity();
    const double missed = kMissedTurning + 2 * bent / least;
    return std::fabs(nodal.mean) + (nodal.spread + (std::fabs(nodal.mean) + nodal.spread) * missed);
}

// Θ̈ = [ṗ − 2Θ̇qᵀBq̇]/(J + qᵀBq); no bound where bending may make the inertia zero.
double ExponentialSegment::hub_acceleration(const VibrationBounds& sum, double fastest) const {
    const double least = form_->J - sum.inertia * sum.inertia;
    if (!(least > 0)) return std::numeric_limits<double>::infinity();
    const LegendreRange load = legendre_range(p_dot);
    return (std::fabs(load.mean) + load.spread + 2 * fastest * sum.inertia * sum.inertia_rate) / least;
}

// The beam shortens, u = −½∫v′² − ½aα², and its points are up to √(reach² + v²) away from the hinge.
void ExponentialSegment::bound_points(const VibrationBounds& sum, MotionBounds& b) const {
    const double a = form_->shortening ? std::fabs(form_->radius) : 0;
    const double beyond =
        0.5 * sum.deflection.value * sum.deflection.value / (std::fabs(form_->radius) + form_->length);
    const double axial = sum.stretch.value * sum.stretch.rate + a * sum.turn * sum.turn_rate;
    const double axial_acceleration = sum.stretch.rate * sum.stretch.rate + sum.stretch.value * sum.stretch.second +
                                      a * (sum.turn_rate * sum.turn_rate + sum.turn * sum.hub_second);
    b.curvature = sum.curvature * (1 + sum.slope);
    b.deflection_speed = sum.deflection.rate + axial + b.theta_dot * beyond;
    b.deflection_acceleration =
        sum.deflection.second + axial_acceleration + (b.theta_ddot + b.theta_dot * b.theta_dot) * beyond;
    b.slope_speed = sum.slope_rate * (1 + sum.slope);
}

}  // namespace beamcam::sim
