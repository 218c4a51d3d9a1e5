#include "sim/orbit/variation.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::sim {
namespace {

// Of the scale on which the equations bend: errors of differences are about 1e-10 of it, half of them rounding.
constexpr double kStep = 4e-6;
// Longer, because the cam's angle grows without bound; Richardson's extrapolation makes up for it.
constexpr double kTimeStep = 1e-4;
// The equations are quadratic in the rates, but for the friction of sustained contact: of the slip or the slip speed.
constexpr double kRateStep = 1e-3, kSlipStep = 1e-4;
constexpr double kRelativeStep = 1e-5;   // of impulses by speeds and compliance
constexpr double kSlowestMotion = 1e-3;  // [1/s] without cam speed and gravity

// Rows of `geometry`.
enum Geometry : int { kGap, kRadius, kGapRate, kSlip, kGeometry };

void put(const ContactState& c, double* out) {
    out[kGap] = c.gap;
    out[kGapRate] = c.gap_rate;
    out[kSlip] = c.slip;
    out[kRadius] = c.disc.radius;
}

}  // namespace

double typical_rate(const Problem& problem) {
    const double speed = problem.cam ? std::fabs(problem.cam->speed) : 0;
    return std::max({speed, std::sqrt(std::fabs(problem.gravity) / problem.beam.length), kSlowestMotion});
}

Variation::Variation(const System& system) : system_(system), n_(system.coordinates()), step_(2 * n_) {
    const Problem& problem = system_.problem();
    const Eigen::VectorXd inertia = system_.model().linearize().mass.diagonal();
    // Of the same energy as a radian of the hub.
    for (int i = 0; i < n_; ++i) step_[i] = kStep * std::sqrt(inertia[0] / inertia[i]);
    time_step_ = kTimeStep / typical_rate(problem);
}

void Variation::set(double t, const double* y, const Phase& phase) {
    t_ = t;
    y_ = Eigen::Map<const Eigen::VectorXd>(y, system_.size);
    system_.set_phase(phase);
    if (phase.touching) at_ = system_.contact(t, y);
    const Problem& problem = system_.problem();
    double rate_step = kRateStep * typical_rate(problem);
    if (phase.held && !system_.friction().none()) {
        const double slip = std::max(system_.friction().slip_speed, std::fabs(at_.slip));
        rate_step = std::min(rate_step, kSlipStep * slip / problem.beam.length);
    }
    step_.tail(n_) = step_.head(n_) * (rate_step / kStep);
}

// In sustained contact ξ̈ jumps where the contact passes an end of the beam: there the differences are on one side.
Eigen::MatrixXd Variation::differences(Eigen::Index rows, const Values& values) {
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(rows, time() + 1);
    Eigen::VectorXd here(rows), above(rows), below(rows);
    const bool at_end = values(t_, y_.data(), here);
    const auto slope = [&](double at, double high, bool high_at_end, double low, bool low_at_end) {
        if (high_at_end != at_end && low_at_end == at_end) above = here, high = at;
        if (high_at_end == at_end && low_at_end != at_end) below = here, low = at;
        return Eigen::VectorXd((above - below) / (high - low));
    };
    perturbed_ = y_;
    const int first = system_.drive().prescribed() ? 1 : 0;
    for (int k = first; k < 2 * n_; ++k) {
        if (first > 0 && k == n_) continue;
        const double high = perturbed_[k] = y_[k] + step_[k];
        const bool high_at_end = values(t_, perturbed_.data(), above);
        const double low = perturbed_[k] = y_[k] - step_[k];
        const bool low_at_end = values(t_, perturbed_.data(), below);
        perturbed_[k] = y_[k];
        slopes.col(k) = slope(y_[k], high, high_at_end, low, low_at_end);
    }
    const auto by_time = [&](double step) {
        const double later = t_ + step, earlier = t_ - step;
        const bool later_at_end = values(later, perturbed_.data(), above);
        const bool earlier_at_end = values(earlier, perturbed_.data(), below);
        return slope(t_, later, later_at_end, earlier, earlier_at_end);
    };
    slopes.col(time()) = (4 * by_time(time_step_) - by_time(2 * time_step_)) / 3;
    return slopes;
}

// Sets the state. Of other rates alone the contact is the same but for its gap rate and slip, which `set_exact` knows.
ContactState Variation::contact_at(double t, const double* y) {
    if (t != t_ || !std::equal(y, y + n_, y_.data())) return system_.contact(t, y);
    system_.set_state(t, y);
    return at_;
}

// Replaces the differences of the gap, and those of its rate and of the slip by ξ̇, by exact slopes: the reset of an
// impact and the delay of a neighbouring touch depend on the same gap.
void Variation::set_exact(Eigen::Ref<Eigen::MatrixXd> geometry) {
    Eigen::RowVectorXd jn(n_), jt(n_);
    system_.set_state(t_, y_.data());
    system_.contact_rows(at_, jn.data(), jt.data());
    const int first = system_.drive().prescribed() ? 1 : 0, free = n_ - first;
    geometry.row(kGap).setZero();
    geometry.row(kGap).segment(first, free) = jn.tail(free);
    geometry(kGap, time()) = at_.gap_rate - jn.tail(free).dot(y_.segment(n_ + first, free));
    geometry.row(kGapRate).segment(n_ + first, free) = jn.tail(free);
    geometry.row(kSlip).segment(n_ + first, free) = jt.tail(free);
}

// ξ̈, of compliant contact with these forces in place of its law's, and the geometry of contact. True: at an end.
bool Variation::acceleration(double t, const double* y, double normal, double friction, Eigen::VectorXd& values) {
    const Phase& phase = system_.phase();
    ContactState c;
    if (!phase.touching) {
        system_.set_state(t, y);
    } else if (phase.held) {
        c = system_.contact(t, y);
    } else {
        c = contact_at(t, y);
        c.force = normal;
        c.friction = friction;
    }
    put(c, values.data() + n_);
    system_.current_acceleration(t, c, values.data());
    return c.at_end;
}

// Of the normal and the friction force, from the slopes of the geometry.
Eigen::MatrixXd Variation::force_slopes(const Eigen::MatrixXd& geometry) const {
    const Phase& phase = system_.phase();
    const NormalLaw& law = system_.normal_law();
    const FrictionLaw& friction = system_.friction();
    const ForceAndSlopes normal = law.at(at_.disc.radius).linearized(-at_.gap, -at_.gap_rate, phase.approach);
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(2, time() + 1);
    slopes.row(0) = -normal.by_depth * geometry.row(kGap) - normal.by_rate * geometry.row(kGapRate);
    slopes(0, approach()) = normal.by_rate * at_.gap_rate / phase.approach;  // δ̇ and δ̇₋ appear as their quotient (S30)
    if (law.hertz_radius > 0) slopes.row(0) += 0.5 * normal.force / at_.disc.radius * geometry.row(kRadius);
    if (friction.none()) return slopes;
    if (!friction.bristle) {
        const double ratio = friction.ratio(at_.slip);
        slopes.row(1) = ratio * slopes.row(0) - friction.resistance(normal.force, ratio) * geometry.row(kSlip);
    } else if (phase.friction == FrictionState::stick) {
        slopes(1, bristle()) = -friction.stiffness;
    } else {
        slopes.row(1) = -FrictionLaw::sign(phase.friction) * friction.kinetic * slopes.row(0);
    }
    return slopes;
}

Eigen::MatrixXd Variation::field() {
    const Phase& phase = system_.phase();
    const Eigen::Index rows = n_ + (system_.has_bristle() ? 1 : 0);
    const Eigen::MatrixXd all = differences(n_ + kGeometry, [&](double t, const double* y, Eigen::VectorXd& values) {
        return acceleration(t, y, at_.force, at_.friction, values);
    });
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(rows, time() + 1);
    slopes.topRows(n_) = all.topRows(n_);
    if (!phase.touching || phase.held) return slopes;
    Eigen::MatrixXd geometry = all.bottomRows(kGeometry);
    set_exact(geometry);
    const Eigen::MatrixXd forces = force_slopes(geometry);
    // ξ̈ is linear in the forces.
    Eigen::VectorXd free(n_ + kGeometry), loaded(n_ + kGeometry);
    acceleration(t_, y_.data(), 0, 0, free);
    for (int k = 0; k < 2; ++k) {
        acceleration(t_, y_.data(), k == 0 ? 1 : 0, k == 0 ? 0 : 1, loaded);
        slopes.topRows(n_) += (loaded - free).head(n_) * forces.row(k);
    }
    if (rows > n_ && phase.friction == FrictionState::stick) slopes.row(n_) = geometry.row(kSlip);
    return slopes;
}

Eigen::MatrixXd Variation::geometry() {
    at_ = system_.contact(t_, y_.data());
    Eigen::MatrixXd slopes = differences(kGeometry, [&](double t, const double* y, Eigen::VectorXd& values) {
        const ContactState c = contact_at(t, y);
        put(c, values.data());
        return c.at_end;
    });
    set_exact(slopes);
    return slopes;
}

Eigen::MatrixXd Variation::contact() {
    const Eigen::MatrixXd all = geometry();
    Eigen::MatrixXd slopes(2, all.cols());
    slopes << all.row(kGap), all.row(kGapRate);
    return slopes;
}
Eigen::MatrixXd Variation::forces() { return force_slopes(geometry()); }

// The slopes of the impulses P_n, P_t by v_n, v_t and the compliance, which are of the speeds' own size: a slow impact
// must remain one.
Eigen::Matrix<double, 2, 5> Variation::impulse_slopes(const Compliance& c, double v_n, double v_t,
                                                      double restitution) const {
    const auto impulses = [&](const Eigen::Vector<double, 5>& x) {
        const ImpactResult r = resolve_impact(Compliance{x[2], x[3], x[4]}, x[0], x[1], system_.friction().kinetic,
                                              restitution, system_.problem().contact.law);
        return Eigen::Vector2d(r.impulse_n, r.impulse_t);
    };
    const Eigen::Vector<double, 5> at{v_n, v_t, c.nn, c.nt, c.tt};
    const Eigen::Vector<double, 5> sizes{v_n, v_t, c.nn, c.nn, c.tt};
    Eigen::Matrix<double, 2, 5> slopes = Eigen::Matrix<double, 2, 5>::Zero();
    for (int k = 0; k < 5; ++k) {
        if (sizes[k] == 0) continue;
        Eigen::Vector<double, 5> above = at, below = at;
        above[k] += kRelativeStep * sizes[k];
        below[k] -= kRelativeStep * sizes[k];
        slopes.col(k) = (impulses(above) - impulses(below)) / (above[k] - below[k]);
    }
    return slopes;
}

Eigen::MatrixXd Variation::impact(double restitution) {
    at_ = system_.contact(t_, y_.data());
    const Compliance compliance = system_.compliance(t_, y_.data(), at_);
    const ImpactResult impact = resolve_impact(compliance, at_.gap_rate, at_.slip, system_.friction().kinetic,
                                               restitution, system_.problem().contact.law);
    const auto rates_after = [&](double t, const double* y, const ContactState& c, double normal, double friction) {
        Eigen::VectorXd after = Eigen::Map<const Eigen::VectorXd>(y, system_.size);
        system_.apply_impact(t, after.data(), c, {normal, friction, c.gap_rate, c.slip});
        return Eigen::VectorXd(after.segment(n_, n_));
    };
    Eigen::MatrixXd all = differences(n_ + kGeometry + 3, [&](double t, const double* y, Eigen::VectorXd& values) {
        const ContactState c = contact_at(t, y);
        const Compliance m = system_.compliance(t, y, c);
        values.head(n_) = rates_after(t, y, c, impact.impulse_n, impact.impulse_t);
        put(c, values.data() + n_);
        values.tail(3) << m.nn, m.nt, m.tt;
        return c.at_end;
    });
    set_exact(all.middleRows(n_, kGeometry));
    const Eigen::MatrixXd impulses =
        impulse_slopes(compliance, at_.gap_rate, at_.slip, restitution) * all.bottomRows(5);
    Eigen::MatrixXd slopes = all.topRows(n_);
    const Eigen::VectorXd before = y_.segment(n_, n_);
    slopes += (rates_after(t_, y_.data(), at_, 1, 0) - before) * impulses.row(0);
    slopes += (rates_after(t_, y_.data(), at_, 0, 1) - before) * impulses.row(1);
    return slopes;
}

}  // namespace beamcam::sim
