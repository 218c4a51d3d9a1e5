#include "sim/integrate/exponential_segment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/integrate/lane_kernels.hpp"

namespace beamcam::sim {

namespace {

constexpr double kBetweenNodes = 1.5;  // of what a polynomial may exceed its values at the nodes by
constexpr double kRounding = 1e-11;    // of the speed of the beam's points: vibrations that do not matter
constexpr double kToNode = 0.1;        // of the step: no instant is farther from the nearest node

}  // namespace

template <class Visit>
void ExponentialSegment::each_number(Visit&& visit) {
    const auto lanes = [&](Lanes& l) {
        for (int k = 0; k < kNodes; ++k) {
            double value = l[k];
            visit(value);
            l[k] = value;
        }
    };
    for (double* one : {&h, &theta0, &p0, &boundary0}) visit(*one);
    for (std::vector<double>* all : {&q0, &v0, &end})
        for (double& one : *all) visit(one);
    for (std::vector<Lanes>* all : {&q, &v, &f})
        for (Lanes& one : *all) lanes(one);
    lanes(spin);
    lanes(push);
    for (double& one : ledger0) visit(one);
    const auto flag = [&](bool& on) {
        double value = on;
        visit(value);
        on = value != 0;
    };
    flag(ledger_changes);
    if (ledger_changes)
        for (Lanes& one : rate) lanes(one);
    flag(touching);
    if (!touching) return;
    for (auto* all : {&samples.t, &samples.gap, &samples.gap_rate, &samples.force, &samples.x})
        for (double& one : *all) visit(one);
    double ending = static_cast<int>(samples.ending);
    visit(ending);
    samples.ending = static_cast<TouchSamples::Ending>(static_cast<int>(ending));
}

SegmentKind ExponentialSegment::numbers(std::vector<double>& out) const {
    // Only read, by this visitor.
    const_cast<ExponentialSegment*>(this)->each_number([&](const double& value) { out.push_back(value); });
    return SegmentKind::exponential;
}

void ExponentialSegment::load(double begin, double end_time, std::span<const double> numbers) {
    t0 = begin;
    t1 = end_time;
    std::size_t next = 0;
    each_number([&](double& value) {
        if (next == numbers.size()) throw std::invalid_argument("a segment of the trajectory is too short");
        value = numbers[next++];
    });
    if (next != numbers.size()) throw std::invalid_argument("a segment of the trajectory is too long");
    changed();
}

namespace {

class StoredExponential final : public StoredSegment {
  public:
    explicit StoredExponential(const Problem& problem)
        : system_(problem), segment_(form(system_), system_.drive(), system_.size) {}
    void load(double begin, double end, std::span<const double> numbers) override {
        t0 = begin;
        t1 = end;
        segment_.load(begin, end, numbers);
    }
    void value(double t, double* y) const override { segment_.value(t, y); }
    const MotionBounds* bounds() const override { return segment_.bounds(); }
    const ModalBounds* modal_bounds() const override { return segment_.modal_bounds(); }
    double balance_error() const override { return segment_.balance_error(); }
    SegmentKind numbers(std::vector<double>& out) const override { return segment_.numbers(out); }
    const TouchSamples* touch() const override { return segment_.touch(); }

  private:
    static std::shared_ptr<const ModalForm> form(System& system) {
        auto made = ModalForm::of(system);
        if (!made) throw std::invalid_argument("the trajectory does not belong to this problem");
        return made;
    }
    System system_;
    ExponentialSegment segment_;
};

// Bounds of a function of the modes, of its rate and of its second derivative.
struct Bounded {
    double value = 0, rate = 0, second = 0;
    void add(double factor, const Bounded& q) {
        value += factor * q.value;
        rate += factor * q.rate;
        second += factor * q.second;
    }
};

}  // namespace

std::unique_ptr<StoredSegment> make_stored_exponential(const Problem& problem) {
    return std::make_unique<StoredExponential>(problem);
}

ExponentialSegment::ExponentialSegment(std::shared_ptr<const ModalForm> modal_form, const DriveLaw& drive_law,
                                       int state_size)
    : form_(std::move(modal_form)), drive_(drive_law), n_(static_cast<std::size_t>(form_->n)) {
    controlled_ = static_cast<std::size_t>(state_size) - kLedgerSize;
    q0.resize(n_);
    v0.resize(n_);
    q.resize(n_);
    v.resize(n_);
    f.resize(n_);
    end.resize(static_cast<std::size_t>(state_size));
    const std::size_t groups = form_->groups.size();
    turned_.resize(groups * kNodes);
    taylor_.resize(groups * kNodes);
    begin_q_.resize(groups);
    begin_v_.resize(groups);
}

double ExponentialSegment::spin_at(double p, const double* x) const {
    double quadratic = 0;
    for (std::size_t i = 0; i < n_; ++i) {
        double row = 0;
        for (std::size_t j = 0; j < n_; ++j) row += form_->inertia[i * n_ + j] * x[j];
        quadratic += row * x[i];
    }
    return p / (form_->J + quadratic);
}

// Derivatives of the forcing at the start of the step or at a node, and where the modes are there.
void ExponentialSegment::expand(int at) const {
    if (expanded_ == at) return;
    expanded_ = at;
    if (!turned_known_) {
        turned_known_ = true;
        for (std::size_t i = 0; i < n_; ++i)
            for (int l = 0; l < kNodes; ++l)
                turned_[i / kNodes * kNodes + static_cast<std::size_t>(l)][static_cast<int>(i % kNodes)] = f[i][l];
    }
    std::array<Lanes, kNodes> factors = Collocation::get().derive[static_cast<std::size_t>(at)];
    double inverse = 1;
    for (Lanes& factor : factors) {
        factor *= inverse;
        inverse /= h;
    }
    for (std::size_t g = 0; g < begin_q_.size(); ++g) {
        lane_kernels().combine(factors.data(), turned_.data() + g * kNodes, taylor_.data() + g * kNodes);
        for (std::size_t i = g * kNodes; i < std::min(n_, (g + 1) * kNodes); ++i) {
            const int lane = static_cast<int>(i % kNodes);
            begin_q_[g][lane] = at == 0 ? q0[i] : q[i][at - 1];
            begin_v_[g][lane] = at == 0 ? v0[i] : v[i][at - 1];
        }
    }
}

void ExponentialSegment::value(double t, double* y) const {
    if (t == t1) {
        std::copy(end.begin(), end.end(), y);
        return;
    }
    const Collocation& gauss = Collocation::get();
    const double s = (t - t0) / h;
    int at = 0;
    while (at < kNodes && gauss.point[static_cast<std::size_t>(at) + 1] <= s) ++at;
    expand(at);
    const double tau = (s - gauss.point[static_cast<std::size_t>(at)]) * h;
    double* rates = y + 1 + n_;
    for (std::size_t g = 0; g < begin_q_.size(); ++g) {
        Lanes r[kResponse], x, dx;
        const OscillatorLanes& group = form_->groups[g];
        respond(group, tau, r);
        lane_kernels().evolve(group, r, taylor_.data() + g * kNodes, begin_q_[g], begin_v_[g], x, dx);
        for (std::size_t i = g * kNodes; i < std::min(n_, (g + 1) * kNodes); ++i) {
            y[1 + i] = x[static_cast<int>(i % kNodes)];
            rates[1 + i] = dx[static_cast<int>(i % kNodes)];
        }
    }
    Lanes weights;
    gauss.weights_to(s, weights);
    if (form_->prescribed) {
        const HubMotion hub = drive_.motion(t);
        y[0] = hub.angle;
        rates[0] = hub.rate;
    } else {
        y[0] = theta0 + h * sum(weights * spin);
        rates[0] = spin_at(p0 + h * sum(weights * push), y + 1);
    }
    for (std::size_t k = 2 * (n_ + 1); k < controlled_; ++k) y[k] = end[k];
    std::copy_n(ledger0, kLedgerSize, y + controlled_);
    if (ledger_changes) ledger_at(t, s, weights, y);
    form_->to_coordinates(y);
}

// Bound of √(q² + (q̇/ω)²).
double ExponentialSegment::largest_amplitude(std::size_t i, double force) const {
    const double w = form_->oscillators[i].omega;
    const Lanes square = q[i] * q[i] + v[i] * v[i] / (w * w);
    const double at_nodes = std::sqrt(std::max(largest(square), q0[i] * q0[i] + v0[i] * v0[i] / (w * w)));
    return at_nodes + force / w * std::min(kToNode * h, 2 / w);
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
// is 3: kMargin of the spread is added).                                                                 (S53)
const MotionBounds* ExponentialSegment::bounds() const {
    if (bounds_known_) return &bounds_;
    bounds_known_ = true;
    MotionBounds& b = bounds_;
    b = {};
    constexpr double kMargin = 1;
    const double shape = 3 + 3 * std::fabs(form_->radius) / form_->length;
    double turn = 0, turn_rate = 0;
    Bounded deflection, stretch;  // stretch: √∫v′²
    double slope = 0, slope_rate = 0, curvature = 0, hub_second = 0;
    double inertia = 0, inertia_rate = 0;  // √|qᵀBq| and what q̇ᵀBq is below it times
    double speeds[kMaxModes];
    for (std::size_t i = 0; i < n_; ++i) {
        const double w = form_->oscillators[i].omega;
        const double force = kBetweenNodes * largest(f[i]), amplitude = largest_amplitude(i, force);
        const double speed = largest_rate(i, amplitude, force);
        const double acceleration = w * w * amplitude + force + 2 * form_->oscillators[i].gamma * speed;
        b.deflection_speed += shape * speed;
        b.deflection_acceleration += shape * acceleration;
        b.slope_speed += shape * form_->beta[i] * speed;
        turn += std::fabs(form_->h[i]) * amplitude;
        turn_rate += std::fabs(form_->h[i]) * speed;
        const Bounded mode{amplitude, speed, acceleration};
        deflection.add(form_->shape[i], mode);
        speeds[i] = form_->shape[i] * speed;
        if (form_->shortening) stretch.add(form_->slope_norm[i], mode);
        const double steep = form_->shape[i] * form_->beta[i];
        slope += steep * amplitude;
        slope_rate += steep * speed;
        curvature += steep * form_->beta[i] * amplitude;
        hub_second += std::fabs(form_->h[i]) * acceleration;
        inertia += form_->inertia_root[i] * amplitude;
        inertia_rate += form_->inertia_root[i] * speed;
    }
    double low = spin[0], high = spin[0];
    for (int k = 1; k < kNodes; ++k) {
        low = std::min(low, spin[k]);
        high = std::max(high, spin[k]);
    }
    const double spread = kMargin * (high - low) + 1e-6 * std::max(std::fabs(low), std::fabs(high));
    low -= spread;
    high += spread;
    b.ripple = turn;
    b.ripple_rate = turn_rate;
    b.spin = std::max(std::fabs(low), std::fabs(high));
    // Θ̈ = [ṗ − 2Θ̇qᵀBq̇]/(J + qᵀBq); no bound where bending may take the inertia away.
    const auto hub_acceleration = [&] {
        const double least = form_->J - inertia * inertia;
        if (!(least > 0)) return std::numeric_limits<double>::infinity();
        return (kBetweenNodes * largest(push) + 2 * b.spin * inertia * inertia_rate) / least;
    };
    b.spin_acceleration =
        form_->prescribed ? 4 * (high - low) / h : std::max(2 * largest(push) / form_->J, hub_acceleration());
    // The beam shortens, u = −½∫v′² − ½aα², and its points are up to √(reach² + v²) away from the hinge.
    const double a = form_->shortening ? std::fabs(form_->radius) : 0;
    const double beyond = 0.5 * deflection.value * deflection.value / (std::fabs(form_->radius) + form_->length);
    const double axial = stretch.value * stretch.rate + a * turn * turn_rate;
    const double axial_acceleration =
        stretch.rate * stretch.rate + stretch.value * stretch.second + a * (turn_rate * turn_rate + turn * hub_second);
    const double whole = b.spin * (std::fabs(form_->radius) + form_->length) + deflection.rate;
    double faster = 0;
    for (std::size_t i = n_; i-- > 0 && b.fastest == 0;)
        if ((faster += speeds[i]) > kRounding * whole) b.fastest = form_->oscillators[i].omega;
    b.slope = slope;
    b.curvature = curvature * (1 + slope);
    b.deflection_speed = std::max(b.deflection_speed, deflection.rate + axial + b.spin * beyond);
    b.deflection_acceleration =
        std::max(b.deflection_acceleration,
                 deflection.second + axial_acceleration + (b.spin_acceleration + b.spin * b.spin) * beyond);
    b.slope_speed = std::max(b.slope_speed, slope_rate * (1 + slope));
    b.rate_low = low - turn_rate;
    b.rate_high = high + turn_rate;
    const double first = form_->prescribed ? drive_.motion(t0).angle : theta0;
    b.angle_low = first + std::min(0.0, low) * h - turn;
    b.angle_high = first + std::max(0.0, high) * h + turn;
    return &bounds_;
}

// What the nodes miss of a forcing is of the size of its last Legendre coefficient and changes its sign at every node:
// so long it does work.
double ExponentialSegment::balance_error() const {
    const Lanes& last = Collocation::get().legendre[kNodes - 1];
    double power = largest(spin) * std::fabs(sum(last * push));
    for (std::size_t i = 0; i < n_; ++i)
        power += form_->mass * std::max(std::fabs(v0[i]), largest(v[i])) * std::fabs(sum(last * f[i]));
    return power * h / (kNodes + 1);
}

// The oscillation about f/ω² is driven by −(f″ + 2γf′)/ω² and so changes its amplitude between two nodes by at most
// (|f″| + 2γ|f′|)/ω³ times half their distance; f is bounded by the derivatives of its Legendre polynomials.   (S59)
ModalBounds::Mode ExponentialSegment::mode_bounds(std::size_t i) const {
    const Collocation& gauss = Collocation::get();
    const Oscillator& o = form_->oscillators[i];
    const double force = kBetweenNodes * largest(f[i]), square = o.omega * o.omega;
    double force_range = 0, force_rate = 0, force_second = 0;  // the first: about the mean
    for (int j = 1; j < kNodes; ++j) {
        const double c = std::fabs(sum(gauss.legendre[static_cast<std::size_t>(j)] * f[i]));
        force_range += c;
        force_rate += c * j * (j + 1) / h;
        force_second += c * ((j - 1) * j * (j + 1) * (j + 2)) / (2 * h * h);
    }
    ModalBounds::Mode mode;
    mode.amplitude = largest_amplitude(i, force);
    mode.rate = largest_rate(i, mode.amplitude, force);
    mode.acceleration = square * mode.amplitude + force + 2 * o.gamma * mode.rate;
    mode.low = -mode.amplitude;
    mode.high = mode.amplitude;
    if (o.omega > 0 && !decays(o)) {
        Lanes slope{};
        for (int l = 0; l < kNodes; ++l) slope += f[i][l] * gauss.slope[static_cast<std::size_t>(l)];
        const Lanes free = q[i] - (1 / square) * f[i], free_rate = (1 / o.omega) * (v[i] - (1 / (h * square)) * slope);
        const double decay = o.gamma > 0 ? std::exp(o.gamma * kToNode * h) : 1;
        const double driven = kToNode * h * (force_second + 2 * o.gamma * force_rate) / (square * o.omega);
        const double swing = std::sqrt(largest(free * free + free_rate * free_rate)) * decay + driven;
        // q̇ = ḟ/ω² + ẋ and q̈ + 2γq̇ = −ω²x of the oscillation x about f/ω².
        const double mean = sum(gauss.legendre[0] * f[i]) / square, range = force_range / square + swing;
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
    ModalBounds& b = modal_bounds_;
    b.modes.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) b.modes[i] = mode_bounds(i);
    b.h = h;
    b.power_cam = ledger_changes ? kBetweenNodes * largest(rate[kWorkCam]) : 0;
    b.power_drive = ledger_changes ? kBetweenNodes * largest(rate[kWorkDrive]) : 0;
    return &b;
}

bool ExponentialSegment::resolved(std::size_t i) const {
    const Oscillator& o = form_->oscillators[i];
    return (decays(o) ? decays_of(o).fast : o.omega) * h < kResolved;
}

Lanes ExponentialSegment::resolved_rate(std::size_t i) const {
    if (resolved(i)) return v[i];
    if (!decays(form_->oscillators[i])) return Lanes{};
    const Decays d = decays_of(form_->oscillators[i]);
    return d.slow * h < kResolved ? (-d.slow / d.apart()) * (v[i] + d.fast * q[i]) : Lanes{};
}

// ∫₀ g q̇ up to s for a polynomial g(z), z = 2s − 1, of what of q̇ the nodes do not resolve.
double ExponentialSegment::work_on(std::size_t i, const double* g, double s, const double* y) const {
    if (!decays(form_->oscillators[i])) return work_on_vibration(i, g, s, y);
    const double fast = work_on_decay(i, true, g, s, y);
    const bool slow_resolved = decays_of(form_->oscillators[i]).slow * h < kResolved;
    return slow_resolved ? fast : fast + work_on_decay(i, false, g, s, y);
}

// The part −r x of q̇: ẋ = −rx + cf has a polynomial solution, and what decays is integrated by parts.        (S52a)
double ExponentialSegment::work_on_decay(std::size_t i, bool fast, const double* g, double s, const double* y) const {
    const Decays d = decays_of(form_->oscillators[i]);
    const double r = fast ? d.fast : d.slow, other = fast ? d.slow : d.fast, c = (fast ? -1 : 1) / d.apart();
    double particular[kNodes] = {}, derived[kNodes];
    for (std::size_t j = 0; j < kNodes; ++j) derived[j] = sum(Collocation::get().monomial[j] * f[i]);
    const auto derive = [&](double* polynomial) {
        for (int j = 0; j + 1 < kNodes; ++j) polynomial[j] = (j + 1) * polynomial[j + 1] * (2 / h);
        polynomial[kNodes - 1] = 0;
    };
    double factor = c / r;
    for (int k = 0; k < kNodes; ++k) {
        for (int j = 0; j < kNodes; ++j) particular[j] += factor * derived[j];
        derive(derived);
        factor /= -r;
    }
    const auto integral = [&](double z, double x) {
        double power[2 * kNodes];
        power[0] = 1;
        for (int j = 1; j < 2 * kNodes; ++j) power[j] = power[j - 1] * z;
        double total = 0;
        for (int a = 0; a < kNodes; ++a) {
            x -= particular[a] * power[a];
            for (int b = 0; b < kNodes; ++b) total += g[a] * particular[b] * power[a + b + 1] / (a + b + 1);
        }
        total *= 0.5 * h;
        double poly[kNodes];
        std::copy_n(g, kNodes, poly);
        for (int k = 0; k < kNodes; ++k) {
            double value = 0;
            for (int j = 0; j < kNodes; ++j) value += poly[j] * power[j];
            x /= r;
            total -= value * x;
            derive(poly);
        }
        return total;
    };
    const double x0 = c * (v0[i] + other * q0[i]), x1 = c * (y[2 + n_ + i] + other * y[1 + i]);
    return -r * (integral(2 * s - 1, x1) - integral(-1, x0));
}

// Where all of q̇ vibrates: the particular solution is a polynomial too, and the free oscillation v_h is integrated by
// parts against g.                                                                                              (S54)
double ExponentialSegment::work_on_vibration(std::size_t i, const double* g, double s, const double* y) const {
    const Oscillator& o = form_->oscillators[i];
    const double w2 = o.omega * o.omega, x1 = y[1 + i], dx1 = y[2 + n_ + i];
    double particular[kNodes] = {}, speed[kNodes] = {}, derived[kNodes];
    for (std::size_t j = 0; j < kNodes; ++j) derived[j] = sum(Collocation::get().monomial[j] * f[i]);
    double c = 1 / w2, before = 0;
    for (int k = 0; k < kNodes; ++k) {
        for (int j = 0; j < kNodes; ++j) particular[j] += c * derived[j];
        for (int j = 0; j + 1 < kNodes; ++j) derived[j] = (j + 1) * derived[j + 1] * (2 / h);
        derived[kNodes - 1] = 0;
        for (int j = 0; j < kNodes; ++j) speed[j] += c * derived[j];
        const double next = -(2 * o.gamma * c + before) / w2;
        before = c;
        c = next;
    }
    const auto integral = [&](double z, double x, double dx) {
        double power[2 * kNodes];
        power[0] = 1;
        for (int j = 1; j < 2 * kNodes; ++j) power[j] = power[j - 1] * z;
        double total = 0, qp = 0, vp = 0;
        for (int a = 0; a < kNodes; ++a) {
            qp += particular[a] * power[a];
            vp += speed[a] * power[a];
            for (int b = 0; b < kNodes; ++b) total += g[a] * speed[b] * power[a + b + 1] / (a + b + 1);
        }
        total *= 0.5 * h;
        double poly[kNodes];
        std::copy_n(g, kNodes, poly);
        double low = dx - vp, high = x - qp, sign = 1;  // V₀ = v_h, V₁ = q_h, V_{k+1} = −(V_{k−1} + 2γV_k)/ω²
        for (int k = 0; k < kNodes; ++k) {
            double value = 0;
            for (int j = 0; j < kNodes; ++j) value += poly[j] * power[j];
            total += sign * value * high;
            sign = -sign;
            for (int j = 0; j + 1 < kNodes; ++j) poly[j] = (j + 1) * poly[j + 1] * (2 / h);
            poly[kNodes - 1] = 0;
            const double next = -(low + 2 * o.gamma * high) / w2;
            low = high;
            high = next;
        }
        return total;
    };
    return integral(2 * s - 1, x1, dx1) - integral(-1, q0[i], v0[i]);
}

// Loss of one mode up to s: what its energy lost and the forcing put in, ∫2γmv² = m{E(0) − E(t) + ∫f v},
// E = ½(v² + ω²q²).                                                                                       (S54)
double ExponentialSegment::structural_loss(std::size_t i, double s, const double* y) const {
    const Oscillator& o = form_->oscillators[i];
    const double w2 = o.omega * o.omega, x1 = y[1 + i], dx1 = y[2 + n_ + i];
    const double fell = 0.5 * (v0[i] * v0[i] - dx1 * dx1 + w2 * (q0[i] * q0[i] - x1 * x1));
    if (resolved(i)) return form_->mass * fell;
    double force[kNodes];
    for (std::size_t j = 0; j < kNodes; ++j) force[j] = sum(Collocation::get().monomial[j] * f[i]);
    return form_->mass * (fell + work_on(i, force, s, y));
}

// Work of the torque on the vibration α̇ that the nodes do not resolve.
double ExponentialSegment::torque_on_vibration(double s, const double* y) const {
    const Collocation& gauss = Collocation::get();
    Lanes torque;
    for (int k = 0; k < kNodes; ++k) torque[k] = drive_.torque(t0 + h * gauss.c[k]);
    double polynomial[kNodes], work = 0;
    for (std::size_t j = 0; j < kNodes; ++j) polynomial[j] = sum(gauss.monomial[j] * torque);
    for (std::size_t i = 0; i < n_; ++i)
        if (!resolved(i)) work += form_->h[i] * work_on(i, polynomial, s, y);
    return work;
}

double ExponentialSegment::drive_boundary(double t, const double* y) const {
    if (!form_->prescribed) return 0;
    const HubMotion hub = drive_.motion(t);
    double momentum = form_->J * hub.rate, follow = 0;
    for (std::size_t i = 0; i < n_; ++i) {
        double row = 0;
        for (std::size_t j = 0; j < n_; ++j) row += form_->inertia[i * n_ + j] * y[1 + j];
        momentum += row * y[1 + i] * hub.rate + form_->U[i] * y[2 + n_ + i];
        follow += form_->U[i] * y[1 + i];
    }
    return hub.rate * momentum - hub.acceleration * follow;
}

void ExponentialSegment::ledger_at(double t, double s, const Lanes& weights, double* y) const {
    double* ledger = y + controlled_;
    for (int k = 0; k < kLedgerSize; ++k) ledger[k] = ledger0[k] + h * sum(weights * rate[k]);
    if (form_->damped)
        for (std::size_t i = 0; i < n_; ++i) ledger[kLossStructural] += structural_loss(i, s, y);
    if (drive_.has_torque()) ledger[kWorkDrive] += torque_on_vibration(s, y);
    if (form_->prescribed) ledger[kWorkDrive] += drive_boundary(t, y) - boundary0;
}

}  // namespace beamcam::sim
