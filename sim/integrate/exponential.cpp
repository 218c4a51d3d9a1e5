#include "sim/integrate/exponential.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/integrate/contact_lanes.hpp"
#include "sim/integrate/event_search.hpp"
#include "sim/integrate/exponential_segment.hpp"
#include "sim/integrate/lane_kernels.hpp"

namespace beamcam::sim {
namespace {

// Step lengths come from the ladder 2^(k/2) s, so that few tables serve a run.
constexpr int kLowest = -80, kHighest = -4;
constexpr int kFirstFlight = -18;  // 2 ms
constexpr int kFirstTouch = -24;   // 0.24 ms
constexpr int kMostSweeps = 12, kMostNewton = 25;
constexpr double kCarried = 1e-5;  // of a step, by which its end may be moved without solving again
constexpr int kMostCuts = 8;       // of a step, to end it at a release
// Steps in contact are kept to a share of the tolerance: impacts multiply errors, and at order sixteen it costs little.
constexpr double kContactShare = 64;

constexpr double kShareOfIteration = 0.02;  // of the tolerance, for what the sweeps leave

double rung(int k) { return std::ldexp(k & 1 ? 1.4142135623730951 : 1.0, (k - (k & 1)) / 2); }

// How the Legendre coefficients of nodal values end: the size of the last two, and by how much they fell from the two
// before (at most 1).
struct Ending {
    double last, ratio;
};
Ending ending(const Lanes& nodal) {
    const auto& legendre = Collocation::get().legendre;
    const auto size = [&](std::size_t j) { return std::fabs(sum(legendre[j] * nodal)); };
    const double last = std::max(size(6), size(7)), before = std::max(size(4), size(5));
    return {last, last == 0 ? 0 : std::min(1.0, last / before)};
}

// Interpolation error of a forcing with these nodal values, times the step. Coefficients that fall show a
// resolved forcing, whose error the integration smooths as well; coefficients that do not are vibration sampled too
// seldom, and count in full.
double tail(const Lanes& nodal) {
    const auto [last, ratio] = ending(nodal);
    return last * ratio * std::max(ratio, 1.0 / 30);
}

// Error of what a step leaves of a nodal force: coefficients that fall by r from pair to pair make the quadrature of
// order sixteen err by the last times r⁴; where the force starts like a power of time it is that power which falls.
double quadrature_tail(const Lanes& nodal) {
    const auto [last, ratio] = ending(nodal);
    const double r2 = ratio * ratio;
    return last * std::max(r2 * r2, 1e-5);
}

// Solves the dense system a x = b of a step (columns of a in lanes over rows), b ← x; partial pivoting.
bool solve(std::array<Lanes, kNodes>& a, Lanes& b) {
    int order[kNodes];
    for (int k = 0; k < kNodes; ++k) order[k] = k;
    for (int c = 0; c < kNodes; ++c) {
        Lanes& column = a[static_cast<std::size_t>(c)];
        int best = c;
        for (int r = c + 1; r < kNodes; ++r)
            if (std::fabs(column[order[r]]) > std::fabs(column[order[best]])) best = r;
        std::swap(order[c], order[best]);
        const int pivot = order[c];
        if (!(std::fabs(column[pivot]) > 0)) return false;
        Lanes factor = column / column[pivot];
        for (int r = 0; r <= c; ++r) factor[order[r]] = 0;
        for (int j = c + 1; j < kNodes; ++j) {
            Lanes& other = a[static_cast<std::size_t>(j)];
            other -= factor * other[pivot];
        }
        b -= factor * b[pivot];
    }
    Lanes x{};
    for (int c = kNodes - 1; c >= 0; --c) {
        const Lanes& column = a[static_cast<std::size_t>(c)];
        x[c] = b[order[c]] / column[order[c]];
        b -= x[c] * column;
    }
    b = x;
    return true;
}

// Beyond so many times the critical damping explicit steps are kept short by the decay alone, which BDF steps over. Its
// errors add up: it is given a share of the tolerance.
constexpr double kStiffDamping = 20, kShareOfBdf = 0.03;
// [m/s] Friction that turns over within less is as stiff once it nearly sticks. A touch that has taken so many steps,
// shorter than this share of the way to its deepest point, is handed over.
constexpr double kSharpSlip = 1e-4;
constexpr long kMostCrawls = 2000;
constexpr double kCrawl = 1e-3;

bool sharp_friction(System& system) {
    const Problem& p = system.problem();
    const auto* friction = std::get_if<CoulombFriction>(&p.contact.friction);
    return system.has_cam() && friction && friction->coefficient > 0 && friction->slip_speed < kSharpSlip &&
           p.contact.model == ContactModel::compliant && exponential_applies(system);
}

Method fallback_method(System& system) {
    const Beam& beam = system.problem().beam;
    double ratio = 0.5 * beam.kelvin_voigt.value_or(0) * system.highest_frequency();
    for (const double z : beam.damping_ratio) ratio = std::max(ratio, z);
    const bool stiff = (beam.model != ModelKind::rigid && ratio > kStiffDamping) || sharp_friction(system);
    return stiff ? Method::cvode_bdf : Method::rk8;
}

std::unique_ptr<Integrator> make_fallback(Method method, System& system, double rtol, double atol) {
    return method == Method::rk8 ? make_rk8(system, rtol, atol)
                                 : make_sundials(method, system, kShareOfBdf * rtol, kShareOfBdf * atol);
}

class Exponential final : public Integrator {
  public:
    Exponential(System& system, double rtol, double atol)
        : system_(system),
          form_(ModalForm::of(system)),
          rtol_(rtol),
          atol_(atol),
          n_(form_ ? static_cast<std::size_t>(form_->n) : 0),
          fallback_(make_fallback(fallback_method(system), system, rtol, atol)) {
        counters.fallback = fallback_method(system);
        if (!form_) return;
        segment_ = std::make_unique<ExponentialSegment>(form_, system.drive(), system.size);
        base_q_.resize(n_);
        base_v_.resize(n_);
        bq_.resize(n_);
        gq_.resize(n_);
        ladder_.resize(kHighest - kLowest + 1);
        if (system.has_cam()) contact_ = std::make_unique<ContactExpansion>(form_, system);
        if (const auto* friction = std::get_if<CoulombFriction>(&system.problem().contact.friction)) {
            mu_ = friction->coefficient;
            slip_speed_ = friction->slip_speed;
            sharp_ = sharp_friction(system);
        }
        hq_.resize(n_);
        jn_.resize(n_);
        jt_.resize(n_);
        hq_end_.resize(n_);
        row_.resize(n_);
        ripples_.resize(n_);
    }

    void start(double t, const double* y) override {
        const Phase& phase = system_.phase();
        if (!(touching_ && t == t_)) side_ = 1;
        touching_ = phase.touching;
        falling_back_ = !form_ || phase.held || (touching_ && system_.has_bristle());
        if (!falling_back_ && touching_ && !begin_touch(t, y)) {
            falling_back_ = true;
            ++counters.handed_over;
        }
        first_step_ = limited(std::numeric_limits<double>::infinity());
        if (falling_back_) return hand_over(t, y, first_step_);
        t_ = t;
        std::copy_n(y, segment_->end.size(), segment_->end.begin());
    }

    const Segment& step() override {
        if (falling_back_) {
            fallback_->stop_at(stop_);
            const Segment& segment = fallback_->step();
            count();
            return segment;
        }
        if (!touching_) {
            flight();
        } else if (!touch_step()) {
            // The contact has left what this method covers: the rest of the phase goes to the other.
            ++counters.handed_over;
            hand_over(t_, segment_->end.data(), first_step_);
            const Segment& segment = fallback_->step();
            count();
            return segment;
        }
        return *segment_;
    }

    const Segment& shorten(double at) override {
        if (falling_back_) {
            const Segment& segment = fallback_->shorten(at);
            count();
            return segment;
        }
        if (at == segment_->t1) return *segment_;
        // The dense output is as accurate as the step, but where a force of contact is cut short: its step is solved
        // anew unless the difference is rounding.
        if (touching_ && std::fabs(at - segment_->t1) > 2 * kCarried * segment_->h) {
            if (!touch_cut(at)) throw StepFailure("the contact force could not be solved for");
            return *segment_;
        }
        std::vector<double>& y = scratch_;
        y.resize(segment_->end.size());
        segment_->t1 = std::numeric_limits<double>::infinity();  // evaluated, not copied
        segment_->value(at, y.data());
        segment_->end = y;
        segment_->t1 = t_ = at;
        return *segment_;
    }

    const double* state() const override { return falling_back_ ? fallback_->state() : segment_->end.data(); }

  private:
    // The other method goes on from (t, y), by a step of at most `first` to begin with.
    void hand_over(double t, const double* y, double first) {
        falling_back_ = true;
        fallback_->limit_first_step(first);
        fallback_->stop_at(stop_);
        fallback_->start(t, y);
        count();
    }

    void count() {
        const IntegratorCounters& now = fallback_->counters;
        counters.steps += now.steps - seen_.steps;
        counters.fallback_steps += now.steps - seen_.steps;
        counters.rejected += now.rejected - seen_.rejected;
        counters.rhs += now.rhs - seen_.rhs;
        seen_ = now;
    }

    const StepTable& table(int k) {
        StepTable& entry = ladder_[static_cast<std::size_t>(k - kLowest)];
        if (entry.h == 0) entry.build(form_->oscillators, form_->groups, rung(k));
        return entry;
    }

    // ---- a step of flight ----

    // The start of a step, from the end of the last.
    void begin() {
        ExponentialSegment& s = *segment_;
        s.t0 = t_;
        const double* y = s.end.data();
        std::copy_n(y + 1, n_, s.q0.begin());
        std::copy_n(y + 2 + n_, n_, s.v0.begin());
        std::copy_n(y + system_.controlled, kLedgerSize, s.ledger0);
        s.theta0 = y[0];
        spin0_ = y[1 + n_];
        // Θ̇ = p/(J + qᵀBq) inverted.
        s.p0 = form_->prescribed ? 0 : spin0_ / s.spin_at(1, y + 1);
        set_scales(y, y);
    }

    void flight() {
        ExponentialSegment& s = *segment_;
        s.touching = false;
        begin();
        bool rejected = false;
        for (;;) {
            const int k = flight_rung_;
            const double h = std::min(rung(k), std::max(first_step_, 1e-14 * std::fabs(t_)));
            const bool last = t_ + 1.01 * h >= stop_;
            const StepTable* now = &odd_;
            if (last)
                odd_.build(form_->oscillators, form_->groups, stop_ - t_);
            else if (h < rung(k))
                odd_.build(form_->oscillators, form_->groups, h);
            else
                now = &table(k);
            const double error = advance(*now);
            if (error <= 1) {
                // Order eight: a rung is a factor of 16 in the error.
                if (now != &odd_ && !rejected && error < 0.5 / 16)
                    flight_rung_ = std::min(k + (error < 1e-5 ? 2 : 1), kHighest);
                s.t1 = last ? stop_ : t_ + now->h;
                first_step_ = std::numeric_limits<double>::infinity();
                break;
            }
            rejected = true;
            ++counters.rejected;
            const int down =
                std::isfinite(error) ? std::clamp(static_cast<int>(std::ceil(std::log2(error) / 4)), 1, 4) : 4;
            while (flight_rung_ > kLowest && rung(flight_rung_) > now->h) --flight_rung_;
            flight_rung_ -= down;
            if (flight_rung_ < kLowest || rung(flight_rung_) < 4e-16 * std::fabs(t_))
                throw StepFailure(vanished(std::isfinite(error)));
        }
        ++counters.steps;
        finish();
        t_ = s.t1;
    }

    // Solves for the nodal forcing; returns the error in units of the tolerance, infinite if sweeps do not settle.
    double advance(const StepTable& table) {
        ExponentialSegment& s = *segment_;
        const double h = s.h = table.h;
        s.changed();
        place_hub(h);
        swing_freely(table);
        double before = 0;
        bool settled = false;
        for (int sweep = 0; sweep < kMostSweeps && !settled; ++sweep) {
            propagate(table);
            counters.rhs += kNodes;
            const double change = forces(table);
            if (!std::isfinite(change)) return std::numeric_limits<double>::infinity();
            if (sweep > 0) {
                const double ratio = change / before;
                if (change == 0 || (ratio < 0.5 && change * ratio / (1 - ratio) < kShareOfIteration)) settled = true;
                if (ratio > 0.9 && change > 1e-12 * largest_change_) break;
                if (ratio > 0.9) settled = true;  // rounding
            } else {
                largest_change_ = change;
            }
            before = change;
        }
        if (!settled) return std::numeric_limits<double>::infinity();
        propagate(table);
        propagate_rates(table);
        arrive(table);
        return error(h);
    }

    // What the step does to q and q̇ without forcing, and the forcing that does not depend on them.
    void swing_freely(const StepTable& table) {
        ExponentialSegment& s = *segment_;
        for (std::size_t i = 0; i < n_; ++i) {
            const StepTable::Row& row = table.rows[i];
            base_q_[i] = row.qq * s.q0[i] + row.qv * s.v0[i];
            base_v_[i] = row.vq * s.q0[i] + row.vv * s.v0[i];
            smooth_force(i, s.f[i]);
        }
    }

    void propagate_rates(const StepTable& table) {
        kernels_.propagate_rates(n_, table.rows.data(), segment_->f.data(), base_v_.data(), segment_->v.data());
    }

    // next_ ← the state at the end.
    void arrive(const StepTable& table) {
        const ExponentialSegment& s = *segment_;
        const Collocation& gauss = Collocation::get();
        const double h = table.h;
        next_.resize(s.end.size());
        for (std::size_t i = 0; i < n_; ++i) {
            const StepTable::Row& row = table.rows[i];
            next_[1 + i] = row.end_qq * s.q0[i] + row.end_qv * s.v0[i] + sum(row.end_q * s.f[i]);
            next_[2 + n_ + i] = row.end_vq * s.q0[i] + row.end_vv * s.v0[i] + sum(row.end_v * s.f[i]);
        }
        if (form_->prescribed) {
            const HubMotion hub = system_.drive().motion(s.t0 + h);
            next_[0] = hub.angle;
            next_[1 + n_] = hub.rate;
        } else {
            next_[0] = s.theta0 + h * sum(gauss.b * s.spin);
            next_[1 + n_] = s.spin_at(s.p0 + h * sum(gauss.b * s.push), next_.data() + 1);
        }
    }

    // Hub at the nodes: as prescribed, or guessed as a rigid pendulum.
    void place_hub(double h) {
        const Collocation& gauss = Collocation::get();
        ExponentialSegment& s = *segment_;
        time_ = s.t0 + h * gauss.c;
        if (form_->prescribed) {
            for (int k = 0; k < kNodes; ++k) {
                const HubMotion hub = system_.drive().motion(time_[k]);
                theta_[k] = hub.angle;
                s.spin[k] = hub.rate;
                acceleration_[k] = hub.acceleration;
            }
        } else {
            const double acceleration = -form_->gravity * form_->S * std::cos(s.theta0) / form_->J;
            const Lanes tau = h * gauss.c;
            theta_ = s.theta0 + tau * (spin0_ + 0.5 * acceleration * tau);
            s.spin = spin0_ + acceleration * tau;
            acceleration_ = Lanes{};
        }
        torque_ = Lanes{};
        if (system_.drive().has_torque())
            for (int k = 0; k < kNodes; ++k) torque_[k] = system_.drive().torque(time_[k]);
        turn();
    }
    void turn() {
        for (int k = 0; k < kNodes; ++k) {
            sin_[k] = std::sin(theta_[k]);
            cos_[k] = std::cos(theta_[k]);
        }
    }
    // The same for an angle that has changed by a little: a rotation, to rounding up to 0.01 rad.
    void turn_on(const Lanes& by) {
        if (!(largest(by) < 0.01)) return turn();
        const Lanes b2 = by * by;
        const Lanes c = 1 - b2 * (0.5 - b2 * (1.0 / 24)), s = by * (1 - b2 * (1.0 / 6 - b2 * (1.0 / 120)));
        const Lanes turned = sin_ * c + cos_ * s;
        cos_ = cos_ * c - sin_ * s;
        sin_ = turned;
    }
    // What of the forcing does not depend on q, per mass.
    void smooth_force(std::size_t i, Lanes& f) const {
        f = (-form_->gravity * form_->weight[i]) * cos_ + (form_->h[i] / form_->mass) * torque_;
        if (form_->prescribed) f -= (form_->U[i] / form_->mass) * acceleration_;
    }

    void propagate(const StepTable& table) {
        kernels_.propagate(n_, table.rows.data(), segment_->f.data(), base_q_.data(), segment_->q.data());
    }

    // Forcing and hub from the nodal q; returns how much changed, in units of the tolerance.
    double forces(const StepTable& table) {
        ExponentialSegment& s = *segment_;
        const Collocation& gauss = Collocation::get();
        const ModalForm& form = *form_;
        const double h = table.h;
        Lanes x = s.spin * s.spin, second = form.gravity * sin_;
        if (form.paper) {
            const Lanes l = form.length * cos_;
            second = -x * (form.radius * l + 0.5 * l * l);
        }
        kernels_.multiply(n_, n_, form.spinning.data(), s.q.data(), bq_.data());
        if (!form.second.empty()) kernels_.multiply(n_, n_, form.second.data(), s.q.data(), gq_.data());
        Lanes quadratic{}, fall{}, weighted{};
        double change2 = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            const Lanes &a = bq_[i], &b = gq_[i];
            quadratic += a * s.q[i];
            fall += b * s.q[i];
            weighted += form.weight[i] * s.q[i];
            Lanes f;
            smooth_force(i, f);
            f += x * a + second * b;
            if (touching_) f += (mu_ > 0 ? force_ * jn_[i] + friction_ * jt_[i] : force_ * jn_[i]) * (1 / form.mass);
            const double d = largest(f - s.f[i]) * std::min(h, 1 / form.oscillators[i].omega);
            change2 += d * d;
            s.f[i] = f;
        }
        const double modal = std::sqrt(change2) / scale_modes_;
        if (form.prescribed) return modal;
        quadratic *= form.mass;
        inertia_ = form.J + quadratic;
        s.push = -form.gravity * (form.S * cos_ - form.mass * (weighted * sin_ + 0.5 * cos_ * fall)) + torque_;
        if (touching_) s.push += force_ * touch_.hub + friction_ * touch_.hub_t;
        Lanes p = Lanes{} + s.p0, theta = Lanes{} + s.theta0;
        for (int l = 0; l < kNodes; ++l) p += (h * s.push[l]) * gauss.integrate[static_cast<std::size_t>(l)];
        const Lanes spin = p / inertia_;
        for (int l = 0; l < kNodes; ++l) theta += (h * spin[l]) * gauss.integrate[static_cast<std::size_t>(l)];
        const double hub = std::max(largest(spin - s.spin) / scale_spin_, largest(theta - theta_) / scale_theta_);
        s.spin = spin;
        const Lanes by = theta - theta_;
        theta_ = theta;
        turn_on(by);
        return std::max(modal, hub);
    }

    // What errors are measured by: modes by their vibration as a whole, (q̇, ωq); the hub by itself.
    void set_scales(const double* a, const double* b) {
        double before = 0, after = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            const double w = form_->oscillators[i].omega;
            before += a[2 + n_ + i] * a[2 + n_ + i] + w * w * a[1 + i] * a[1 + i];
            after += b[2 + n_ + i] * b[2 + n_ + i] + w * w * b[1 + i] * b[1 + i];
        }
        scale_modes_ = rtol_ * std::sqrt(std::max(before, after)) + atol_;
        scale_spin_ = rtol_ * std::max(std::fabs(a[1 + n_]), std::fabs(b[1 + n_])) + atol_;
        scale_theta_ = rtol_ * std::max(std::fabs(a[0]), std::fabs(b[0])) + atol_;
    }

    double error(double h) {
        const ExponentialSegment& s = *segment_;
        const ModalForm& form = *form_;
        double errors = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            const double e = tail(s.f[i]) * std::min(h, 1 / form.oscillators[i].omega);
            errors += e * e;
        }
        set_scales(s.end.data(), next_.data());
        double worst = std::sqrt(errors) / scale_modes_;
        if (form.prescribed) return worst;
        worst = std::max(worst, tail(s.push) * h / form.J / scale_spin_);
        return std::max(worst, tail(s.spin) * h / scale_theta_);
    }

    // Ledger and end state of the accepted step.
    void finish() {
        ExponentialSegment& s = *segment_;
        const ModalForm& form = *form_;
        std::copy_n(next_.begin(), system_.controlled, s.end.begin());
        s.books = touching_ || form.damped || form.prescribed || system_.drive().has_torque();
        if (!s.books) {
            std::copy_n(s.ledger0, kLedgerSize, s.end.begin() + system_.controlled);
            return;
        }
        for (Lanes& rate : s.rate) rate = Lanes{};
        if (form.damped)
            for (std::size_t i = 0; i < n_; ++i) s.rate[kLossStructural] += form.mass * s.f[i] * s.resolved_rate(i);
        start_.resize(s.end.size());
        start_[0] = s.theta0;
        start_[1 + n_] = spin0_;
        std::copy(s.q0.begin(), s.q0.end(), start_.begin() + 1);
        std::copy(s.v0.begin(), s.v0.end(), start_.begin() + 2 + static_cast<std::ptrdiff_t>(n_));
        s.boundary0 = s.drive_boundary(s.t0, start_.data());
        drive_power();
        if (touching_) {
            s.rate[kNormalWork] = -force_ * touch_.gap_rate;
            s.rate[kFrictionWork] = -friction_ * touch_.slip;
            s.rate[kWorkCam] = force_ * touch_.cam_n + friction_ * touch_.cam_t;
            s.rate[kImpulseN] = force_;
            s.rate[kImpulseT] = friction_;
        }
        Lanes weights;
        Collocation::get().weights_to((s.t1 - s.t0) / s.h, weights);
        s.ledger_at(s.t1, (s.t1 - s.t0) / s.h, weights, s.end.data());
    }

    // Power of the drive at the nodes, but for what `drive_boundary` integrates in closed form        (S55)
    void drive_power() {
        ExponentialSegment& s = *segment_;
        const ModalForm& form = *form_;
        const Collocation& gauss = Collocation::get();
        const auto slope = [&](const Lanes& nodal, Lanes& out) {
            out = Lanes{};
            for (int l = 0; l < kNodes; ++l) out += (nodal[l] / s.h) * gauss.slope[static_cast<std::size_t>(l)];
        };
        Lanes growth;
        if (system_.drive().has_torque()) {
            Lanes turning = s.spin;  // and what of α̇ the nodes resolve
            for (std::size_t i = 0; i < n_; ++i) turning += form.h[i] * s.resolved_rate(i);
            s.rate[kWorkDrive] = torque_ * turning;
        }
        if (!form.prescribed) return;
        Lanes quadratic{}, fall{}, weighted{}, follow{};
        for (std::size_t i = 0; i < n_; ++i) {
            Lanes a{}, b{};
            for (std::size_t j = 0; j < n_; ++j) {
                a += form.inertia[i * n_ + j] * s.q[j];
                if (!form.paper && !form.second.empty()) b += form.second[i * n_ + j] * s.q[j];
            }
            quadratic += a * s.q[i];
            fall += b * s.q[i];
            weighted += form.weight[i] * s.q[i];
            follow += form.U[i] * s.q[i];
        }
        const Lanes gravity = form.gravity * (form.S * cos_ - form.mass * (weighted * sin_ + 0.5 * cos_ * fall));
        slope(acceleration_, growth);
        s.rate[kWorkDrive] = growth * follow - acceleration_ * (form.J + quadratic) * s.spin + s.spin * gravity;
        // What the contact pushes, the drive holds.
        if (touching_) s.rate[kWorkDrive] -= s.spin * (force_ * touch_.hub + friction_ * touch_.hub_t);
    }

    // ---- a step in contact ----

    bool begin_touch(double t, const double* y) {
        const ContactState c = system_.contact(t, y, true);
        if (c.at_end) return false;
        approach_ = system_.phase().approach;
        crawls_ = 0;
        if (sharp_) crawl_ = kCrawl * system_.touch_time(t, y, c, approach_);
        gap_offset_ = system_.phase().gap_offset;
        contact_->centre(c.x);
        start_touch_ = Touch<double>();
        start_touch_.dx = c.x - contact_->at();
        return true;
    }

    // The contact at the state `state`, at one instant.
    void look_at(double t, const double* state, Touch<double>& touch) {
        const CamPose pose = system_.cam(t);
        const Frame<double> frame{std::sin(state[0]), std::cos(state[0]), state[1 + n_],  pose.disc.x,
                                  pose.disc.y,        pose.velocity.x,    pose.velocity.y};
        contact_->look(state + 1, state + 2 + n_, frame, gap_offset_, hq_end_.data(), touch, 3);
    }

    // Force at penetration δ and rate δ̇, and its derivatives; zero where the law would pull.
    void law(double depth, double rate, double& f, double& by_depth, double& by_rate) const {
        const NormalLaw& law = system_.normal_law();
        f = by_depth = by_rate = 0;
        if (!(depth > 0)) return;
        const double factor = law.factor(rate, approach_);
        if (!(factor > 0)) return;
        const double elastic = law.elastic(depth);
        f = elastic * factor;
        by_depth = law.exponent * f / depth;
        by_rate = elastic * law.damping / approach_;
    }

    // One step; false when the contact is not for this method (the state is then that of the start).
    bool touch_step() {
        if (sharp_ && crawls_ > kMostCrawls) return false;
        begin();
        ExponentialSegment& s = *segment_;
        begin_contact();
        bool rejected = false;
        for (;;) {
            const StepTable* now = nullptr;
            if (t_ + 1.01 * rung(touch_rung_) >= stop_) {
                odd_.build(form_->oscillators, form_->groups, stop_ - t_);
                now = &odd_;
            } else {
                now = &table(touch_rung_);
            }
            double error = solve_contact(*now);
            const double h = now->h;
            if (std::isfinite(error) && deep()) return false;
            TouchSamples::Ending ending = TouchSamples::Ending::open;
            if (std::isfinite(error)) {
                const double end = cut(h, ending);
                // A step far beyond the release is of no use but to tell how long the next try is.
                if (ending != TouchSamples::Ending::open) error = solve_to(end, ending);
                const bool whole = ending == TouchSamples::Ending::open;
                if (error <= 1) error = cut_between_nodes(error, ending);
                if (error <= 1) {
                    if (whole && ending == TouchSamples::Ending::open && now != &odd_ && !rejected && error < 0.02)
                        touch_rung_ = std::min(touch_rung_ + (error < 1e-4 ? 2 : 1), kHighest);
                    touch_accept(ending);
                    return true;
                }
            }
            rejected = true;
            ++counters.rejected;
            const double length = std::isfinite(error) ? s.h : h;
            while (touch_rung_ > kLowest && rung(touch_rung_) > length) --touch_rung_;
            touch_rung_ -=
                std::isfinite(error) ? std::clamp(static_cast<int>(std::ceil(std::log2(error) / 6)), 1, 4) : 3;
            if (touch_rung_ < kLowest + 8 || rung(touch_rung_) < 1e-13 * std::fabs(t_) + 1e-12) {
                touch_rung_ = kFirstTouch;
                return false;
            }
        }
    }

    // Geometry and force at the start of the step.
    void begin_contact() {
        look_at(t_, segment_->end.data(), start_touch_);
        contact_->centre(contact_->at() + start_touch_.dx);
        if (contact_->at() != centred_) {
            centred_ = contact_->at();
            start_touch_.dx = 0;
            look_at(t_, segment_->end.data(), start_touch_);
        }
        double by_depth, by_rate;
        law(-start_touch_.gap, -start_touch_.gap_rate, force0_, by_depth, by_rate);
        touch_ = Touch<Lanes>();
        touch_.dx = Lanes{} + start_touch_.dx;
        for (std::size_t i = 0; i < n_; ++i) {
            double jt = 0;
            contact_->rows(start_touch_, hq_end_.data(), i, false, row_[i], jt);
        }
    }

    // Ends the step at `at` instead; for the caller.
    bool touch_cut(double at) {
        ExponentialSegment& s = *segment_;
        odd_.build(form_->oscillators, form_->groups, at - s.t0);
        if (!std::isfinite(solve_contact(odd_))) return false;
        touch_accept(TouchSamples::Ending::open);
        return true;
    }

    // Solves for the nodal forces; the error in units of the tolerance, infinite if Newton's method fails or the
    // contact leaves the range of its expansion.
    double solve_contact(const StepTable& table) {
        constexpr double kFailed = std::numeric_limits<double>::infinity();
        ExponentialSegment& s = *segment_;
        const Collocation& gauss = Collocation::get();
        const double h = s.h = table.h;
        s.changed();
        place_hub(h);
        Frame<Lanes> frame;
        for (int k = 0; k < kNodes; ++k) {
            const CamPose pose = system_.cam(time_[k]);
            frame.disc_x[k] = pose.disc.x;
            frame.disc_y[k] = pose.disc.y;
            frame.disc_vx[k] = pose.velocity.x;
            frame.disc_vy[k] = pose.velocity.y;
        }
        compliance(table);
        // First guess: the force that the start's penetration and rate lead to.
        const Lanes tau = h * gauss.c;
        for (int k = 0; k < kNodes; ++k) {
            double by_depth, by_rate;
            law(-start_touch_.gap - start_touch_.gap_rate * tau[k], -start_touch_.gap_rate, force_[k], by_depth,
                by_rate);
        }
        friction_ = Lanes{};
        swing_freely(table);
        for (std::size_t i = 0; i < n_; ++i) s.f[i] += force_ * (row_[i] / form_->mass);
        s.push = force_ * start_touch_.hub - form_->gravity * form_->S * cos_ + torque_;
        if (!form_->prescribed) hub_from_push(h);
        double before = 0;
        bool settled = false;
        for (int sweep = 0; sweep < kMostNewton && !settled; ++sweep) {
            propagate(table);
            propagate_rates(table);
            frame.sin = sin_;
            frame.cos = cos_;
            frame.spin = s.spin;
            contact_->look(s.q.data(), s.v.data(), frame, gap_offset_, hq_.data(), touch_, sweep == 0 ? 3 : 1);
            contact_->normal_rows(touch_, hq_.data(), jn_.data());
            if (mu_ > 0)
                for (std::size_t i = 0; i < n_; ++i) contact_->rows(touch_, hq_.data(), i, true, jn_[i], jt_[i]);
            counters.rhs += kNodes;
            seen_theta_ = theta_;
            seen_spin_ = s.spin;
            Lanes residual;
            std::array<Lanes, kNodes> matrix;
            Lanes by_depth, by_rate;
            for (int k = 0; k < kNodes; ++k) {
                double f, d, r;
                law(-touch_.gap[k], -touch_.gap_rate[k], f, d, r);
                residual[k] = f - force_[k];
                by_depth[k] = d;
                by_rate[k] = r;
            }
            for (std::size_t l = 0; l < kNodes; ++l) {
                matrix[l] = by_depth * soft_[l] + by_rate * soft_rate_[l];
                matrix[l][static_cast<int>(l)] += 1;
            }
            if (!solve(matrix, residual)) return kFailed;
            force_ += residual;
            if (mu_ > 0)
                for (int k = 0; k < kNodes; ++k)
                    friction_[k] = -mu_ * force_[k] * std::tanh(touch_.slip[k] / slip_speed_);  // (S34)
            const double change = forces(table);
            if (!std::isfinite(change)) return kFailed;
            if (sweep > 0) {
                const double ratio = change / before;
                if (change == 0 || (ratio < 0.5 && change * ratio / (1 - ratio) < kShareOfIteration)) settled = true;
                if (ratio > 0.9 && change < 1e-11 * largest_change_) settled = true;  // rounding
                if (ratio > 2 && sweep > 5) return kFailed;
            }
            largest_change_ = sweep == 0 ? change : std::max(largest_change_, change);
            before = change;
        }
        if (!settled) return kFailed;
        move_touch(-1);
        propagate(table);
        propagate_rates(table);
        move_touch(1);
        arrive(table);
        end_touch_.dx = touch_.dx[kNodes - 1];
        look_at(s.t0 + h, next_.data(), end_touch_);
        const double reach = std::max(largest(touch_.dx), std::fabs(end_touch_.dx));
        const double low = contact_->at() - reach, high = contact_->at() + reach;
        if (reach > contact_->range() || low <= 0 || high >= form_->length) return kFailed;
        return contact_error(h);
    }

    // Takes out of the gap and its rates what the present state contributes, or puts it in: called around the last
    // change of the state, it moves the contact along. The ledger counts the work of the force at these rates.
    void move_touch(double sign) {
        const ExponentialSegment& s = *segment_;
        Lanes gap{}, rate{}, slip{};
        if (sign > 0) {
            const Lanes turned = theta_ - seen_theta_, quicker = s.spin - seen_spin_;
            gap = touch_.hub * turned;
            rate = touch_.hub * quicker;
            slip = touch_.hub_t * quicker;
        }
        for (std::size_t i = 0; i < n_; ++i) {
            gap += sign * jn_[i] * s.q[i];
            rate += sign * jn_[i] * s.v[i];
            if (mu_ > 0) slip += sign * jt_[i] * s.v[i];
        }
        touch_.gap += gap;
        touch_.gap_rate += rate;
        touch_.slip += slip;
    }

    // ṗ at the nodes → Θ̇, Θ.
    void hub_from_push(double h) {
        ExponentialSegment& s = *segment_;
        const Collocation& gauss = Collocation::get();
        Lanes p = Lanes{} + s.p0, theta = Lanes{} + s.theta0;
        for (int l = 0; l < kNodes; ++l) p += (h * s.push[l]) * gauss.integrate[static_cast<std::size_t>(l)];
        s.spin = p * (spin0_ != 0 ? spin0_ / s.p0 : 1 / form_->J);
        for (int l = 0; l < kNodes; ++l) theta += (h * s.spin[l]) * gauss.integrate[static_cast<std::size_t>(l)];
        const Lanes by = theta - theta_;
        theta_ = theta;
        turn_on(by);
    }

    // −∂gap/∂force and −∂(gap rate)/∂force between the nodes, with the rows at the start: what Newton's method needs.
    void compliance(const StepTable& table) {
        const Collocation& gauss = Collocation::get();
        const double h = table.h;
        const double hub = form_->prescribed ? 0 : start_touch_.hub * start_touch_.hub / form_->J;
        for (std::size_t l = 0; l < kNodes; ++l) {
            soft_[l] = (hub * h * h) * gauss.integrate_twice[l];
            soft_rate_[l] = (hub * h) * gauss.integrate[l];
        }
        double mobility = 0, kick = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            const double jn = row_[i];
            const StepTable::Row& row = table.rows[i];
            const double c = jn * jn / form_->mass;
            for (std::size_t l = 0; l < kNodes; ++l) {
                soft_[l] += c * row.q[l];
                soft_rate_[l] += c * row.v[l];
            }
            const double push = jn / form_->mass * std::min(h, 1 / form_->oscillators[i].omega);
            mobility += push * push;
            kick += c / form_->mass;
        }
        mobility_modes_ = std::sqrt(mobility);
        kick_ = std::sqrt(kick);
        mobility_hub_ = form_->prescribed ? 0 : std::fabs(start_touch_.hub) * h / form_->J;
    }

    double contact_error(double h) {
        const double smooth = smooth_error(h);
        double force = quadrature_tail(force_);
        if (mu_ > 0) force = std::max(force, quadrature_tail(friction_));
        return kContactShare *
               std::max({smooth, force * mobility_modes_ / scale_modes_, force * mobility_hub_ / scale_spin_});
    }

    // What is not the contact force: vibration that the nodes do not resolve shows in Θ̇.
    double smooth_error(double h) {
        set_scales(segment_->end.data(), next_.data());
        if (form_->prescribed) return 0;
        return quadrature_tail(segment_->spin) * h / scale_theta_;
    }

    // Half way to the centre of the disc the contact is beyond its geometry; the other method tells how that ends.
    bool deep() const {
        const double deepest = -0.5 * system_.problem().cam->radius;
        bool beyond = end_touch_.gap < deepest;
        for (int k = 0; k < kNodes; ++k) beyond = beyond || touch_.gap[k] < deepest;
        return beyond;
    }

    // Where the step must end: its length, or the first instant at which the gap opens or the law starts or stops to be
    // clamped, from the solution just found.
    double cut(double h, TouchSamples::Ending& ending) const {
        const Collocation& gauss = Collocation::get();
        const NormalLaw& law = system_.normal_law();
        double before = 0, gap = start_touch_.gap, factor = law.factor(-start_touch_.gap_rate, approach_);
        if (std::fabs(factor) < 1e-9) factor = law.factor(-touch_.gap_rate[0], approach_);
        for (int k = 0; k <= kNodes; ++k) {
            const double t = k < kNodes ? h * gauss.c[k] : h;
            const double g = k < kNodes ? touch_.gap[k] : end_touch_.gap;
            const double r = k < kNodes ? touch_.gap_rate[k] : end_touch_.gap_rate;
            const double now = law.factor(-r, approach_);
            double first = std::numeric_limits<double>::infinity();
            if (g > 0 && t > 0) {
                ending = TouchSamples::Ending::release;
                first = before + (t - before) * (gap < g ? std::clamp(-gap / (g - gap), 0.0, 1.0) : 1.0);
                if (r > 0) first = std::max(before, t - g / r);
            }
            if ((now > 0) != (factor > 0) && std::fabs(now) > 1e-9) {
                const double at = before + (t - before) * factor / (factor - now);
                if (at < first) {
                    ending = TouchSamples::Ending::clamp;
                    first = at;
                }
            }
            if (std::isfinite(first)) return first;
            before = t;
            gap = g;
            if (std::fabs(now) > 1e-9) factor = now;  // rounding has no sign
        }
        return h;
    }

    // The step just solved has an error of `error` <= 1 and ends as `ending` tells. It is cut at an event that no node
    // shows, if there is one, and again as long as the shorter one has another. The error of what is left.
    double cut_between_nodes(double error, TouchSamples::Ending& ending) {
        for (int cuts = 0; error <= 1; ++cuts) {
            TouchSamples::Ending found = TouchSamples::Ending::open;
            const double end = first_between_nodes(ending, found);
            if (found == TouchSamples::Ending::open) break;
            if (cuts == kMostCuts) return std::numeric_limits<double>::infinity();
            ending = found;
            carry_ = 0;
            error = solve_to(end, ending);
        }
        return error;
    }

    // When the first event between the nodes falls in the step just solved, and which: the gap opens, or the clamp of
    // the force sets in or lets go.                                                                            (S58)
    double first_between_nodes(TouchSamples::Ending ending, TouchSamples::Ending& found) {
        const Collocation& gauss = Collocation::get();
        const NormalLaw& law = system_.normal_law();
        const double h = segment_->h, deep = kGapRounding * form_->length;
        const bool clamps = law.damping > 0;
        const double level = clamps ? -approach_ / law.damping : 0, none = 1e-9 * -level;
        ripples_known_ = n_;
        const auto probe = [&](double t) { return penetration_at(t); };
        const auto ripple = [&](double span) { return unresolved(span); };
        Guard a{0, std::max(0.0, -start_touch_.gap), -start_touch_.gap_rate};
        start_side_ = std::fabs(a.rate - level) > none ? std::copysign(1.0, a.rate - level) : side_;
        for (int k = 0; k <= kNodes; ++k) {
            Guard b = k < kNodes ? Guard{h * gauss.c[k], -touch_.gap[k], -touch_.gap_rate[k]}
                                 : Guard{h, -end_touch_.gap, -end_touch_.gap_rate};
            if (k == kNodes && ending != TouchSamples::Ending::open) b.value = std::max(b.value, 0.0);
            Guard c = b;
            if (k == kNodes && ending == TouchSamples::Ending::clamp) c.rate = level;
            double first = std::numeric_limits<double>::infinity();
            const event_search::Quartic between(a, c, ripple(c.t - a.t));
            if (!between.positive(deep)) {
                const auto at = first_fall(probe, a, b, deep, ripple);
                if (at && *at > 0 && *at < h) {
                    first = *at;
                    found = TouchSamples::Ending::release;
                }
            }
            if (clamps && !between.keeps_side(level, start_side_, none)) {
                auto at = first_passing(probe, a, c, level, start_side_, none, ripple);
                // It starts on the kink, and was taken to be on the wrong side of it.
                if (at && std::fabs(a.rate - level) <= none && *at - a.t <= 1e-6 * (c.t - a.t)) {
                    start_side_ = -start_side_;
                    at = first_passing(probe, a, c, level, start_side_, none, ripple);
                }
                if (at && *at > 0 && *at < std::min(first, h)) {
                    first = *at;
                    found = TouchSamples::Ending::clamp;
                }
            }
            if (std::isfinite(first)) return first;
            a = b;
        }
        return h;
    }

    // Penetration and its rate inside the step just solved.
    Guard penetration_at(double after) {
        ExponentialSegment& s = *segment_;
        s.t1 = std::numeric_limits<double>::infinity();  // evaluated, not copied
        s.books = false;
        scratch_.resize(s.end.size());
        s.value(s.t0 + after, scratch_.data());
        Touch<double> touch;
        touch.dx = end_touch_.dx;
        look_at(s.t0 + after, scratch_.data(), touch);
        ++system_.gap_evaluations;
        return {after, -touch.gap, -touch.gap_rate};
    }

    // What of the penetration turns by more than two radians in `span`: the free vibration of a mode, about the
    // deflection that its forcing holds, keeps its amplitude.
    Ripple unresolved(double span) {
        constexpr double kResolvedTurn = 2;
        Ripple ripple;
        const ExponentialSegment& s = *segment_;
        for (std::size_t i = n_; i-- > 0 && form_->oscillators[i].omega * span > kResolvedTurn;) {
            const double w = form_->oscillators[i].omega, inverse = 1 / (w * w);
            if (ripples_known_ > i) {
                const Lanes free = s.q[i] - inverse * s.f[i];
                ripples_[i] = 2 * std::fabs(row_[i]) * std::sqrt(largest(free * free + inverse * (s.v[i] * s.v[i])));
                ripples_known_ = i;
            }
            ripple.value += ripples_[i];
            ripple.rate += w * ripples_[i];
        }
        return ripple;
    }

    // Solves again, ended at the release or at the kink, until the end lies on it. The error, as `solve_contact`.
    double solve_to(double end, TouchSamples::Ending ending) {
        const NormalLaw& law = system_.normal_law();
        double h = end, error = 0, closest = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kMostCuts; ++i) {
            if (!(h > 1e-14)) return std::numeric_limits<double>::infinity();
            odd_.build(form_->oscillators, form_->groups, h);
            error = solve_contact(odd_);
            if (!(error <= 1)) return error;
            double dt;
            if (ending == TouchSamples::Ending::release) {
                dt = -end_touch_.gap / end_touch_.gap_rate;
            } else {
                // Rate of the clamp's factor from the last node.
                const double now = law.factor(-end_touch_.gap_rate, approach_),
                             before = law.factor(-touch_.gap_rate[kNodes - 1], approach_),
                             span = h * (1 - Collocation::get().c[kNodes - 1]);
                dt = -now * span / (now - before);
            }
            if (!std::isfinite(dt)) return std::numeric_limits<double>::infinity();
            if (std::fabs(dt) < 1e-13 * h + 1e-16 || std::fabs(dt) >= closest) return error;
            if (ending == TouchSamples::Ending::clamp && std::fabs(dt) < 1e-6 * h) return error;
            // So near that the force in between changes nothing: the state is carried over.
            if (ending == TouchSamples::Ending::release && std::fabs(dt) < kCarried * h &&
                law.elastic(std::fabs(end_touch_.gap)) * std::fabs(dt) * kick_ < 0.1 * scale_modes_) {
                carry_ = dt;
                return error;
            }
            closest = std::fabs(dt);
            h += std::clamp(dt, -0.9 * h, 0.5 * h);
        }
        return std::numeric_limits<double>::infinity();
    }

    void touch_accept(TouchSamples::Ending ending) {
        ExponentialSegment& s = *segment_;
        ++counters.steps;
        side_ = ending == TouchSamples::Ending::clamp ? -start_side_ : start_side_;
        s.touching = true;
        s.t1 = s.t0 + s.h;
        first_step_ = s.h;
        if (s.h < crawl_) ++crawls_;
        finish();
        TouchSamples& samples = s.samples;
        samples.ending = ending;
        const auto put = [&](int k, double t, double gap, double rate, double force, double x) {
            samples.t[k] = t;
            samples.gap[k] = gap;
            samples.gap_rate[k] = rate;
            samples.force[k] = force;
            samples.x[k] = x;
        };
        put(0, s.t0, start_touch_.gap, start_touch_.gap_rate, force0_, contact_->at() + start_touch_.dx);
        for (int k = 0; k < kNodes; ++k)
            put(k + 1, time_[k], touch_.gap[k], touch_.gap_rate[k], force_[k], contact_->at() + touch_.dx[k]);
        double force, by_depth, by_rate;
        law(-end_touch_.gap, -end_touch_.gap_rate, force, by_depth, by_rate);
        put(kNodes + 1, s.t1, end_touch_.gap, end_touch_.gap_rate, force, contact_->at() + end_touch_.dx);
        t_ = s.t1;
        if (carry_ != 0) {
            const double at = t_ + carry_;
            carry_ = 0;
            shorten(at);
            samples.t[kNodes + 1] = at;
            samples.gap[kNodes + 1] = samples.force[kNodes + 1] = 0;
        }
    }

    System& system_;
    std::shared_ptr<const ModalForm> form_;
    double rtol_, atol_;
    std::size_t n_;
    std::unique_ptr<Integrator> fallback_;
    IntegratorCounters seen_;
    bool falling_back_ = true;
    std::unique_ptr<ExponentialSegment> segment_;
    std::vector<StepTable> ladder_;
    StepTable odd_;
    int flight_rung_ = kFirstFlight;
    // [s] The next step of flight, and in contact one of the other method, is at most this long.
    double first_step_ = std::numeric_limits<double>::infinity();
    double t_ = 0, spin0_ = 0, largest_change_ = 0;
    double scale_modes_ = 1, scale_spin_ = 1, scale_theta_ = 1;
    Lanes time_{}, theta_{}, sin_{}, cos_{}, acceleration_{}, torque_{}, inertia_{};
    const LaneKernels& kernels_ = lane_kernels();
    std::vector<Lanes> base_q_, base_v_, bq_, gq_;
    std::vector<double> next_, start_, scratch_;
    // In contact.
    std::unique_ptr<ContactExpansion> contact_;
    bool touching_ = false, sharp_ = false;
    long crawls_ = 0;   // steps of this touch shorter than…
    double crawl_ = 0;  // [s]
    int touch_rung_ = kFirstTouch;
    double side_ = 1, start_side_ = 1;  // of the kink of the clamp: +1 pushes; where the next step starts, the last did
    std::vector<double> ripples_;       // of the modes from `ripples_known_` on
    std::size_t ripples_known_ = 0;
    double mu_ = 0, slip_speed_ = 1, approach_ = 1, gap_offset_ = 0, force0_ = 0, carry_ = 0, centred_ = -1;
    double mobility_modes_ = 0, mobility_hub_ = 0, kick_ = 0;
    Touch<double> start_touch_, end_touch_;
    Touch<Lanes> touch_;
    Lanes force_{}, friction_{}, seen_theta_{}, seen_spin_{};  // as the contact was last looked at
    std::array<Lanes, kNodes> soft_, soft_rate_;
    std::vector<double> row_, hq_end_;
    std::vector<Lanes> hq_, jn_, jt_;
};

}  // namespace

bool exponential_applies(System& system) { return ModalForm::of(system) != nullptr; }

std::unique_ptr<Integrator> make_exponential(System& system, double rtol, double atol) {
    return std::make_unique<Exponential>(system, rtol, atol);
}

}  // namespace beamcam::sim
