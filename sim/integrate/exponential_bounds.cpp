// What a step of the exponential collocation cannot exceed between its nodes. MODEL.md §12.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/integrate/constants.hpp"
#include "sim/integrate/exponential_segment.hpp"
#include "sim/integrate/lane_kernels.hpp"

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

// Over all modes: how far and how fast the beam's points, its tangent and its hub may go by vibrating.
struct VibrationBounds {
    double deflection_speed = 0, deflection_acceleration = 0, slope_speed = 0;  // by the shapes' crude bounds
    Bounded deflection, stretch;                                                // stretch: √∫v′²
    double turn = 0, turn_rate = 0, hub_second = 0;
    double slope = 0, slope_rate = 0, curvature = 0;
    double inertia = 0, inertia_rate = 0;  // √|qᵀBq| and what q̇ᵀBq is below it times

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

// Bound of √(q² + (q̇/ω)²).
double ExponentialSegment::largest_amplitude(std::size_t i, double force) const {
    const double w = form_->oscillators[i].omega;
    const Lanes square = q[i] * q[i] + v[i] * v[i] / (w * w);
    const double at_nodes = std::sqrt(std::max(largest(square), q0[i] * q0[i] + v0[i] * v0[i] / (w * w)));
    return at_nodes + force / w * std::min(kFarthestFromNode * h, 2 / w);
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

// Between two nodes the amplitude √(q² + (q̇/ω)²) of a mode changes by at most ∫|f|/ω, and by twice the static
// deflection |f|/ω²; polynomials between nodes stay near their nodal values (Lebesgue's constant of Gauss nodes
// is 3: the spread is added on either side).                                                             (S53)
const MotionBounds* ExponentialSegment::bounds() const {
    if (bounds_known_) return &bounds_;
    bounds_known_ = true;
    MotionBounds& b = bounds_;
    b = {};
    VibrationBounds sum;
    double speeds[kMaxModes];
    for (std::size_t i = 0; i < n_; ++i) {
        const double w = form_->oscillators[i].omega;
        const double force = kNodeOvershoot * largest(f[i]), amplitude = largest_amplitude(i, force);
        const double speed = largest_rate(i, amplitude, force);
        largest_[i] = {force, amplitude, speed};
        sum.add(*form_, i, {amplitude, speed, w * w * amplitude + force + 2 * form_->oscillators[i].gamma * speed});
        speeds[i] = form_->shape[i] * speed;
    }
    double low = spin[0], high = spin[0];
    for (int k = 1; k < kNodes; ++k) {
        low = std::min(low, spin[k]);
        high = std::max(high, spin[k]);
    }
    const double spread = (high - low) + 1e-6 * std::max(std::fabs(low), std::fabs(high));
    low -= spread;
    high += spread;
    b.ripple = sum.turn;
    b.ripple_rate = sum.turn_rate;
    b.spin = std::max(std::fabs(low), std::fabs(high));
    b.spin_acceleration = form_->prescribed ? 4 * (high - low) / h
                                            : std::max(2 * largest(push) / form_->J, hub_acceleration(sum, b.spin));
    const double whole = b.spin * (std::fabs(form_->radius) + form_->length) + sum.deflection.rate;
    double faster = 0;
    for (std::size_t i = n_; i-- > 0 && b.fastest == 0;)
        if ((faster += speeds[i]) > kVibrationRounding * whole) b.fastest = form_->oscillators[i].omega;
    bound_points(sum, b);
    b.rate_low = low - sum.turn_rate;
    b.rate_high = high + sum.turn_rate;
    const double first = form_->prescribed ? drive_.motion(t0).angle : theta0;
    b.angle_low = first + std::min(0.0, low) * h - sum.turn;
    b.angle_high = first + std::max(0.0, high) * h + sum.turn;
    return &b;
}

// Θ̈ = [ṗ − 2Θ̇qᵀBq̇]/(J + qᵀBq); no bound where bending may take the inertia away.
double ExponentialSegment::hub_acceleration(const VibrationBounds& sum, double fastest_spin) const {
    const double least = form_->J - sum.inertia * sum.inertia;
    if (!(least > 0)) return std::numeric_limits<double>::infinity();
    return (kNodeOvershoot * largest(push) + 2 * fastest_spin * sum.inertia * sum.inertia_rate) / least;
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
    b.deflection_speed = std::max(sum.deflection_speed, sum.deflection.rate + axial + b.spin * beyond);
    b.deflection_acceleration =
        std::max(sum.deflection_acceleration,
                 sum.deflection.second + axial_acceleration + (b.spin_acceleration + b.spin * b.spin) * beyond);
    b.slope_speed = std::max(sum.slope_speed, sum.slope_rate * (1 + sum.slope));
}

// The oscillation about f/ω² is driven by −(f″ + 2γf′)/ω² and so changes its amplitude between two nodes by at most
// (|f″| + 2γ|f′|)/ω³ times half their distance; f is bounded by the derivatives of its Legendre polynomials.   (S59)
ModalBounds::Mode ExponentialSegment::mode_bounds(std::size_t i, const Lanes* legendre) const {
    const Collocation& gauss = Collocation::get();
    const int lane = static_cast<int>(i % kNodes);
    const Oscillator& o = form_->oscillators[i];
    const double force = largest_[i].force, square = o.omega * o.omega;
    double force_range = 0, force_rate = 0, force_second = 0;  // the first: about the mean
    for (int j = 1; j < kNodes; ++j) {
        const double c = std::fabs(legendre[j][lane]);
        force_range += c;
        force_rate += c * j * (j + 1) / h;
        force_second += c * ((j - 1) * j * (j + 1) * (j + 2)) / (2 * h * h);
    }
    ModalBounds::Mode mode;
    mode.amplitude = largest_[i].amplitude;
    mode.rate = largest_[i].rate;
    mode.acceleration = square * mode.amplitude + force + 2 * o.gamma * mode.rate;
    mode.low = -mode.amplitude;
    mode.high = mode.amplitude;
    if (o.omega > 0 && !decays(o)) {
        Lanes slope{};
        for (int l = 0; l < kNodes; ++l) slope += f[i][l] * gauss.slope[static_cast<std::size_t>(l)];
        const Lanes free = q[i] - (1 / square) * f[i], free_rate = (1 / o.omega) * (v[i] - (1 / (h * square)) * slope);
        const double decay = o.gamma > 0 ? std::exp(o.gamma * kFarthestFromNode * h) : 1;
        const double driven = kFarthestFromNode * h * (force_second + 2 * o.gamma * force_rate) / (square * o.omega);
        const double swing = std::sqrt(largest(free * free + free_rate * free_rate)) * decay + driven;
        // q̇ = ḟ/ω² + ẋ and q̈ + 2γq̇ = −ω²x of the oscillation x about f/ω².
        const double mean = legendre[0][lane] / square, range = force_range / square + swing;
        mode.low = std::max(mode.low, mean - range);
        mode.high = std::min(mode.high, mean + range);
        mode.rate = std::min(mode.rate, o.omega * swing + force_rate / square);
        mode.acceleration = std::min(mode.acceleration, square * swing + 2 * o.gamma * mode.rate);
    }
    const auto frequency = [](double largest, double first, double second) {
        return largest > 0 ? std::max(first / largest, std::sqrt(second / largest)) : 0;
    };
    const double jerk = square * mode.rate + force_rate + 2 * o.gamma * mode.acceleration;
    mode.q_frequency = frequency(mode.amplitude, mode.rate, mode.acceleration);
    mode.rate_frequency = frequency(mode.rate, mode.acceleration, jerk);
    return mode;
}

const ModalBounds* ExponentialSegment::modal_bounds() const {
    if (!form_->by_arrays()) return nullptr;
    if (modal_bounds_known_) return &modal_bounds_;
    modal_bounds_known_ = true;
    bounds();
    ModalBounds& b = modal_bounds_;
    b.modes.resize(n_);
    turn();
    for (std::size_t g = 0; g < begin_q_.size(); ++g) {
        Lanes legendre[kNodes];
        lane_kernels().combine(Collocation::get().legendre.data(), turned_.data() + g * kNodes, legendre);
        for (std::size_t i = g * kNodes; i < std::min(n_, (g + 1) * kNodes); ++i) b.modes[i] = mode_bounds(i, legendre);
    }
    b.q = q;
    b.rate = v;
    b.force = f;
    b.spin = b.angle = spin;
    if (!form_->prescribed) {
        b.angle = Lanes{} + theta0;
        for (int l = 0; l < kNodes; ++l)
            b.angle += (h * spin[l]) * Collocation::get().integrate[static_cast<std::size_t>(l)];
    }
    b.h = h;
    b.power_cam = ledger_changes ? kNodeOvershoot * largest(rate[kWorkCam]) : 0;
    b.power_drive = ledger_changes ? kNodeOvershoot * largest(rate[kWorkDrive]) : 0;
    return &b;
}

}  // namespace beamcam::sim
