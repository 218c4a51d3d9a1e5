#include "sim/orbit/tangent_integrator.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/orbit/constants.hpp"

namespace beamcam::sim {
namespace {

// √J Ω and √m ω_i of angle and deflections, √J and √m of their rates: each row is then the root of an energy.
Eigen::VectorXd units_of(System& system) {
    const Problem& problem = system.problem();
    const auto& model = dynamic_cast<const ModalModel&>(system.model());
    const int n = system.coordinates();
    const double speed = problem.cam ? std::fabs(problem.cam->speed) : 0;
    const double pendulum = std::sqrt(std::fabs(problem.gravity) / problem.beam.length);
    const double inertia = std::sqrt(model.matrices().J), mass = std::sqrt(model.mass());
    Eigen::VectorXd units = Eigen::VectorXd::Constant(2 * n + kTangentMemories, mass);
    units[0] = inertia * std::max({speed, pendulum, kSlowestMotion});
    units[n] = inertia;
    for (int i = 1; i < n; ++i) units[i] = mass * model.frequency(i - 1);
    if (system.has_bristle()) units[2 * n] = std::sqrt(system.friction().stiffness);
    return units;
}

}  // namespace

TangentIntegrator::TangentIntegrator(System& system, std::unique_ptr<Integrator> motion, double rtol,
                                     const Eigen::MatrixXd& tangents, const Progress& progress)
    : system_(system),
      probe_(system),
      jets_(system),
      motion_(std::move(motion)),
      n_(system.coordinates()),
      units_(units_of(system)),
      tangents_(Eigen::MatrixXd::Zero(2 * n_ + kTangentMemories, tangents.cols())),
      y_(static_cast<std::size_t>(system.size)),
      tangent_step_(probe_, jets_, units_, rtol, progress),
      saltation_(system, jets_, units_) {
    tangents_.topRows(2 * n_) = tangents;
}

// Called at the beginning, after an event, and where the drive is not smooth.
void TangentIntegrator::start(double t, const double* y) {
    const Phase is = system_.phase();
    const std::size_t touched = touches().size();
    if (segment_) {
        advance(t);
        saltation_.pass(t, y_.data(), phase_, y, is, tangents_);
    }
    if (std::exchange(starts_kept_, false) && is.held) saltation_.start_on_cam(t, y, is, tangents_);
    phase_ = is;
    t_ = t;
    std::copy_n(y, y_.size(), y_.begin());
    tangent_step_.begin(is);
    if (pause_ && touches().size() > touched) next_pause_ = pause_(t);
    segment_ = nullptr;
    motion_->limit_first_step(limited(std::numeric_limits<double>::infinity()));
    motion_->start(t, y);
    counters = motion_->counters;
}

const Segment& TangentIntegrator::step() {
    if (segment_) advance(segment_->t1);
    motion_->stop_at(std::min(stop_, end_));
    return accept(motion_->step());
}

// The tangents advance once the step is final.
const Segment& TangentIntegrator::shorten(double at) { return accept(motion_->shorten(at)); }

const Segment& TangentIntegrator::accept(const Segment& segment) {
    segment_ = &segment;
    counters = motion_->counters;
    return segment;
}

void TangentIntegrator::advance(double t) {
    while (t_ < t) {
        const double to = std::min(t, next_pause_);
        if (to > t_) tangent_step_.advance(*segment_, t_, to, tangents_);
        t_ = to;
        segment_->value(t_, y_.data());
        if (pause_ && t_ >= next_pause_) next_pause_ = pause_(t_);
    }
    segment_->value(t, y_.data());
}

void TangentIntegrator::finish(double t) try {
    if (segment_) advance(t);
} catch (const StepFailure& failure) {
    throw SolverError(failure.what(), t_, {});
}

double TangentIntegrator::inertia_share() const { return jets_.inertia_share(y_.data() + 1); }

Eigen::MatrixXd TangentIntegrator::tangents(bool canonical) const {
    Eigen::MatrixXd all = tangents_;
    if (canonical) all.row(n_) *= inertia_share();
    return all;
}

Eigen::MatrixXd TangentIntegrator::factor() {
    const Eigen::Index columns = tangents_.cols();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(tangents_);
    tangents_ = qr.householderQ() * Eigen::MatrixXd::Identity(tangents_.rows(), columns);
    return qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
}

void TangentIntegrator::set_canonical(const Eigen::MatrixXd& tangents) {
    tangents_ = tangents;
    tangents_.row(n_) /= inertia_share();
}

}  // namespace beamcam::sim
