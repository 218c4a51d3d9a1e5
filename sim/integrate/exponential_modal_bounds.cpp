// Bounds of each mode within a step of the exponential collocation. MODEL.md (S59).
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/integrate/constants.hpp"
#include "sim/integrate/exponential_segment.hpp"
#include "sim/integrate/lane_kernels.hpp"
#include "sim/integrate/step_errors.hpp"

namespace beamcam::sim {

void ModalBounds::Mode::set_frequencies(double third, double fourth) {
    const auto frequency = [](double largest, double first, double second) {
        return largest > 0 ? std::max(first / largest, std::sqrt(second / largest)) : 0;
    };
    q_frequency = frequency(amplitude, rate, acceleration);
    rate_frequency = frequency(rate, acceleration, third);
    acceleration_frequency = frequency(acceleration, third, fourth);
}

// Of the modes of a group: the mean of the forcing, bounds of its distance from that and of its first two derivatives
// by those of its Legendre polynomials, |P_j⁽ᵐ⁾| ≤ (j + m)!/(m!(j − m)!hᵐ); x = q − f/ω² and ẋ at the start and the
// nodes, and the largest √(x² + (ẋ/ω)²).
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

// Bounds of x = q − f/ω² and ẋ. It is driven by g = −(f″ + 2γf′)/ω². From a point on, √(x² + (ẋ/ω)²) grows by at
// most |g|/ω times the time; it is the same in both directions without damping.                           (S59)
ExponentialSegment::Distances ExponentialSegment::distances_of(std::size_t g, const ForcingBounds& forcing) const {
    const OscillatorLanes& o = form_->groups[g];
    Lanes time;
    for (int lane = 0; lane < kNodes; ++lane) time[lane] = (o.gamma[lane] > 0 ? 2 : 1) * kFarthestFromNode * h;
    const Lanes driven = (forcing.second + o.damping * forcing.rate) / o.square;
    Distances out;
    out.value = forcing.vibration + time * driven / o.omega;
    out.rate = o.omega * out.value;
    if (!has_fast(g)) return out;
    const Lanes lag = magnitude(lag_[g]), faster = 1 + lag / o.omega;  // the lag turns x and the damped rate
    out.value = out.value * (1 + time * lag);
    out.rate = out.rate * (1 + time * lag) * faster;
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
}

// Of the free vibration that remains besides the polynomial response to the forcing, which the state at the start
// determines: √(x² + (ẋ/ω)²) there.
Lanes ExponentialSegment::free_vibrations(std::size_t g) const {
    Lanes p, slope;
    follow_forcing(g, p, slope);
    const Lanes x = lanes_q_[g * kPoints] - p, dx = (lanes_v_[g * kPoints] - slope) / form_->groups[g].omega;
    Lanes amplitude = x * x + dx * dx;
    for (int lane = 0; lane < kNodes; ++lane) amplitude[lane] = std::sqrt(amplitude[lane]);
    return amplitude;
}

// Without damping the amplitude of a free vibration is constant; with less than the critical one √(x² + (ẋ/ω)²) is at
// most √((1 + ζ)/(1 − ζ)) e^(−γτ) times that at the start.
void ExponentialSegment::set_vibration(const Oscillator& o, double lag, double amplitude,
                                       ModalBounds::Mode& mode) const {
    const double ratio = o.gamma / o.omega, omega = o.omega + lag;
    mode.swings[0] = {amplitude,
                      omega * amplitude,
                      omega * (omega + 2 * o.gamma) * amplitude,
                      omega + 2 * o.gamma,
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
    const Lanes free = free_vibrations(g);
    const Lanes mean = forcing.mean / o.square, range = forcing.range / o.square + x.value;
    Lanes acceleration = o.square * amplitude + force + o.damping * speed;
    const Lanes low = larger(-amplitude, mean - range), high = smaller(amplitude, mean + range);
    amplitude = smaller(amplitude, larger(-low, high));
    speed = smaller(speed, x.rate + forcing.rate / o.square);
    // q̈ + 2γq̇ = −ω²x
    const Lanes turning = o.omega + magnitude(lag_[g]), square = turning * turning;
    acceleration = smaller(acceleration, square * x.value + o.damping * speed);
    const Lanes third = square * speed + forcing.rate + o.damping * acceleration,
                fourth = square * acceleration + forcing.second + o.damping * third;
    const Lanes vibrations = smaller(2 * amplitude, free);
    for (std::size_t i = first; i < first + count; ++i) {
        const int lane = static_cast<int>(i - first);
        ModalBounds::Mode& mode = modes[i];
        mode.low = low[lane];
        mode.high = high[lane];
        mode.amplitude = amplitude[lane];
        mode.rate = speed[lane];
        mode.acceleration = acceleration[lane];
        mode.set_frequencies(third[lane], fourth[lane]);
        mode.lag = lag_[g][lane];
        const Oscillator& oscillator = form_->oscillators[i];
        if (!(oscillator.omega > 0))
            mode.swings[0] = mode.swings[1] = {};
        else if (decays(oscillator))
            set_decays(i, mode);
        else
            set_vibration(oscillator, std::fabs(lag_[g][lane]), vibrations[lane], mode);
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

// Bound of the work of the forces κ_ij w_j that are left out, and of the weight of these vibrations, whose moment is.
double ExponentialSegment::work_left_out() const {
    const double spin = bounds_.theta_dot * bounds_.theta_dot, gravity = std::fabs(form_->gravity),
                 reach = std::fabs(form_->radius) + 0.5 * form_->length;
    const double second = form_->paper ? spin * reach * form_->length : gravity;  // |Y| at most
    double work = 0;
    for (std::size_t j = left_out.first(); j < n_; ++j) {
        if (!left_out.contains(j)) continue;
        const double w = form_->oscillators[j].omega, vibration = largest_[j].amplitude + largest_[j].force / (w * w);
        for (std::size_t i = 0; i < n_; ++i) {
            const double kappa = std::max(std::fabs(form_->coupling(i, j, spin, second)),
                                          std::fabs(form_->coupling(i, j, spin, -second)));
            work += kappa * vibration * largest_[i].amplitude;
        }
        work += gravity * std::fabs(form_->weight[j]) * vibration * bounds_.theta_dot / w;
    }
    return form_->mass * work;
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
    if (left_out.any()) b.balance_error += work_left_out();
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
