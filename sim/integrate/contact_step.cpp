#include "sim/integrate/contact_step.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/assert.hpp"

namespace beamcam::sim {
namespace {

// Steps of sustained contact are kept to a larger share of the tolerance than others in contact: undamped vibration,
// which their own errors excite, would otherwise limit them.
constexpr double kHeldShare = 4;
constexpr int kMostNewton = 25;         // in contact, where the first sweeps find the nodes that touch
constexpr int kMostNewtonCoupled = 14;  // where sweeps cost more, and a contraction by less is strong coupling
// Changes of the iteration that no longer fall are rounding once they are below this share of the largest; the stiff
// force amplifies it. Before the nodes that touch are found, the first sweeps may grow by up to kContactGrowth.
constexpr double kContactRounding = 1e-11, kContactGrowth = 2;
constexpr int kContactPatience = 5;
constexpr double kMostRounding = 10;  // of the tolerance: changes that rounding of the force explains end the iteration
constexpr double kTwoRoundings = 4e-16;  // of the beam's length, and of the way of the disc's centre
// Largest of the last two Legendre coefficients, times the length of the step, of the rate of a polynomial that is zero
// at the start and up to 1 at the nodes: rounding of a gap's rate becomes such a constraint force.
constexpr double kRoughestRate = 136;
// Where the damping or friction of a contact decays by more than kFastDecay within a step, an error of a rate becomes a
// force that no polynomial follows, of friction as many times larger: the iteration may leave only a share of
// kContactShare. So it is from kSteadyDecay on where the force varies by less than kSteadyForce: in a lasting contact
// it is the only error. Contractions vary from sweep to sweep; kSlowestContraction is the poorest after a good one.
constexpr double kFastDecay = 5, kSteadyDecay = 2, kSteadyForce = 1e-2, kSlowestContraction = 0.03;
constexpr double kDeepest = 0.5;  // of the cam's radius: beyond, the contact leaves its geometry

bool is_steady(const Lanes& force) {
    const double most = largest(force);
    return largest(most - force) < kSteadyForce * most;
}

}  // namespace

ContactStep::ContactStep(NodalStep& step)
    : row(step.n),
      step_(step),
      form_(*step.form),
      law_(step.system.normal_law()),
      friction_(step.system.friction()),
      expansion_(step.system),
      friction_step_(friction_),
      row_t_(step.n),
      hq_end_(expansion_.scratch()),
      hq_(expansion_.scratch()),
      coordinate_rows_(step.n + 1) {
    load.rough = !friction_.none();
    load.jn.resize(step.n);
    load.jt.resize(step.n);
}

void ContactStep::begin_touch(const ContactState& c) {
    const Phase& phase = step_.system.phase();
    BEAMCAM_ASSERT(!c.at_end && (phase.held || phase.approach > 0));
    held_ = phase.held;
    held_end_ = {c.force, step_.system.off_constraint(c.gap, c.gap_rate)};
    approach = phase.approach;
    gap_offset_ = phase.gap_offset;
    expansion_.centre_near(c.x);
    start = {};
    start.dx = c.x - expansion_.at();
}

double ContactStep::solve(const StepTable& nodal) {
    ExponentialSegment& s = step_.segment;
    const double h = nodal.h;
    if (held_ && projected_.h != h) projected_.build_projected(form_.oscillators, nodal);
    const StepTable& table = held_ ? projected_ : nodal;
    step_.begin_attempt(nodal);
    linearize(table);
    // The feet of the last attempt are the first guess, unless they left the expansion.
    for (int k = 0; k < kNodes; ++k)
        if (!(std::fabs(load.contact.dx[k]) <= expansion_.range())) place_at_start();
    guess(table);
    FixedPoint iteration(kContactRounding, kContactGrowth, kContactPatience);
    auto status = FixedPoint::Status::going;
    double change = 0;
    const int most = form_.by_arrays() ? kMostNewton : kMostNewtonCoupled;
    for (int sweep = 0; sweep < most && status == FixedPoint::Status::going; ++sweep) {
        if (!improve(table, sweep == 0 ? kFootCorrections : 1)) return kNoSolution;
        if (held_ || decays_ > (is_steady(load.force) ? kSteadyDecay : kFastDecay))
            iteration.demand(kShareOfIteration / kContactShare / std::max(1.0, friction_step_.decay()),
                             kSlowestContraction);
        change = step_.update_forcing(table, &load);
        // The forces of a constraint follow the other forcing one sweep later: every second change shows the
        // contraction.
        if (!held_ || sweep % 2 == 1) status = iteration.add(change);
    }
    const bool rounded = change <= std::min(kMostRounding, of_force(force_rounding_));
    if (status != FixedPoint::Status::settled && !iteration.enough() && !rounded) return kNoSolution;
    move(-1);
    step_.propagate(table);
    step_.propagate_rates(table);
    move(1);
    if (held_) {
        step_.propagate_free(nodal);
        step_.propagate(nodal);
        step_.propagate_rates(nodal);
    }
    if (friction_.bristle) friction_step_.settle(load.force, load.contact.slip, load.friction, s.bristle_rate);
    step_.arrive(table);
    end.dx = load.contact.dx[kNodes - 1];
    state_ = step_.next;
    form_.to_coordinates(state_.data());
    evaluate(s.t0 + h, state_.data(), end);
    const double reach = std::max(largest(load.contact.dx), std::fabs(end.dx));
    const double low = expansion_.at() - reach, high = expansion_.at() + reach;
    if (reach > expansion_.range() || low <= 0 || high >= form_.length) return kNoSolution;
    return error(h);
}

// The force by extrapolation of the penetration and its rate at the start.
void ContactStep::guess(const StepTable& table) {
    ExponentialSegment& s = step_.segment;
    const TurningCam& cam = step_.system.cam();
    frame_.osculating = !cam.is_disc();
    for (int k = 0; k < kNodes; ++k) {
        if (frame_.osculating) {
            cam_angle_[k] = cam.angle(step_.time[k]);
            continue;
        }
        const OsculatingDisc disc = cam.disc(step_.time[k], {});
        frame_.disc_x[k] = disc.centre.x;
        frame_.disc_y[k] = disc.centre.y;
        frame_.disc_vx[k] = disc.velocity.x;
        frame_.disc_vy[k] = disc.velocity.y;
        frame_.radius[k] = disc.radius;
    }
    const Lanes tau = table.h * Collocation::get().c;
    for (int k = 0; k < kNodes; ++k) {
        if (held_) {
            off_at_nodes_[k] = share_left(step_.time[k] - s.t0) * off(start);
            load.force[k] = held_start_.force;
        } else {
            load.force[k] =
                law_.at(start.radius).force(-start.gap - start.gap_rate * tau[k], -start.gap_rate, approach);
        }
    }
    load.friction = load.rough ? friction_step_.guess(load.force, start.slip) : Lanes{};
    step_.propagate_unforced(table);
    for (std::size_t i = 0; i < step_.n; ++i) s.f[i] += load.force * (row[i] / form_.mass);
    s.p_dot = load.force * start.hub - form_.gravity * form_.S * step_.cos + step_.torque;
    if (load.rough) {
        for (std::size_t i = 0; i < step_.n; ++i) s.f[i] += load.friction * (row_t_[i] / form_.mass);
        s.p_dot += load.friction * start.hub_t;
    }
    if (!form_.prescribed) step_.hub_from_load(table.h);
}

// A step of Newton's method for the nodal forces. False: its equations are singular.
bool ContactStep::improve(const StepTable& table, int corrections) {
    ExponentialSegment& s = step_.segment;
    step_.propagate(table);
    step_.propagate_rates(table);
    step_.place_coordinates();
    place_contact(corrections);
    contact_theta_ = step_.theta;
    contact_theta_dot_ = s.theta_dot;
    const ContactKinematics<Lanes>& contact = load.contact;
    Lanes residual, by_depth, by_rate;
    for (int k = 0; k < kNodes; ++k) {
        const ForceAndSlopes at = normal_residual(k);
        residual[k] = at.force;
        by_depth[k] = at.by_depth;
        by_rate[k] = at.by_rate;
    }
    force_rounding_ = depth_rounding() * largest(by_depth) + rate_rounding() * largest(by_rate);
    if (held_) force_rounding_ *= kRoughestRate / mobility_contact_;
    decays_ = held_ ? 0 : largest(by_rate) * mobility_contact_;
    if (load.rough) {
        if (!friction_step_.linearize(load.force, load.friction, contact.slip)) return false;
        decays_ = std::max(decays_, friction_step_.decay());
        residual -= by_depth * friction_step_.gap_ahead() + by_rate * friction_step_.gap_rate_ahead();
    }
    const NodalCompliance& response = load.rough ? friction_step_.gap() : compliance_;
    NodalMatrix matrix;
    for (std::size_t l = 0; l < kNodes; ++l) {
        matrix[l] = by_depth * response.value[l] + by_rate * response.rate[l];
        if (!held_) matrix[l][static_cast<int>(l)] += 1;
    }
    if (!solve_dense(matrix, {&residual, 1})) return false;
    load.force += residual;
    if (load.rough) load.friction += friction_step_.change(residual);
    return true;
}

// Rounding of the gap and of its rate. After many turns the disc's place is uncertain by its travel within the rounding
// of the time, and its velocity by what that turns.
double ContactStep::depth_rounding() const {
    return std::max(kTwoRoundings * form_.length, kTwoRoundings * disc_travel());
}
double ContactStep::rate_rounding() const {
    const double speed = std::fabs(step_.system.problem().cam->speed);
    return kTwoRoundings * form_.length * largest(step_.segment.theta_dot) + kTwoRoundings * disc_travel() * speed;
}
double ContactStep::disc_travel() const {
    const TurningCam& cam = step_.system.cam();
    return std::fabs(cam.speed() * cam.shape().largest_arm() * step_.time[kNodes - 1]);
}

// The difference of the force at a node from that of its law, and the slopes of the law; in sustained contact, of
// ġ + κg from its start decayed at the rate κ.
ForceAndSlopes ContactStep::normal_residual(int k) const {
    const double gap = load.contact.gap[k], rate = load.contact.gap_rate[k];
    const System& system = step_.system;
    if (held_) return {off_at_nodes_[k] - system.off_constraint(gap, rate), system.baumgarte_rate(), 1};
    ForceAndSlopes at = law_.at(load.contact.radius[k]).linearized(-gap, -rate, approach);
    at.force -= load.force[k];
    return at;
}

// How gap and slip respond to nodal forces, with the rows at the start, for Newton's method.
void ContactStep::linearize(const StepTable& table) {
    const double h = table.h;
    const auto compliance = [&](double hub, const std::vector<double>& a, const std::vector<double>& b) {
        return nodal_compliance(table, form_.mass, form_.prescribed ? 0 : hub / form_.J, a, b);
    };
    compliance_ = compliance(start.hub * start.hub, row, row);
    double mobility2 = 0, rate2 = 0;
    for (std::size_t i = 0; i < step_.n; ++i) {
        const double jn = row[i], reach = std::min(h, 1 / form_.oscillators[i].omega);
        const double moved = jn / form_.mass * reach, moved_t = row_t_[i] / form_.mass * reach;
        mobility2 += moved * moved;
        if (load.rough) mobility2 += moved_t * moved_t;
        rate2 += jn * jn / form_.mass / form_.mass;
    }
    Lanes turned{};  // by a unit force from the start on
    for (const Lanes& rate : compliance_.rate) turned += rate;
    mobility_contact_ = largest(turned);
    mobility_modes_ = std::sqrt(mobility2);
    mode_rate_per_impulse = std::sqrt(rate2);
    gap_rate_per_impulse_ = rate2 * form_.mass + (form_.prescribed ? 0 : start.hub * start.hub / form_.J);
    const double arm = load.rough ? std::hypot(start.hub, start.hub_t) : std::fabs(start.hub);
    mobility_hub_ = form_.prescribed ? 0 : arm * h / form_.J;
    if (!load.rough) return;
    friction_step_.begin(step_.system.phase().friction, step_.segment.bristle0, h, compliance_,
                         compliance(start.hub * start.hub_t, row, row_t_),
                         compliance(start.hub_t * start.hub_t, row_t_, row_t_));
}

double ContactStep::error(double h) {
    const double smooth = step_.forcing_error(h, &load);
    double force = quadrature_error(load.force, force_rounding_);
    if (load.rough)
        force = std::max(quadrature_error(load.friction, force_rounding_) * friction_step_.lasting_share(), force);
    if (load.rough && !friction_.bristle)
        force = std::max(largest(load.force) * friction_step_.missed(start.slip, load.contact.slip, end.slip), force);
    if (friction_.bristle)  // of the deflection at the end, by its force
        force =
            std::max(quadrature_error(friction_.stiffness * h * step_.segment.bristle_rate, force_rounding_), force);
    if (!std::isfinite(force)) return force;  // a maximum of several would hide it
    const double contact = (held_ ? kHeldShare : kContactShare) * std::max(smooth, of_force(force));
    if (!held_) return contact;
    // The impulse by which `hold_end` will put the end on the constraint.
    const double impulse = std::fabs(off(end) - share_left(h) * off(start)) / gap_rate_per_impulse_;
    const double hub = form_.prescribed ? 0 : impulse * std::fabs(start.hub) / form_.J;
    return std::max({contact, impulse * mode_rate_per_impulse / step_.scale_modes, hub / step_.scale_theta_dot});
}

bool ContactStep::deep() const {
    bool beyond = end.gap < -kDeepest * end.radius;
    for (int k = 0; k < kNodes; ++k) beyond = beyond || load.contact.gap[k] < -kDeepest * load.contact.radius[k];
    return beyond;
}

void ContactStep::hold_end() {
    if (!held_) return;
    ExponentialSegment& s = step_.segment;
    held_end_.off = held_start_.off * share_left(s.h);
    held_end_.force = step_.system.hold(s.t1, held_end_.off, s.end.data()).force;
}

void ContactStep::fill(TouchSamples& samples) const {
    const auto put = [&](int k, double t, double gap, double rate, double normal_force, double tangential, double dx) {
        samples.t[k] = t;
        samples.gap[k] = gap;
        samples.gap_rate[k] = rate;
        samples.force[k] = std::max(0.0, normal_force);  // of a constraint less is rounding
        samples.friction[k] = tangential;
        samples.x[k] = expansion_.at() + dx;
    };
    const ExponentialSegment& s = step_.segment;
    const System& system = step_.system;
    const auto put_end = [&](int k, double t, const ContactKinematics<double>& c, const Held& held, double z) {
        const double normal = held_ ? held.force : force(c).force;
        put(k, t, c.gap, c.gap_rate, normal, friction_.force(system.phase().friction, normal, c.slip, z), c.dx);
    };
    put_end(0, s.t0, start, held_start_, s.bristle0);
    const ContactKinematics<Lanes>& c = load.contact;
    for (int k = 0; k < kNodes; ++k)
        put(k + 1, step_.time[k], c.gap[k], c.gap_rate[k], load.force[k], load.friction[k], c.dx[k]);
    put_end(kNodes + 1, s.t1, end, held_end_, system.bristle(s.end.data()));
}

}  // namespace beamcam::sim
