#include "sim/orbit/saltation.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/cam/motion_law.hpp"
#include "sim/contact/chatter.hpp"
#include "sim/dynamics/failure.hpp"
#include "sim/orbit/tangent_step.hpp"

namespace beamcam::sim {

Saltation::Saltation(System& probe, Variation& variation, const Eigen::VectorXd& units)
    : probe_(probe), variation_(variation), units_(units), n_(probe_.coordinates()), rows_(2 * n_ + kTangentMemories) {}

void Saltation::pass(double t, const double* before, const Phase& was, const double* after, const Phase& is,
                     Eigen::MatrixXd& tangents) {
    const Instant at{t, before, after, was, is};
    if (was.held && !is.touching) ++lifts_;
    // Only impacts change rates. One whose impulse vanishes in their rounding grazes the cam and is passed over (S71).
    const bool jumps = !std::equal(after + n_, after + 2 * n_, before + n_);
    if (jumps)
        impact(at, tangents);
    else if (!was.touching && is.touching)
        begin_touch(at, tangents);
    else if (was.touching && !is.touching)
        release(tangents);
    else if (was.friction != is.friction)
        change_friction(at, tangents);
    if (!is.touching && (jumps || was.touching)) left_ = t;
}

void Saltation::start_on_cam(double t, const double* y, const Phase& is, Eigen::MatrixXd& tangents) {
    probe_.set_phase(is);
    near_ = probe_.contact(t, y);
    keep_on_cam(t, y, tangents);
}

// The time derivative of the motion: of the rows of tangents, and of the time.
Eigen::VectorXd Saltation::flow(double t, const double* y, const Phase& phase) {
    Eigen::VectorXd rates(probe_.size), out = Eigen::VectorXd::Zero(rows_ + 1);
    probe_.set_phase(phase);
    probe_.rhs(t, y, rates.data());
    out.head(2 * n_) = rates.head(2 * n_);
    if (probe_.has_bristle()) out[variation_.bristle()] = rates[2 * n_];
    out[variation_.time()] = 1;
    return out;
}

Eigen::MatrixXd Saltation::in_si(const Eigen::MatrixXd& tangents) const {
    return units_.cwiseInverse().asDiagonal() * tangents;
}

// Where ρ jumps, so does the force of sustained contact, and the tangents with it by what neighbours arrive later.
void Saltation::require_curvature(double t, const double* y, double to, const double* end, const Phase& phase) {
    constexpr double kSide = 1e-6, kJump = 1e-4;  // [rad]; of ρ, far more than it changes in between
    const TurningCam& cam = probe_.cam();
    if (!phase.held || n_ == 1 || cam.shape().kinks().empty()) return;
    probe_.set_phase(phase);
    const double from = cam.alpha(t, probe_.contact(t, y).normal),
                 turned = std::remainder(cam.alpha(to, probe_.contact(to, end).normal) - from, kFullTurn);
    for (const double kink : cam.shape().kinks()) {
        const double share = std::remainder(kink - from, kFullTurn) / turned, radius = cam.shape().at(kink).radius;
        const double jump = cam.shape().at(kink + kSide).radius - cam.shape().at(kink - kSide).radius;
        if (share >= 0 && share <= 1 && std::fabs(jump) > kJump * radius)
            throw RunStopped(
                Stop::refused,
                "tangents are not known where sustained contact passes a jump of the cam's radius of curvature: use "
                "compliant contact, or a profile whose curvature does not jump");
    }
}

// At the contact near_, in the state before the touch. Beyond an end of the beam the foot is on its straight extension.
void Saltation::record_touch(const Instant& at) {
    if (!(-near_.gap_rate > kRestSpeed)) return;
    BeamPoint p;
    probe_.model().point(near_.x, p);
    const double beyond = -dot(p.r1, p.r - near_.disc.centre) / dot(p.r1, p.r1);
    touches_.push_back({at.t, -near_.gap_rate, at.t - left_, near_.x, near_.x + beyond - probe_.problem().beam.length});
}

// Ξ v = D_xR v + (D_xR F⁻ + D_tR − F⁺) δt, δt = −D_x g v/ġ                                                       (S71)
void Saltation::impact(const Instant& at, Eigen::MatrixXd& tangents) {
    const double rebound = probe_.contact(at.t, at.after).gap_rate, pre_set = probe_.problem().contact.restitution;
    probe_.set_phase(at.was);
    near_ = probe_.contact(at.t, at.before);
    record_touch(at);
    if (!(near_.gap_rate < 0)) throw StepFailure("a touch without speed has no derivative");
    const bool bounces = !at.is.held && rebound > -kNegligible * near_.gap_rate;
    variation_.set(at.t, at.before, at.was);
    const Eigen::MatrixXd gap = variation_.contact().row(0), reset = variation_.impact(bounces ? pre_set : 0);
    const Eigen::VectorXd before = flow(at.t, at.before, at.was), after = flow(at.t, at.after, at.is);
    const Eigen::MatrixXd v = in_si(tangents), delay = -gap.leftCols(rows_) * v / near_.gap_rate;
    tangents.topRows(n_) = v.topRows(n_) + (before - after).head(n_) * delay;
    tangents.middleRows(n_, n_) = reset.leftCols(rows_) * v + (reset * before - after.segment(n_, n_)) * delay;
    tangents.bottomRows(kTangentMemories).setZero();
    tangents = units_.asDiagonal() * tangents;
    if (!at.is.held) return;
    ++holds_;
    keep_on_cam(at.t, at.after, tangents);
}

// Neighbouring motions in sustained contact have neither a gap nor a gap rate. Projecting both out of the tangents also
// removes the rounding errors of (S71) at a vanishing speed.
void Saltation::keep_on_cam(double t, const double* y, Eigen::MatrixXd& tangents) {
    const int freedoms = 2 * n_;
    variation_.set(t, y, Phase{});
    // Gradients of gap and gap rate.
    Eigen::MatrixXd normals = in_si(variation_.contact().leftCols(rows_).transpose()).topRows(freedoms);
    normals.col(0).normalize();
    normals.col(1) -= normals.col(0) * normals.col(0).dot(normals.col(1));
    normals.col(1).normalize();
    for (int repeat = 0; repeat < 2; ++repeat)
        tangents.topRows(freedoms) -= normals * (normals.transpose() * tangents.topRows(freedoms)).eval();
}

// State and force are continuous at a compliant touch. A new variable is its approach speed, unless that is the floor
// or the speed of an earlier touch. (S72)
void Saltation::begin_touch(const Instant& at, Eigen::MatrixXd& tangents) {
    probe_.set_phase(at.was);
    near_ = probe_.contact(at.t, at.before);
    record_touch(at);
    const double floor = probe_.problem().contact.approach_floor.value;
    const bool keeps = -near_.gap_rate > floor && probe_.normal_law().damping > 0 &&
                       std::fabs(at.is.approach + near_.gap_rate) < kNegligible * at.is.approach;
    const Eigen::Index bristle = variation_.bristle(), approach = variation_.approach();
    if (keeps) {
        variation_.set(at.t, at.before, at.was);
        const Eigen::MatrixXd contact = variation_.contact(), v = in_si(tangents),
                              change = contact.leftCols(rows_) * v;  // of gap and gap rate
        const double acceleration = contact.row(1) * flow(at.t, at.before, at.was);
        tangents.row(approach) = -units_[approach] * (change.row(1) - change.row(0) * (acceleration / near_.gap_rate));
    }
    tangents.row(bristle).setZero();  // it starts without deflection
    if (at.is.approach == floor) tangents.row(approach).setZero();
}

// At break-away the friction force drops if μ_s > μ. When the bristle sticks again, its deflection is that of the
// sliding force and its rate is continuous. (S36), (S71)
void Saltation::change_friction(const Instant& at, Eigen::MatrixXd& tangents) {
    const FrictionLaw& friction = probe_.friction();
    const Eigen::VectorXd before = flow(at.t, at.before, at.was);
    near_ = probe_.contact(at.t, at.before);
    variation_.set(at.t, at.before, at.was);
    const Eigen::MatrixXd forces = variation_.forces(), v = in_si(tangents);
    const Eigen::Index bristle = variation_.bristle();
    if (at.is.friction == FrictionState::stick) {
        const double per_newton = friction.sliding_bristle(at.was.friction, 1);
        tangents.row(bristle) = units_[bristle] * per_newton * forces.row(0).head(rows_) * v;
        return;
    }
    tangents.row(bristle).setZero();
    if (!(friction.limit > friction.kinetic)) return;
    const double sign = near_.friction < 0 ? -1 : 1;
    const Eigen::RowVectorXd guard = friction.limit * forces.row(0) - sign * forces.row(1);
    const Eigen::VectorXd jump = (before - flow(at.t, at.after, at.is)).segment(n_, n_);
    const Eigen::RowVectorXd delay = -guard.head(rows_) * v / guard.dot(before);
    tangents.middleRows(n_, n_) += units_.segment(n_, n_).asDiagonal() * jump * delay;
}

// The force is zero at the release: state and flow are continuous. The approach speed is dropped, unless the next touch
// may use it, too.
void Saltation::release(Eigen::MatrixXd& tangents) {
    tangents.row(2 * n_).setZero();
    if (probe_.problem().contact.approach_floor.policy == ApproachFloorPolicy::value)
        tangents.row(2 * n_ + 1).setZero();
}

}  // namespace beamcam::sim
