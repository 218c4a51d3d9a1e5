#include "sim/integrate/nodal_step.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/assert.hpp"

namespace beamcam::sim {
NodalStep::NodalStep(System& of, std::shared_ptr<const ModalForm> modal_form, double relative, double absolute,
                     long& count)
    : system(of),
      form(std::move(modal_form)),
      n(static_cast<std::size_t>(form->n)),
      segment(form, system.drive(), system.size),
      next(static_cast<std::size_t>(system.size)),
      evaluations(count),
      rtol_(relative),
      atol_(absolute),
      base_q_(n),
      base_v_(n),
      bq_(n),
      gq_(n),
      start_(next.size()),
      start_forcing_(form->damped ? next.size() : 0) {
    if (form->by_arrays()) return;
    inertia_ = std::make_unique<InertiaForces>(system.problem());
    for (auto* v : {&position_, &rate_, &coordinate_acceleration_, &forces_}) v->resize(n + 1);
    mode_acceleration_.resize(n);
    resistance_.resize(n);
}

void NodalStep::begin(double t) {
    ExponentialSegment& s = segment;
    s.t0 = t;
    std::copy_n(s.end.begin(), start_.size(), start_.begin());
    form->to_modes(start_.data());
    const double* y = start_.data();
    std::copy_n(y + 1, n, s.q0.begin());
    std::copy_n(y + 2 + n, n, s.v0.begin());
    std::copy_n(s.end.data() + system.ledger_at, kLedgerSize, s.ledger0);
    s.bristle0 = system.bristle(s.end.data());
    s.theta0 = y[0];
    theta_dot0 = y[1 + n];
    s.p0 = form->prescribed ? 0 : theta_dot0 * s.inertia(y + 1);
    set_scales(y, y);
    if (form->damped && !system.phase().touching) place_start_forcing();
}

// From the accelerations of the whole system.
void NodalStep::place_start_forcing() {
    const ExponentialSegment& s = segment;
    system.rhs(s.t0, s.end.data(), start_forcing_.data());
    form->to_modes(start_forcing_.data());
    double* at = start_forcing_.data() + 1 + n;
    double inertia_rate = 0;
    for (std::size_t i = 0; i < form->inertia.size(); ++i)
        inertia_rate += 2 * s.v0[i / n] * form->inertia[i] * s.q0[i % n];
    at[0] = at[0] * s.inertia(start_.data() + 1) + theta_dot0 * inertia_rate;
    for (std::size_t i = 0; i < n; ++i) {
        const Oscillator& o = form->oscillators[i];
        at[1 + i] = at[1 + i] + 2 * o.gamma * s.v0[i] + o.omega * o.omega * s.q0[i];
    }
}

void NodalStep::propagate_rates(const StepTable& table) {
    for (std::size_t i = 0; i < n; ++i) {
        Lanes v = base_v_[i];
        for (int l = 0; l < kNodes; ++l) v += segment.f[i][l] * table.rows[i].v[static_cast<std::size_t>(l)];
        segment.v[i] = v;
    }
}

void NodalStep::propagate_free(const StepTable& table) {
    for (std::size_t i = 0; i < n; ++i) {
        const StepTable::Row& row = table.rows[i];
        base_q_[i] = row.qq * segment.q0[i] + row.qv * segment.v0[i];
        base_v_[i] = row.vq * segment.q0[i] + row.vv * segment.v0[i];
    }
}

void NodalStep::propagate_unforced(const StepTable& table) {
    propagate_free(table);
    for (std::size_t i = 0; i < n; ++i) smooth_force(i, segment.f[i]);
}

void NodalStep::arrive(const StepTable& table) {
    ExponentialSegment& s = segment;
    s.integrate_hub();
    const Collocation& gauss = Collocation::get();
    const double h = table.h;
    for (std::size_t i = 0; i < n; ++i) {
        const StepTable::Row& row = table.rows[i];
        next[1 + i] = row.end_qq * s.q0[i] + row.end_qv * s.v0[i] + sum(row.end_q * s.f[i]);
        next[2 + n + i] = row.end_vq * s.q0[i] + row.end_vv * s.v0[i] + sum(row.end_v * s.f[i]);
    }
    if (s.has_bristle()) next[2 * (n + 1)] = s.bristle0 + h * sum(gauss.b * s.bristle_rate);
    if (form->prescribed) {
        const HubMotion hub = system.drive().motion(s.t0 + h);
        next[0] = hub.angle;
        next[1 + n] = hub.rate;
    } else {
        next[0] = s.theta0 + h * sum(gauss.b * s.theta_dot);
        next[1 + n] = (s.p0 + h * sum(gauss.b * s.p_dot)) / s.inertia(next.data() + 1);
    }
}

void NodalStep::begin_attempt(const StepTable& table) {
    const double h = table.h;
    const Collocation& gauss = Collocation::get();
    ExponentialSegment& s = segment;
    s.h = h;
    s.bristle_rate = Lanes{};
    time = s.t0 + h * gauss.c;
    if (form->prescribed) {
        for (int k = 0; k < kNodes; ++k) {
            const HubMotion hub = system.drive().motion(time[k]);
            theta[k] = hub.angle;
            s.theta_dot[k] = hub.rate;
            acceleration_[k] = hub.acceleration;
        }
    } else {
        const double acceleration = -form->gravity * form->S * std::cos(s.theta0) / form->J;
        const Lanes tau = h * gauss.c;
        theta = s.theta0 + tau * (theta_dot0 + 0.5 * acceleration * tau);
        s.theta_dot = theta_dot0 + acceleration * tau;
        acceleration_ = Lanes{};
    }
    drive_torque_ = Lanes{};
    if (system.drive().has_torque())
        for (int k = 0; k < kNodes; ++k) drive_torque_[k] = system.drive().torque(time[k]);
    for (std::size_t i = 0; system.spring() && i < n; ++i) {
        s.q[i] = Lanes{} + s.q0[i];
        s.v[i] = Lanes{} + s.v0[i];
    }
    torque = torque_by_law();
    if (system.spring()) place_spring(table);
    frame_angle_ = theta;
    evaluate_angle();
    if (inertia_ && !form->prescribed) s.p_dot = torque - form->gravity * form->S * cos;
}

Lanes NodalStep::hub_angle() const {
    Lanes angle = theta;
    for (std::size_t i = 0; i < n; ++i) angle += form->h[i] * segment.q[i];
    return angle;
}

Lanes NodalStep::hub_rate() const {
    Lanes rate = segment.theta_dot;
    for (std::size_t i = 0; i < n; ++i) rate += form->h[i] * segment.v[i];
    return rate;
}

Lanes NodalStep::torque_by_law() const {
    Lanes by_law = drive_torque_;
    if (const auto& spring = system.spring())
        by_law -= spring->stiffness * (hub_angle() - spring->free_angle) + spring->damping * hub_rate();
    return by_law;
}

// The hub yields to the torque of its spring: θ and θ̇ respond to it as a gap to the contact force.
void NodalStep::place_spring(const StepTable& table) {
    const HubSpring& spring = *system.spring();
    const NodalCompliance hub =
        nodal_compliance(table, form->mass, form->prescribed ? 0 : 1 / form->J, form->h, form->h);
    for (int l = 0; l < kNodes; ++l) {
        Lanes& column = spring_matrix_[static_cast<std::size_t>(l)];
        column = spring.stiffness * hub.value[static_cast<std::size_t>(l)] +
                 spring.damping * hub.rate[static_cast<std::size_t>(l)];
        column[l] += 1;
    }
}

// Newton's method for the torque of the hub's spring.
void NodalStep::place_torque() {
    Lanes change = torque_by_law() - torque;
    if (solve_dense(spring_matrix_, {&change, 1})) torque += change;
}

void NodalStep::evaluate_angle() {
    for (int k = 0; k < kNodes; ++k) {
        sin[k] = std::sin(frame_angle_[k]);
        cos[k] = std::cos(frame_angle_[k]);
    }
}

// Follows a small change of the angle by a rotation, exact to rounding up to kSmallRotation.
void NodalStep::advance_angle(const Lanes& to) {
    const Lanes by = to - frame_angle_;
    frame_angle_ = to;
    if (!(largest(by) < kSmallRotation)) return evaluate_angle();
    Lanes s, c;
    small_sine_and_cosine(by, s, c);
    const Lanes sine = sin * c + cos * s;
    cos = cos * c - sin * s;
    sin = sine;
}

// The part of the forcing that does not depend on q, per mass.
void NodalStep::smooth_force(std::size_t i, Lanes& f) const {
    f = (-form->gravity * form->weight[i]) * cos + (form->h[i] / form->mass) * torque;
    if (form->prescribed) f -= (form->U[i] / form->mass) * acceleration_;
}

void NodalStep::propagate(const StepTable& table) {
    for (std::size_t i = 0; i < n; ++i) {
        Lanes q = base_q_[i];
        for (int l = 0; l < kNodes; ++l) q += segment.f[i][l] * table.rows[i].q[static_cast<std::size_t>(l)];
        segment.q[i] = q;
    }
}

double NodalStep::update_forcing(const StepTable& table, const ContactLoad* load) {
    BEAMCAM_ASSERT(table.h > 0 && table.rows.size() == n);
    BEAMCAM_ASSERT(!load || load->jn.size() == n);
    if (system.spring()) place_torque();
    return inertia_ ? update_by_inertia(table, load) : update_by_arrays(table, load);
}

double NodalStep::update_by_arrays(const StepTable& table, const ContactLoad* load) {
    ExponentialSegment& s = segment;
    const double h = table.h;
    evaluations += kNodes;
    const Lanes x = s.theta_dot * s.theta_dot, weight = form->gravity * sin;
    const double per_mass = 1 / form->mass;
    product(n, n, form->inertia.data(), s.q.data(), bq_.data());
    if (!form->fall.empty()) product(n, n, form->fall.data(), s.q.data(), gq_.data());
    Lanes quadratic{}, fall{}, weighted{};
    double change2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Lanes &a = bq_[i], &b = gq_[i];
        quadratic += a * s.q[i];
        fall += b * s.q[i];
        weighted += form->weight[i] * s.q[i];
        Lanes f;
        smooth_force(i, f);
        f += x * (per_mass * a) + weight * b;
        if (load) f += load->modal(i) * per_mass;
        const double d = largest(f - s.f[i]) * std::min(h, 1 / form->oscillators[i].omega);
        change2 += d * d;
        s.f[i] = f;
    }
    const double modal = std::sqrt(change2) / scale_modes;
    if (form->prescribed) return modal;
    s.p_dot = -form->gravity * (form->S * cos - form->mass * (weighted * sin + 0.5 * cos * fall)) + torque;
    if (load) s.p_dot += load->torque();
    return std::max(modal, turn_hub(h, form->J + quadratic));
}

// Θ̇ and Θ at the nodes from ṗ; returns how much changed, in units of the tolerance.
double NodalStep::turn_hub(double h, const Lanes& inertia) {
    ExponentialSegment& s = segment;
    const Lanes theta_dot = at_nodes(s.p0, h, s.p_dot) / inertia;
    const double rate_change = largest(theta_dot - s.theta_dot) / scale_theta_dot;
    s.theta_dot = theta_dot;
    return std::max(rate_change, set_angle(h) / scale_theta);
}

void NodalStep::hub_from_load(double h) {
    ExponentialSegment& s = segment;
    s.theta_dot = at_nodes(s.p0, h, s.p_dot) * (theta_dot0 != 0 ? theta_dot0 / s.p0 : 1 / form->J);
    set_angle(h);
}

// Θ at the nodes from Θ̇; returns its largest change.
double NodalStep::set_angle(double h) {
    const Lanes changed = at_nodes(segment.theta0, h, segment.theta_dot), by = changed - theta;
    theta = changed;
    if (!inertia_) advance_angle(changed);
    return largest(by);
}

void NodalStep::set_scales(const double* a, const double* b) {
    double before = 0, after = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double w = form->oscillators[i].omega;
        before += a[2 + n + i] * a[2 + n + i] + w * w * a[1 + i] * a[1 + i];
        after += b[2 + n + i] * b[2 + n + i] + w * w * b[1 + i] * b[1 + i];
    }
    scale_modes = rtol_ * std::sqrt(std::max(before, after)) + atol_;
    scale_theta_dot = rtol_ * std::max(std::fabs(a[1 + n]), std::fabs(b[1 + n])) + atol_;
    scale_theta = rtol_ * std::max(std::fabs(a[0]), std::fabs(b[0])) + atol_;
}

// A vibration that decays before the first node changes the forcing at the start only. What the polynomial through the
// nodal values misses there, beyond its last coefficients, lasts up to the first node. Steps in contact begin short.
double NodalStep::start_error(double h) const {
    const Collocation& gauss = Collocation::get();
    const auto missed = [&](double before, const Lanes& nodal) {
        return std::max(0.0, std::fabs(before - sum(gauss.derive[0][0] * nodal)) - legendre_decay(nodal).last);
    };
    double slowest = kNoSolution;
    for (const Oscillator& o : form->oscillators) slowest = std::min(slowest, o.gamma);
    const double span = std::min(gauss.c[0] * h, 1 / slowest), *start = start_forcing_.data() + 1 + n;
    double errors = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double e = missed(start[1 + i], segment.f[i]) * std::min(span, 1 / form->oscillators[i].omega);
        errors += e * e;
    }
    const double modal = std::sqrt(errors) / scale_modes;
    if (form->prescribed) return modal;
    return std::max(modal, missed(start[0], segment.p_dot) * span / form->J / scale_theta_dot);
}

double NodalStep::forcing_error(double h, const ContactLoad* load) {
    const ExponentialSegment& s = segment;
    set_scales(start_.data(), next.data());
    double errors = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Lanes f = load ? s.f[i] - load->modal(i) * (1 / form->mass) : s.f[i];
        const double e = interpolation_error(f) * std::min(h, 1 / form->oscillators[i].omega);
        errors += e * e;
    }
    const double modal = std::max(std::sqrt(errors) / scale_modes, form->damped && !load ? start_error(h) : 0);
    if (form->prescribed) return modal;
    const double torque_error = interpolation_error(load ? s.p_dot - load->torque() : s.p_dot) * h / form->J;
    // The contact turns Θ̇ by a polynomial of the degree of its force, whose error is that of the force.
    const double turn = load ? quadrature_error(s.theta_dot) : interpolation_error(s.theta_dot);
    return std::max({modal, torque_error / scale_theta_dot, turn * h / scale_theta});
}

void NodalStep::finish(const ContactLoad* load) {
    ExponentialSegment& s = segment;
    std::copy_n(next.begin(), system.ledger_at, s.end.begin());
    finish_ledger(load);
    form->to_coordinates(s.end.data());
}

}  // namespace beamcam::sim
