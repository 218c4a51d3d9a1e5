#include "sim/orbit/saltation.hpp"

#include <algorithm>
#include <cmath>

#include "sim/cam/motion_law.hpp"
#include "sim/contact/chatter.hpp"
#include "sim/dynamics/failure.hpp"
#include "sim/orbit/tangent_step.hpp"

namespace beamcam::sim {
namespace {

constexpr double kSameSpeed = 1e-9;  // relative difference in speed by rounding of the gap at a touch

constexpr int kFlow = kDirections - 1;  // this direction of the jets carries the time derivative of the motion itself

void seed_column(JetState& s, int direction, const double* column, const double* units) {
    const std::size_t n = s.xi.size();
    for (std::size_t i = 0; i < n; ++i) {
        s.xi[i].d[direction] = column[i] / units[i];
        s.rate[i].d[direction] = column[n + i] / units[n + i];
    }
    s.bristle.d[direction] = column[2 * n] / units[2 * n];
    s.approach.d[direction] = column[2 * n + 1] / units[2 * n + 1];
}

}  // namespace

Saltation::Saltation(System& probe, ModalJets& jets, const Eigen::VectorXd& units)
    : probe_(probe), jets_(jets), units_(units), n_(probe_.coordinates()), rows_(2 * n_ + kTangentMemories) {}

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

Eigen::VectorXd Saltation::flow_after(const Instant& at) {
    Eigen::VectorXd flow(probe_.size);
    probe_.set_phase(at.is);
    probe_.rhs(at.t, at.after, flow.data());
    return flow;
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

// The state before an event as jets: the tangents from column `first` on and, in the last direction, the time
// derivative of the motion.
JetState Saltation::jets_before(const Instant& at, const Eigen::MatrixXd& tangents, Eigen::Index first) {
    Eigen::VectorXd flow(probe_.size);
    probe_.set_phase(at.was);
    probe_.rhs(at.t, at.before, flow.data());
    near_ = probe_.contact(at.t, at.before);
    JetState s(probe_, at.t, at.before, at.was);
    s.t.d[kFlow] = 1;
    for (int i = 0; i < n_; ++i) {
        s.xi[static_cast<std::size_t>(i)].d[kFlow] = flow[i];
        s.rate[static_cast<std::size_t>(i)].d[kFlow] = flow[n_ + i];
    }
    if (probe_.has_bristle()) s.bristle.d[kFlow] = flow[2 * n_];
    for (int k = 0; k < kFlow && first + k < tangents.cols(); ++k)
        seed_column(s, k, tangents.col(first + k).data(), units_.data());
    return s;
}

// Ξ v = D_xR v + (D_xR F⁻ + D_tR − F⁺) δt, δt = −D_x g v/ġ                                                       (S71)
void Saltation::impact(const Instant& at, Eigen::MatrixXd& tangents) {
    const Eigen::VectorXd flow = flow_after(at);
    const double rebound = probe_.contact(at.t, at.after).gap_rate;
    for (Eigen::Index first = 0; first == 0 || first < tangents.cols(); first += kFlow) {
        JetState s = jets_before(at, tangents, first);
        const double pre_set = probe_.problem().contact.restitution;
        const Jet gap = jets_.contact(s, near_).gap;
        if (first == 0) record_touch(at);
        jets_.apply_impact(s, near_, !at.is.held && rebound > -kPlastic * near_.gap_rate ? pre_set : 0);
        for (int k = 0; k < kFlow && first + k < tangents.cols(); ++k) {
            const double delay = -gap.d[k] / gap.d[kFlow];
            if (!std::isfinite(delay)) throw StepFailure("a touch without speed has no derivative");
            for (int i = 0; i < n_; ++i) {
                const Jet &xi = s.xi[static_cast<std::size_t>(i)], &rate = s.rate[static_cast<std::size_t>(i)];
                tangents(i, first + k) = units_[i] * (xi.d[k] + (xi.d[kFlow] - flow[i]) * delay);
                tangents(n_ + i, first + k) = units_[n_ + i] * (rate.d[k] + (rate.d[kFlow] - flow[n_ + i]) * delay);
            }
        }
    }
    tangents.bottomRows(kTangentMemories).setZero();
    if (!at.is.held) return;
    ++holds_;
    keep_on_cam(at.t, at.after, tangents);
}

// Neighbouring motions in sustained contact have neither a gap nor a gap rate. Projecting both out of the tangents also
// removes the rounding errors of (S71) at a vanishing speed.
void Saltation::keep_on_cam(double t, const double* y, Eigen::MatrixXd& tangents) {
    const int freedoms = 2 * n_;
    Eigen::MatrixXd normals(freedoms, 2);  // gradients of gap and gap rate
    const Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(rows_, rows_);
    for (int first = 0; first < freedoms; first += kDirections) {
        JetState s(probe_, t, y, Phase{});
        const int count = std::min(kDirections, freedoms - first);
        for (int k = 0; k < count; ++k) seed_column(s, k, basis.col(first + k).data(), units_.data());
        const ContactKinematics<Jet>& contact = jets_.contact(s, near_);
        for (int k = 0; k < count; ++k) normals.row(first + k) << contact.gap.d[k], contact.gap_rate.d[k];
    }
    normals.col(0).normalize();
    normals.col(1) -= normals.col(0) * normals.col(0).dot(normals.col(1));
    normals.col(1).normalize();
    for (int repeat = 0; repeat < 2; ++repeat)
        tangents.topRows(freedoms) -= normals * (normals.transpose() * tangents.topRows(freedoms)).eval();
}

// State and force are continuous at a compliant touch. A new variable is its approach speed, unless that is the floor
// or the speed of an earlier touch. (S72)
void Saltation::begin_touch(const Instant& at, Eigen::MatrixXd& tangents) {
    for (Eigen::Index first = 0; first == 0 || first < tangents.cols(); first += kFlow) {
        JetState s = jets_before(at, tangents, first);
        const double floor = probe_.problem().contact.approach_floor.value;
        const bool keeps = -near_.gap_rate > floor && at.is.approach > 0 &&
                           std::fabs(at.is.approach + near_.gap_rate) < kSameSpeed * at.is.approach;
        const ContactKinematics<Jet>& contact = jets_.contact(s, near_);
        if (first == 0) record_touch(at);
        for (int k = 0; k < kFlow && first + k < tangents.cols(); ++k) {
            tangents(2 * n_, first + k) = 0;  // the bristle starts without deflection
            double& row = tangents(rows_ - 1, first + k);
            const double delay = -contact.gap.d[k] / contact.gap.d[kFlow];
            if (keeps) row = -units_[rows_ - 1] * (contact.gap_rate.d[k] + contact.gap_rate.d[kFlow] * delay);
            if (at.is.approach == floor) row = 0;
        }
    }
}

// At break-away the friction force drops if μ_s > μ. When the bristle sticks again, its deflection is that of the
// sliding force and its rate is continuous. (S36), (S71)
void Saltation::change_friction(const Instant& at, Eigen::MatrixXd& tangents) {
    const FrictionLaw& friction = probe_.friction();
    const Eigen::VectorXd flow = flow_after(at);
    for (Eigen::Index first = 0; first < tangents.cols(); first += kFlow) {
        JetState s = jets_before(at, tangents, first);
        const ModalJets::Forces f = jets_.forces(s, at.was, near_);
        std::vector<Jet> acceleration;
        Jet bristle_rate;
        jets_.flow(s, at.was, near_, acceleration, bristle_rate);
        const Jet guard = friction.limit * f.normal - fabs(f.friction);
        const Jet caught = jets_.sliding_bristle(at.was.friction, f);
        for (int k = 0; k < kFlow && first + k < tangents.cols(); ++k) {
            double& bristle = tangents(2 * n_, first + k);
            if (at.is.friction == FrictionState::stick) {
                bristle = units_[2 * n_] * caught.d[k];
                continue;
            }
            const double delay = friction.limit > friction.kinetic ? -guard.d[k] / guard.d[kFlow] : 0;
            for (int i = 0; i < n_; ++i)
                tangents(n_ + i, first + k) +=
                    units_[n_ + i] * (acceleration[static_cast<std::size_t>(i)].v - flow[n_ + i]) * delay;
            bristle = 0;
        }
    }
}

// The force is zero at the release: state and flow are continuous. The approach speed is dropped, unless the next touch
// may use it, too.
void Saltation::release(Eigen::MatrixXd& tangents) {
    tangents.row(2 * n_).setZero();
    if (probe_.problem().contact.approach_floor.policy == ApproachFloorPolicy::value)
        tangents.row(2 * n_ + 1).setZero();
}

}  // namespace beamcam::sim
