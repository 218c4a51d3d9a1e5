// Bounds of a step of the exponential collocation between its nodes. MODEL.md §12.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/integrate/constants.hpp"
#include "sim/integrate/exponential_segment.hpp"
#include "sim/integrate/lane_kernels.hpp"
#include "sim/integrate/step_errors.hpp"

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
    }
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
    b.slope = sum.slope;
    b.curvature = sum.curvature * (1 + sum.slope);
    b.deflection_speed = std::max(sum.deflection_speed, sum.deflection.rate + axial + b.theta_dot * beyond);
    b.deflection_acceleration =
        std::max(sum.deflection_acceleration,
                 sum.deflection.second + axial_acceleration + (b.theta_ddot + b.theta_dot * b.theta_dot) * beyond);
    b.slope_speed = std::max(sum.slope_speed, sum.slope_rate * (1 + sum.slope));
}

void ModalBounds::Mode::set_frequencies(double jerk) {
    const auto frequency = [](double largest, double first, double second) {
        return largest > 0 ? std::max(first / largest, std::sqrt(second / largest)) : 0;
    };
    q_frequency = frequency(amplitude, rate, acceleration);
    rate_frequency = frequency(rate, acceleration, jerk);
}

// Of the modes of a group: the mean of the forcing, bounds of its distance from that and of its first two derivatives
// by those of its Legendre polynomials; x = q − f/ω² and ẋ at the start and the nodes, and the largest √(x² + (ẋ/ω)²).
struct ExponentialSegment::ForcingBounds {
    Lanes mean{}, range{}, rate{}, second{}, vibration{};
    Lanes x[kPoints] = {}, dx[kPoints] = {};
};

ExponentialSegment::ForcingBounds ExponentialSegment::forcing_bounds(std::size_t g, const Lanes* legendre) const {
    const Collocation& gauss = Collocation::get();
    const OscillatorLanes& group = form_->groups[g];
    ForcingBounds out;
    out.mean = legendre[0];
    for (int j = 1; j < kNodes; ++j) {
        const Lanes c = magnitude(legendre[j]);
        out.range += c;
        out.rate += c * j * (j + 1) / h;
        out.second += c * ((j - 1) * j * (j + 1) * (j + 2)) / (2 * h * h);
    }
    const Lanes* forcing = lanes_f_.data() + g * kNodes;
    Lanes value[kPoints] = {}, slope[kPoints] = {};
    for (std::size_t l = 0; l < kNodes; ++l) {
        value[0] += gauss.derive[0][0][static_cast<int>(l)] * forcing[l];
        slope[0] += gauss.derive[0][1][static_cast<int>(l)] * forcing[l];
        value[l + 1] = forcing[l];
    }
    lane_kernels().combine(gauss.slope_at.data(), forcing, slope + 1);
    const Lanes per_square = 1 / group.square, per_step = 1 / (h * group.square);
    for (std::size_t k = 0; k < kPoints; ++k) {
        out.x[k] = lanes_q_[g * kPoints + k] - per_square * value[k];
        out.dx[k] = lanes_v_[g * kPoints + k] - per_step * slope[k];
        // Undamped vibration reaches back to the start from the first node.
        if (k > 0 || group.damped)
            out.vibration = larger(out.vibration, out.x[k] * out.x[k] + out.dx[k] * out.dx[k] / group.square);
    }
    for (int lane = 0; lane < kNodes; ++lane) out.vibration[lane] = std::sqrt(out.vibration[lane]);
    return out;
}

// Bounds of x = q − f/ω², ẋ and ẍ. It is driven by g = −(f″ + 2γf′)/ω². From a point on, √(x² + (ẋ/ω)²) grows by at
// most |g|/ω times the time; it is the same in both directions without damping.                           (S59)
ExponentialSegment::Distances ExponentialSegment::distances_of(std::size_t g, const ForcingBounds& forcing) const {
    const OscillatorLanes& o = form_->groups[g];
    Lanes time;
    for (int lane = 0; lane < kNodes; ++lane) time[lane] = (o.gamma[lane] > 0 ? 2 : 1) * kFarthestFromNode * h;
    const Lanes driven = (forcing.second + o.damping * forcing.rate) / o.square;
    Distances out;
    out.value = forcing.vibration + time * driven / o.omega;
    out.rate = o.omega * out.value;
    out.second = (o.square + o.damping * o.omega) * out.value + driven;
    return out;
}

// In two decays r₁ < r₂ the fast one is u = ẋ + r₁x with u̇ = −r₂u + g.                                     (S59)
void ExponentialSegment::set_distance_of_decays(std::size_t i, const ForcingBounds& forcing, Distances& out) const {
    const int lane = static_cast<int>(i % kNodes);
    const Oscillator& o = form_->oscillators[i];
    const Decays d = decays_of(o);
    const double driven = (forcing.second[lane] + 2 * o.gamma * forcing.rate[lane]) / (o.omega * o.omega);
    const double time = 2 * kFarthestFromNode * h, memory = std::min(time, 1 / d.fast), lasting = driven * memory;
    double farthest = 0, started = 0;  // |x|, |u| at a point
    for (std::size_t k = 0; k < kPoints; ++k) {
        farthest = std::max(farthest, std::fabs(forcing.x[k][lane]));
        started = std::max(started, std::fabs(forcing.dx[k][lane] + d.slow * forcing.x[k][lane]));
    }
    out.value[lane] = farthest + started * memory + lasting * time;
    out.rate[lane] = started + lasting + d.slow * out.value[lane];
    out.second[lane] = d.fast * (started + lasting) + driven + d.slow * out.rate[lane];
}

// The response to a forcing that is a polynomial is a polynomial p = Σ c_j f⁽ʲ⁾ and a free vibration, which the state
// at the start determines: its √(x² + (ẋ/ω)²) there.
Lanes ExponentialSegment::free_vibrations(std::size_t g) const {
    const OscillatorLanes& o = form_->groups[g];
    const Lanes* derivatives = taylor_.data() + g * kNodes;
    Lanes before{}, here = o.inverse_square, p{}, slope{};
    for (int j = 0; j < kNodes; ++j) {
        p += here * derivatives[j];
        if (j + 1 < kNodes) slope += here * derivatives[j + 1];
        before = std::exchange(here, -(o.damping * here + before) * o.inverse_square);
    }
    const Lanes x = lanes_q_[g * kPoints] - p, dx = (lanes_v_[g * kPoints] - slope) / o.omega;
    Lanes amplitude = x * x + dx * dx;
    for (int lane = 0; lane < kNodes; ++lane) amplitude[lane] = std::sqrt(amplitude[lane]);
    return amplitude;
}

// Without damping the amplitude of a free vibration is constant; with less than the critical one √(x² + (ẋ/ω)²) is at
// most √((1 + ζ)/(1 − ζ)) e^(−γτ) times that at the start.
void ExponentialSegment::set_vibration(const Oscillator& o, double amplitude, ModalBounds::Mode& mode) const {
    const double ratio = o.gamma / o.omega;
    mode.swings[0] = {amplitude,
                      o.omega * amplitude,
                      o.omega * (o.omega + 2 * o.gamma) * amplitude,
                      o.omega + 2 * o.gamma,
                      ratio < 1 ? o.gamma : 0,
                      ratio > 0 && ratio < 1 ? std::sqrt((1 + ratio) / (1 - ratio)) : 1};
    mode.swings[1] = {};
}

// Two decays respond separately (S52a); a slow one may be a polynomial by itself.
void ExponentialSegment::set_decays(std::size_t i, ModalBounds::Mode& mode) const {
    const int lane = static_cast<int>(i % kNodes);
    const Lanes* derivatives = taylor_.data() + i / kNodes * kNodes;
    const Decays d = decays_of(form_->oscillators[i]);
    const auto free_part = [&](double decay, double sign, double start) -> ModalBounds::Mode::Swing {
        double p = 0, factor = sign / (decay * d.apart());
        for (int j = 0; j < kNodes; ++j, factor *= -1 / decay) p += factor * derivatives[j][lane];
        const double value = std::min(2 * mode.amplitude, std::fabs(start - p));
        return {value, decay * value, decay * decay * value, decay, decay, 1};
    };
    mode.swings[0] = free_part(d.fast, -1, -(v0[i] + d.slow * q0[i]) / d.apart());
    mode.swings[1] = {};
    if (!(d.slow * h < kResolvedRadians)) mode.swings[1] = free_part(d.slow, 1, (v0[i] + d.fast * q0[i]) / d.apart());
}

// Of the modes of a group, from q = x + f/ω². Lanes without stiffness divide by zero; their NaN is passed over.
void ExponentialSegment::bound_modes(std::size_t g, const ForcingBounds& forcing, ModalBounds::Mode* modes) const {
    const OscillatorLanes& o = form_->groups[g];
    const std::size_t first = g * kNodes, count = std::min(n_ - first, static_cast<std::size_t>(kNodes));
    Lanes amplitude{}, speed{}, force{};
    Distances x = distances_of(g, forcing);
    for (std::size_t i = first; i < first + count; ++i) {
        const int lane = static_cast<int>(i - first);
        amplitude[lane] = largest_[i].amplitude;
        speed[lane] = largest_[i].rate;
        force[lane] = largest_[i].force;
        if (decays(form_->oscillators[i])) set_distance_of_decays(i, forcing, x);
    }
    const Lanes mean = forcing.mean / o.square, range = forcing.range / o.square + x.value;
    Lanes acceleration = o.square * amplitude + force + o.damping * speed;
    const Lanes low = larger(-amplitude, mean - range), high = smaller(amplitude, mean + range);
    amplitude = smaller(amplitude, larger(-low, high));
    speed = smaller(speed, x.rate + forcing.rate / o.square);
    // q̈ + 2γq̇ = −ω²x, or ẍ + f″/ω².
    acceleration =
        smaller(smaller(acceleration, o.square * x.value + o.damping * speed), x.second + forcing.second / o.square);
    const Lanes jerk = o.square * speed + forcing.rate + o.damping * acceleration;
    const Lanes vibrations = smaller(2 * amplitude, free_vibrations(g));
    for (std::size_t i = first; i < first + count; ++i) {
        const int lane = static_cast<int>(i - first);
        ModalBounds::Mode& mode = modes[i];
        mode.low = low[lane];
        mode.high = high[lane];
        mode.amplitude = amplitude[lane];
        mode.rate = speed[lane];
        mode.acceleration = acceleration[lane];
        mode.set_frequencies(jerk[lane]);
        const Oscillator& oscillator = form_->oscillators[i];
        if (!(oscillator.omega > 0))
            mode.swings[0] = mode.swings[1] = {};
        else if (decays(oscillator))
            set_decays(i, mode);
        else
            set_vibration(oscillator, vibrations[lane], mode);
    }
}

// Bound of the work of a forcing cP₈, which vanishes at the nodes, from the nearer end of the step on; per c. It
// changes its sign at every node: at any speed its work between two of them counts, and at a speed that hardly changes
// its integral, in which one node makes up for another.
double work_between_nodes(double speed, double acceleration, double h) {
    return h * std::min(kNodeGap * speed, kLegendreIntegral * speed + kLegendreTurning * h * acceleration);
}

// Work of the forcing that the nodes miss on the modes of a group. Its first term is the Legendre polynomial P₈, whose
// coefficient is extrapolated from the last two pairs.
double ExponentialSegment::missed_work(std::size_t g, const Lanes* legendre) const {
    const Lanes last = larger(magnitude(legendre[6]), magnitude(legendre[7])),
                before = larger(magnitude(legendre[4]), magnitude(legendre[5]));
    Lanes speed{};
    for (std::size_t k = 0; k < kPoints; ++k) speed = larger(speed, magnitude(lanes_v_[g * kPoints + k]));
    double work = 0;
    for (std::size_t i = g * kNodes; i < std::min(n_, (g + 1) * kNodes); ++i) {
        const int lane = static_cast<int>(i % kNodes);
        if (!(last[lane] > 0)) continue;
        const double missed = last[lane] * (touching ? 1 : std::min(1.0, last[lane] / before[lane]));
        work += form_->mass * missed * work_between_nodes(speed[lane], modal_bounds_.modes[i].acceleration, h);
    }
    return work;
}

const ModalBounds* ExponentialSegment::modal_bounds() const {
    if (modal_bounds_known_) return &modal_bounds_;
    modal_bounds_known_ = true;
    bounds();
    ModalBounds& b = modal_bounds_;
    b.modes.resize(n_);
    transpose();
    expand(0);
    const LegendreDecay torque = legendre_decay(p_dot);
    b.balance_error =
        torque.last * (touching ? 1 : torque.ratio) * work_between_nodes(largest(theta_dot), bounds_.theta_ddot, h);
    for (std::size_t g = 0; g < form_->groups.size(); ++g) {
        Lanes legendre[kNodes];
        lane_kernels().combine(Collocation::get().legendre.data(), lanes_f_.data() + g * kNodes, legendre);
        const ForcingBounds forcing = forcing_bounds(g, legendre);
        bound_modes(g, forcing, b.modes.data());
        b.balance_error += missed_work(g, legendre);
    }
    b.q = q;
    b.rate = v;
    b.force = f;
    b.theta_dot = b.angle = theta_dot;
    if (!form_->prescribed) {
        b.angle = Lanes{} + theta0;
        for (int l = 0; l < kNodes; ++l)
            b.angle += (h * theta_dot[l]) * Collocation::get().integrate[static_cast<std::size_t>(l)];
    }
    b.h = h;
    b.power_cam = ledger_changes ? kNodeOvershoot * largest(rate[kWorkCam]) : 0;
    b.power_drive = ledger_changes ? kNodeOvershoot * largest(rate[kWorkDrive]) : 0;
    return &b;
}

}  // namespace beamcam::sim
