#include "sim/observe/channel_evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace beamcam::sim {

ChannelEvaluator::ChannelEvaluator(const System& system)
    : system_(system), probe_(system_), y_(static_cast<std::size_t>(system_.size)) {}

void ChannelEvaluator::set(double t, const double* y) {
    t_ = t;
    std::copy_n(y, y_.size(), y_.begin());
    placed_ = balance_known_ = contact_known_ = acceleration_known_ = loads_known_ = largest_known_ = false;
}

Model& ChannelEvaluator::model() {
    if (!placed_) system_.set_state(t_, y_.data());
    placed_ = true;
    return system_.model();
}

const ContactState& ChannelEvaluator::contact() {
    if (!contact_known_) contact_ = probe_.evaluate(t_, y_.data());
    contact_known_ = true;
    return contact_;
}

const System::EnergyBalance& ChannelEvaluator::energy_balance() {
    if (!balance_known_) {
        balance_ =
            system_.balance_without_beam(y_.data(), system_.contact_stores_energy() ? contact() : ContactState{});
        balance_.energies = model().energies();
        balance_.spring = spring_energy();
        balance_known_ = true;
    }
    return balance_;
}

// Of the coordinates, or of the rates that follow them in the state; y_[0] and y_[n] are those of the hub.
double ChannelEvaluator::component(int index, int first) const {
    return index < system_.coordinates() ? y_[static_cast<std::size_t>(first + index)] : kNan;
}

// A prescribed hub has the angle of its drive; that of another one does not need the model's state.
double ChannelEvaluator::hub_angle() {
    if (system_.drive().prescribed()) return model().hub_angle();
    const double* row = system_.model().hub_row();
    return std::inner_product(row, row + system_.coordinates(), y_.begin(), 0.0);
}

double ChannelEvaluator::value(Channel channel) {
    if (traits(channel.kind).needs_cam && !system_.has_cam()) return kNan;
    switch (channel.kind) {
        case ChannelKind::t:
            return t_;
        case ChannelKind::q:
            return component(channel.index, 0);
        case ChannelKind::theta:
            return hub_angle();
        case ChannelKind::q_dot:
            return component(channel.index, system_.coordinates());
        case ChannelKind::theta_dot:
            return model().hub_rate();
        case ChannelKind::tip_deflection:
        case ChannelKind::tip_rate:
            return tip(channel.kind);
        case ChannelKind::contact_force:
            return system_.phase().touching ? std::max(0.0, contact().force) : 0;  // of a constraint less is rounding
        case ChannelKind::friction_force:
            return system_.phase().touching ? contact().friction : 0;
        case ChannelKind::gap:
            return contact().gap;
        case ChannelKind::contact_x:
            return contact().x;
        case ChannelKind::contact_s:
            return place_on_rim();
        case ChannelKind::cam_angle:
            return system_.cam().angle(t_);
        case ChannelKind::energy_kinetic:
            return energy_balance().energies.kinetic;
        case ChannelKind::energy_potential:
            return energy_balance().energies.gravity;
        case ChannelKind::energy_elastic:
            return energy_balance().energies.elastic;
        case ChannelKind::energy_contact:
            return energy_balance().contact;
        case ChannelKind::energy_spring:
            return spring_energy();
        case ChannelKind::loss_hub:
            return ledger(kLossHub);
        case ChannelKind::loss_structural:
            return ledger(kLossStructural);
        case ChannelKind::loss_contact:
            return energy_balance().loss_contact;
        case ChannelKind::loss_friction:
            return energy_balance().loss_friction;
        case ChannelKind::work_cam:
            return ledger(kWorkCam);
        case ChannelKind::work_drive:
            return ledger(kWorkDrive);
        case ChannelKind::energy_residual:
            return energy_balance().total() - start_total_;
        case ChannelKind::root_moment:
            return root_moment();
        case ChannelKind::stress_max:
        case ChannelKind::stress_x:
            return stress(channel.kind);
        case ChannelKind::pivot_force:
        case ChannelKind::pivot_angle:
            return pivot(channel.kind);
        case ChannelKind::tip_acceleration:
            return norm(point_acceleration(model(), acceleration(), model().length()));
        case ChannelKind::drive_power:
            return drive_power();
        case ChannelKind::theta_follow:
            return followed_angle();
        case ChannelKind::lift_error:
            return model().hub_angle() - followed_angle();
        case ChannelKind::separation:
        case ChannelKind::separation_paper:
            return separation(channel.kind);
    }
    return kNan;
}

double ChannelEvaluator::spring_energy() {
    return system_.spring() ? system_.spring()->energy(model().hub_angle()) : 0;
}

// (S106)
double ChannelEvaluator::followed_angle() {
    if (!lever_) lever_.emplace(system_.problem());
    return lever_->at(-system_.cam().angle(t_)).motion.theta;
}

// Across the tangent at the root, which is the hub's direction (S6).
double ChannelEvaluator::tip(ChannelKind kind) {
    const Model& beam = model();
    BeamPoint tip, root;
    beam.point(beam.length(), tip);
    beam.point(0, root);
    const Vec2 along = unit(beam.hub_angle()), across = perp(along), span = tip.r - root.r;
    if (kind == ChannelKind::tip_deflection) return dot(span, across);
    return dot(tip.v - root.v, across) - beam.hub_rate() * dot(span, along);
}

// Along the rim from the mark, in the sense in which angles grow.
double ChannelEvaluator::place_on_rim() { return system_.cam().place(t_, contact().normal); }

// The paper's eq. (6) and the same with the sign that N ≥ 0 gives: J θ̈ = N x − ½mgL cos θ (S41).
double ChannelEvaluator::separation(ChannelKind kind) {
    const Model& beam = model();
    const ContactState c = contact();
    const double acceleration = hub_acceleration();
    BeamPoint p, root;
    beam.point(c.x, p);
    beam.point(0, root);
    const Vec2 along = unit(beam.hub_angle()), span = p.r - root.r;
    const double deflection = dot(span, perp(along)), arm = std::hypot(c.x, deflection);
    const double pull = 3 * c.x * system_.problem().gravity * std::cos(beam.hub_angle()) / (2 * beam.length());
    return acceleration * arm + (kind == ChannelKind::separation ? pull : -pull);
}

const double* ChannelEvaluator::acceleration() {
    if (acceleration_known_) return acceleration_;
    model();
    const ContactState c = system_.phase().touching ? contact() : ContactState{};
    drive_power_ = system_.current_acceleration(t_, c, acceleration_);
    acceleration_known_ = true;
    return acceleration_;
}

const NaturalModes& ChannelEvaluator::natural_modes() {
    if (!natural_modes_) natural_modes_.emplace(system_.model(), system_.problem());
    return *natural_modes_;
}

double ChannelEvaluator::hub_acceleration() {
    const double *row = model().hub_row(), *acc = acceleration();
    double total = 0;
    for (int i = 0; i < system_.coordinates(); ++i) total += row[i] * acc[i];
    return total;
}

const BeamLoads& ChannelEvaluator::loads() {
    if (!loads_) loads_.emplace(system_.problem(), system_.model());
    if (!loads_known_) {
        const double* acc = acceleration();
        loads_->set(model(), acc, system_.phase().touching ? &contact() : nullptr);
        loads_known_ = true;
    }
    return *loads_;
}

// The part of the contact force that the bent beam resists: the static load that fits the elastic forces of its natural
// modes best, F − m Σ J_i z̈_i/Σ J_i², between 0 and F                                                  (S98)
double ChannelEvaluator::resisted_force() {
    const Model& beam = model();
    const Eigen::Index n = system_.coordinates();
    if (n == 1) return contact().force;
    const Eigen::Map<const Eigen::VectorXd> acc(acceleration(), n);
    const ContactState& c = contact();
    Eigen::VectorXd jx(n), jy(n), jchi(n);
    beam.jacobian(c.x, jx.data(), jy.data(), jchi.data());
    const NaturalModes& modes = natural_modes();
    const Eigen::VectorXd row = modes.shapes.transpose() * (c.normal.x * jx + c.normal.y * jy), z = modes.inverse * acc;
    const double moved = row.tail(n - 1).dot(z.tail(n - 1)), size = row.tail(n - 1).squaredNorm();
    return std::clamp(c.force - (size > 0 ? beam.mass() * moved / size : 0), 0.0, std::max(0.0, c.force));
}

// The loads with that part of the contact force, and with the acceleration that it would cause.
const BeamLoads& ChannelEvaluator::resisted_loads() {
    const BeamLoads& all = loads();
    if (!system_.phase().touching) return all;
    ContactState c = contact();
    const double resisted = resisted_force();
    if (!(resisted < c.force)) return all;
    c.friction *= resisted / c.force;
    c.force = resisted;
    double acc[kMaxSize];
    system_.current_acceleration(t_, c, acc);
    if (!resisted_loads_) resisted_loads_.emplace(system_.problem(), system_.model());
    resisted_loads_->set(model(), acc, &c);
    return *resisted_loads_;
}

// σ = |M| c_max/I                                                                                     (S98)
double ChannelEvaluator::stress(ChannelKind kind) {
    if (!largest_known_) largest_moment_ = resisted_loads().largest_moment();
    largest_known_ = true;
    if (kind == ChannelKind::stress_x) return largest_moment_.x;
    const SectionProperties section = section_properties(system_.problem().beam);
    return largest_moment_.y * section.c_max / section.second_moment;
}

// A hub that turns freely has the balance I_h θ̈ = τ + M(0) + a e × S, S the force of the beam on it (S96)
double ChannelEvaluator::root_moment() {
    if (system_.drive().prescribed()) return loads().moment(0);
    const Hub& hub = system_.problem().hub;
    const double across = hub.radius > 0 ? dot(perp(unit(model().hub_angle())), loads().pivot_force()) : 0;
    return hub.inertia * hub_acceleration() - system_.hub_torque(t_) + hub.radius * across;
}

double ChannelEvaluator::pivot(ChannelKind kind) {
    const Vec2 force = loads().pivot_force();
    return kind == ChannelKind::pivot_force ? norm(force) : std::atan2(force.y, force.x);
}

double ChannelEvaluator::drive_power() {
    acceleration();
    return drive_power_;
}

Pose ChannelEvaluator::pose(int stations) {
    const Model& beam = model();
    Pose pose;
    pose.t = t_;
    pose.theta = beam.hub_angle();
    pose.theta_dot = beam.hub_rate();
    pose.centreline.reserve(static_cast<std::size_t>(stations));
    pose.moment.reserve(static_cast<std::size_t>(stations));
    for (int i = 0; i < stations; ++i) {
        const double x = beam.length() * i / (stations - 1);
        BeamPoint p;
        beam.point(x, p);
        pose.centreline.push_back(p.r);
        pose.moment.push_back(beam.bending_moment(x));
    }
    if (!system_.has_cam()) return pose;
    const TurningCam& cam = system_.cam();
    const ContactState& c = contact();
    pose.cam_centre = cam.axis();
    pose.disc_centre = c.disc.centre;
    pose.disc_radius = c.disc.radius;
    pose.cam_angle = cam.angle(t_);
    Nearest nearest;
    nearest.x = c.x;
    nearest.s = value({ChannelKind::contact_s});
    nearest.point = c.disc.centre + c.disc.radius * c.normal;
    nearest.normal = c.normal;
    nearest.gap = c.gap;
    nearest.force = c.force;
    nearest.friction = c.friction;
    nearest.touching = system_.phase().touching;
    pose.nearest = nearest;
    return pose;
}

}  // namespace beamcam::sim
