#include "sim/orbit/tangent_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/run/constants.hpp"

namespace beamcam::sim {
namespace {

constexpr double kSameInstantRounding = 4e-16;  // of the time: steps that end so near an instant end there

// Rows of tangents beside the coordinates and their rates: z and δ̇₋.
constexpr int kMemories = 2;

constexpr double kPlastic = 1e-9;       // of the approach speed: a slower rebound is none
constexpr int kFlow = kDirections - 1;  // the direction of the motion itself at events
// Touches with this share of difference in speed are one and the same: the gap's rounding was taken out between.
constexpr double kSameSpeed = 1e-9;

void seed(JetState& s, const double* y, const Phase& phase, bool bristle) {
    const std::size_t n = s.xi.size();
    for (std::size_t i = 0; i < n; ++i) {
        s.xi[i] = y[i];
        s.rate[i] = y[n + i];
    }
    s.bristle = bristle ? y[2 * n] : 0;
    s.approach = phase.approach;
}

void seed_column(JetState& s, int direction, const double* column, const double* units) {
    const std::size_t n = s.xi.size();
    for (std::size_t i = 0; i < n; ++i) {
        s.xi[i].d[direction] = column[i] / units[i];
        s.rate[i].d[direction] = column[n + i] / units[n + i];
    }
    s.bristle.d[direction] = column[2 * n] / units[2 * n];
    s.approach.d[direction] = column[2 * n + 1] / units[2 * n + 1];
}

// Rows of one size: √J Ω and √m ω_i of angle and deflections, √J and √m of their rates.
Eigen::VectorXd units_of(System& system) {
    const Problem& problem = system.problem();
    const auto& model = dynamic_cast<const ModalModel&>(system.model());
    const int n = system.coordinates();
    const double spin = problem.cam ? std::fabs(problem.cam->speed) : 0;
    const double swing = std::sqrt(std::fabs(problem.gravity) / problem.beam.length);
    const double inertia = std::sqrt(model.matrices().J), mass = std::sqrt(model.mass());
    Eigen::VectorXd units = Eigen::VectorXd::Constant(2 * n + kMemories, mass);
    units[0] = inertia * std::max({spin, swing, 1e-3});
    units[n] = inertia;
    for (int i = 1; i < n; ++i) units[i] = mass * model.frequency(i - 1);
    if (system.has_bristle()) units[2 * n] = std::sqrt(system.friction().stiffness);
    return units;
}

}  // namespace

// y, tangents column by column, and the energy ledger, as one system.                                           (S70)
class TangentIntegrator::Flow final : public Ode {
  public:
    Flow(System& system, ModalJets& jets, const Eigen::VectorXd& units, int columns)
        : system_(system),
          jets_(jets),
          units_(units),
          rows_(static_cast<int>(units.size())),
          columns_(columns),
          state_(system.coordinates()),
          y_(static_cast<std::size_t>(system.size)),
          dy_(static_cast<std::size_t>(system.size)) {
        controlled = system.controlled + rows_ * columns_;
        size = controlled + kLedgerSize;
    }
    // The system's own components of y.
    void extract(const double* y, double* system) const {
        std::copy_n(y, system_.controlled, system);
        std::copy_n(y + controlled, kLedgerSize, system + system_.controlled);
    }
    void insert(const double* system, double* y) const {
        std::copy_n(system, system_.controlled, y);
        std::copy_n(system + system_.controlled, kLedgerSize, y + controlled);
    }
    int tangents_begin() const { return system_.controlled; }

    void rhs(double t, const double* y, double* dy) override {
        extract(y, y_.data());
        system_.rhs(t, y_.data(), dy_.data());
        insert(dy_.data(), dy);
        if (columns_ == 0) return;
        ContactState near;
        if (system_.phase().touching) near = system_.contact_placed(t, y_.data(), false);
        const int n = system_.coordinates();
        for (int first = 0; first < columns_; first += kDirections) {
            const int count = std::min(kDirections, columns_ - first);
            seed(state_, y_.data(), system_.phase(), system_.has_bristle());
            state_.t = t;
            const double* in = y + tangents_begin() + first * rows_;
            double* out = dy + tangents_begin() + first * rows_;
            for (int k = 0; k < count; ++k) seed_column(state_, k, in + k * rows_, units_.data());
            jets_.flow(state_, system_.phase(), near, acceleration_, bristle_rate_);
            for (int k = 0; k < count; ++k, in += rows_, out += rows_) {
                for (int i = 0; i < n; ++i) {
                    out[i] = in[n + i] / units_[n + i] * units_[i];
                    out[n + i] = acceleration_[static_cast<std::size_t>(i)].d[k] * units_[n + i];
                }
                out[2 * n] = bristle_rate_.d[k] * units_[2 * n];
                out[2 * n + 1] = 0;
            }
        }
    }

  private:
    System& system_;
    ModalJets& jets_;
    const Eigen::VectorXd& units_;
    int rows_, columns_;
    JetState state_;
    std::vector<Jet> acceleration_;
    Jet bristle_rate_;
    std::vector<double> y_, dy_;
};

TangentIntegrator::TangentIntegrator(System& system, double rtol, double atol, const Eigen::MatrixXd& tangents)
    : system_(system),
      probe_(system),
      jets_(system),
      n_(system.coordinates()),
      rows_(2 * n_ + kMemories),
      columns_(static_cast<int>(tangents.cols())),
      units_(units_of(system)),
      tangents_(Eigen::MatrixXd::Zero(rows_, columns_)),
      next_pause_(std::numeric_limits<double>::infinity()) {
    tangents_.topRows(2 * n_) = tangents;
    flow_ = std::make_unique<Flow>(system, jets_, units_, columns_);
    inner_ = make_rk8(*flow_, rtol, atol);
    end_.resize(static_cast<std::size_t>(flow_->size));
    scratch_ = end_;
}

TangentIntegrator::~TangentIntegrator() = default;

// At the start, after an event, and where the drive is not smooth.
void TangentIntegrator::start(double t, const double* y) {
    const Phase is = system_.phase();
    const std::size_t touched = touches_.size();
    if (segment_) {
        if (t != t1) {  // an event at the very start of the last step
            segment_->value(t, end_.data());
            tangents_ = Eigen::Map<const Eigen::MatrixXd>(end_.data() + flow_->tangents_begin(), rows_, columns_);
        }
        saltation(t, y, phase_, is);
    }
    phase_ = is;
    if (is.held && !std::exchange(starts_free_, true)) {
        probe_.set_phase(is);
        near_ = probe_.contact(t, y, true);
        keep_on_cam(t, y);
    }
    flow_->insert(y, end_.data());
    if (pause_ && touches_.size() > touched) next_pause_ = pause_(t);
    std::copy_n(tangents_.data(), tangents_.size(), end_.data() + flow_->tangents_begin());
    inner_->limit_first_step(limited(std::numeric_limits<double>::infinity()));
    inner_->start(t, end_.data());
    t0 = t1 = t;
    segment_ = nullptr;
}

const Segment& TangentIntegrator::step() {
    if (pause_ && t1 >= next_pause_) {
        next_pause_ = pause_(t1);
        std::copy_n(tangents_.data(), tangents_.size(), end_.data() + flow_->tangents_begin());
        inner_->start(t1, end_.data());
    }
    inner_->stop_at(std::min(stop_, next_pause_));
    return arrive(inner_->step());
}

const Segment& TangentIntegrator::shorten(double at) { return arrive(inner_->shorten(at)); }

const Segment& TangentIntegrator::arrive(const Segment& inner) {
    segment_ = &inner;
    t0 = inner.t0;
    t1 = inner.t1;
    inner.value(inner.t1, end_.data());
    tangents_ = Eigen::Map<const Eigen::MatrixXd>(end_.data() + flow_->tangents_begin(), rows_, columns_);
    for (const double stop : {stop_, next_pause_})
        if (std::fabs(t1 - stop) <= kSameInstantRounding * std::fabs(t1)) t1 = stop;
    counters = inner_->counters;
    return *this;
}

void TangentIntegrator::value(double t, double* y) const {
    segment_->value(t == t1 ? segment_->t1 : t, scratch_.data());
    flow_->extract(scratch_.data(), y);
}

// How the tangents pass the event between the state and phase before, still in end_, and those after.
void TangentIntegrator::saltation(double t, const double* after, const Phase& was, const Phase& is) {
    const bool jumps = !std::equal(after + n_, after + 2 * n_, end_.data() + n_);
    if (jumps)
        strike(t, after, was, is);
    else if (!was.touching && is.touching)
        begin_touch(t, was, is);
    else if (was.touching && !is.touching)
        release();
    else if (was.grip != is.grip)
        change_grip(t, after, was, is);
}

// The state before an event as jets: tangents from column `first` on, and in the last direction the motion itself.
JetState TangentIntegrator::event_jets(double t, const Phase& was, Eigen::Index first) {
    std::vector<double> before(static_cast<std::size_t>(probe_.size)), flow(before.size());
    flow_->extract(end_.data(), before.data());
    probe_.set_phase(was);
    probe_.rhs(t, before.data(), flow.data());
    near_ = probe_.contact(t, before.data(), true);
    JetState s(n_);
    seed(s, before.data(), was, probe_.has_bristle());
    s.t = t;
    s.t.d[kFlow] = 1;
    for (std::size_t i = 0; i < s.xi.size(); ++i) {
        s.xi[i].d[kFlow] = flow[i];
        s.rate[i].d[kFlow] = flow[s.xi.size() + i];
    }
    if (probe_.has_bristle()) s.bristle.d[kFlow] = flow[2 * s.xi.size()];
    for (int k = 0; k < kFlow && first + k < columns_; ++k)
        seed_column(s, k, tangents_.col(first + k).data(), units_.data());
    return s;
}

// Ξ v = D_xR v + (D_xR F⁻ + D_tR − F⁺) δt, δt = −D_x g v/ġ                                                       (S71)
void TangentIntegrator::strike(double t, const double* after, const Phase& was, const Phase& is) {
    std::vector<double> flow(static_cast<std::size_t>(probe_.size));
    probe_.set_phase(is);
    probe_.rhs(t, after, flow.data());
    const double rebound = probe_.contact(t, after, true).gap_rate;
    for (Eigen::Index first = 0; first == 0 || first < columns_; first += kFlow) {
        JetState s = event_jets(t, was, first);
        if (first == 0 && -near_.gap_rate > kRestSpeed) touches_.push_back({t, -near_.gap_rate});
        const double pre_set = probe_.problem().contact.restitution;
        const Jet gap = jets_.gap(s, near_).gap;
        jets_.strike(s, near_, !is.held && rebound > -kPlastic * near_.gap_rate ? pre_set : 0);
        for (int k = 0; k < kFlow && first + k < columns_; ++k) {
            const double delay = -gap.d[k] / gap.d[kFlow];
            for (int i = 0; i < n_; ++i) {
                const auto j = static_cast<std::size_t>(i);
                const Jet &xi = s.xi[j], &rate = s.rate[j];
                tangents_(i, first + k) = units_[i] * (xi.d[k] + (xi.d[kFlow] - flow[j]) * delay);
                tangents_(n_ + i, first + k) =
                    units_[n_ + i] * (rate.d[k] + (rate.d[kFlow] - flow[s.xi.size() + j]) * delay);
            }
        }
    }
    tangents_.bottomRows(kMemories).setZero();
    if (!is.held) return;
    ++holds_;
    keep_on_cam(t, after);
}

// Neighbours that rest on the cam have no gap and no gap rate either: rounding of (S71) at a vanishing speed is
// removed.
void TangentIntegrator::keep_on_cam(double t, const double* y) {
    const int freedoms = 2 * n_;
    Eigen::MatrixXd normals(freedoms, 2);  // gradients of gap and gap rate
    const Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(rows_, rows_);
    for (int first = 0; first < freedoms; first += kDirections) {
        JetState s(n_);
        seed(s, y, phase_, false);
        s.t = t;
        const int count = std::min(kDirections, freedoms - first);
        for (int k = 0; k < count; ++k) seed_column(s, k, basis.col(first + k).data(), units_.data());
        const ModalJets::Gap gap = jets_.gap(s, near_);
        for (int k = 0; k < count; ++k) normals.row(first + k) << gap.gap.d[k], gap.rate.d[k];
    }
    normals.col(0).normalize();
    normals.col(1) -= normals.col(0) * normals.col(0).dot(normals.col(1));
    normals.col(1).normalize();
    for (int repeat = 0; repeat < 2; ++repeat)
        tangents_.topRows(freedoms) -= normals * (normals.transpose() * tangents_.topRows(freedoms)).eval();
}

// State and force go on; what the touch keeps is its approach speed, unless that is the floor or an earlier one. (S72)
void TangentIntegrator::begin_touch(double t, const Phase& was, const Phase& is) {
    for (Eigen::Index first = 0; first == 0 || first < columns_; first += kFlow) {
        const JetState s = event_jets(t, was, first);
        if (first == 0 && -near_.gap_rate > kRestSpeed) touches_.push_back({t, -near_.gap_rate});
        const double floor = probe_.problem().contact.approach_floor.value;
        const bool keeps = -near_.gap_rate > floor && is.approach > 0 &&
                           std::fabs(is.approach + near_.gap_rate) < kSameSpeed * is.approach;
        const ModalJets::Gap gap = jets_.gap(s, near_);
        for (int k = 0; k < kFlow && first + k < columns_; ++k) {
            tangents_(2 * n_, first + k) = 0;  // the bristle is relaxed
            double& row = tangents_(rows_ - 1, first + k);
            const double delay = -gap.gap.d[k] / gap.gap.d[kFlow];
            if (keeps) row = -units_[rows_ - 1] * (gap.rate.d[k] + gap.rate.d[kFlow] * delay);
            if (is.approach == floor) row = 0;
        }
    }
}

// Break-away drops the force if the static coefficient is larger; at the catch the bristle is put where it carries the
// sliding force, and its rate goes on. A lagging bristle is a state throughout.                              (S36, S71)
void TangentIntegrator::change_grip(double t, const double* after, const Phase& was, const Phase& is) {
    const FrictionLaw& friction = probe_.friction();
    std::vector<double> flow(static_cast<std::size_t>(probe_.size));
    probe_.set_phase(is);
    probe_.rhs(t, after, flow.data());
    for (Eigen::Index first = 0; first < columns_; first += kFlow) {
        const JetState s = event_jets(t, was, first);
        const ModalJets::Forces f = jets_.forces(s, was, near_);
        std::vector<Jet> acceleration;
        Jet bristle_rate;
        jets_.flow(s, was, near_, acceleration, bristle_rate);
        const Jet guard = friction.limit * f.normal - fabs(f.friction);
        const Jet caught = jets_.sliding_bristle(was.grip, f) - (friction.damping / friction.stiffness) * f.slip;
        for (int k = 0; k < kFlow && first + k < columns_; ++k) {
            double& bristle = tangents_(2 * n_, first + k);
            if (is.grip == Grip::stick) {
                if (!friction.lags) bristle = units_[2 * n_] * caught.d[k];
                continue;
            }
            const double delay = friction.limit > friction.kinetic ? -guard.d[k] / guard.d[kFlow] : 0;
            for (int i = 0; i < n_; ++i) {
                const auto j = static_cast<std::size_t>(i);
                tangents_(n_ + i, first + k) += units_[n_ + i] * (acceleration[j].v - flow[s.xi.size() + j]) * delay;
            }
            bristle = friction.lags ? bristle + units_[2 * n_] * (bristle_rate.v - flow[2 * s.xi.size()]) * delay : 0;
        }
    }
}

// The force has faded: state and flow go on. What the touch kept is forgotten, unless the next one may keep it, too.
void TangentIntegrator::release() {
    tangents_.row(2 * n_).setZero();
    if (probe_.problem().contact.approach_floor.policy == ApproachFloorPolicy::value)
        tangents_.row(2 * n_ + 1).setZero();
}

double TangentIntegrator::inertia_share() const { return jets_.inertia_share(end_.data() + 1); }

Eigen::MatrixXd TangentIntegrator::tangents(bool canonical) const {
    Eigen::MatrixXd all = tangents_;
    if (canonical) all.row(n_) *= inertia_share();
    return all;
}

void TangentIntegrator::set_tangents(const Eigen::MatrixXd& tangents, bool canonical) {
    tangents_ = tangents;
    if (canonical) tangents_.row(n_) /= inertia_share();
}

}  // namespace beamcam::sim
