#include "sim/orbit/tangents.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

namespace beamcam::sim {
namespace {

// √J Ω and √m ω_i of angle and deflections, √J and √m of their rates: each row is then the root of an energy.
Eigen::VectorXd units_of(System& system) {
    const int n = system.coordinates();
    const Eigen::VectorXd inertia = system.model().linearize().mass.diagonal().cwiseSqrt();
    Eigen::VectorXd units = Eigen::VectorXd::Constant(2 * n + kTangentMemories, inertia[n - 1]);
    units[0] = inertia[0] * typical_rate(system.problem());
    units.segment(n, n) = inertia;
    for (int i = 1; i < n; ++i) units[i] = inertia[i] * system.model().frequency(i - 1);
    if (system.has_bristle()) units[2 * n] = std::sqrt(system.friction().stiffness);
    return units;
}

// M of the straight beam. A prescribed hub has none.
Eigen::MatrixXd inertia_of(System& system) {
    Eigen::MatrixXd mass = system.model().linearize().mass;
    if (!system.drive().prescribed()) return mass;
    mass.row(0).setZero();
    mass.col(0).setZero();
    mass(0, 0) = 1;
    return mass;
}

}  // namespace

Tangents::Tangents(const System& system, double end, double rtol, const Eigen::MatrixXd& tangents,
                   const Progress& progress)
    : probe_(system),
      variation_(probe_),
      inertia_(inertia_of(probe_)),
      n_(probe_.coordinates()),
      units_(units_of(probe_)),
      tangents_(Eigen::MatrixXd::Zero(2 * n_ + kTangentMemories, tangents.cols())),
      y_(static_cast<std::size_t>(probe_.size)),
      tangent_step_(probe_, variation_, units_, rtol, progress),
      saltation_(probe_, variation_, units_),
      end_(end) {
    tangents_.topRows(2 * n_) = tangents;
}

void Tangents::resume(double t, const std::vector<double>& y, const Phase& phase) {
    const std::size_t touched = touches().size();
    if (std::exchange(begun_, true)) saltation_.pass(t, y_.data(), phase_, y.data(), phase, tangents_);
    if (std::exchange(starts_kept_, false) && phase.held) saltation_.start_on_cam(t, y.data(), phase, tangents_);
    phase_ = phase;
    t_ = t;
    y_ = y;
    tangent_step_.begin(phase);
    if (pause_ && touches().size() > touched) next_pause_ = pause_(t);
}

void Tangents::step(const SegmentInterval& s) {
    std::vector<double> end(y_.size());
    s.segment->value(s.to, end.data());
    saltation_.require_curvature(t_, y_.data(), s.to, end.data(), phase_);
    while (t_ < s.to) {
        const double to = std::min(s.to, next_pause_);
        if (to > t_) tangent_step_.advance(*s.segment, t_, to, tangents_);
        t_ = to;
        s.segment->value(t_, y_.data());
        if (pause_ && t_ >= next_pause_) next_pause_ = pause_(t_);
    }
    y_ = std::move(end);
}

double Tangents::inertia_share() {
    Model& model = probe_.model();
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(n_, n_);
    Eigen::VectorXd forces(n_);
    probe_.set_state(t_, y_.data());
    model.assemble(forces.data());
    const bool held = probe_.drive().prescribed();
    for (int i = held ? 1 : 0; i < n_; ++i)
        held ? void(model.solve_held(inverse.col(i).data(), 0)) : model.solve(inverse.col(i).data());
    return 1 / (inertia_ * inverse).determinant();
}

Eigen::MatrixXd Tangents::tangents(bool canonical) {
    Eigen::MatrixXd all = tangents_;
    if (canonical) all.row(n_) *= inertia_share();
    return all;
}

Eigen::MatrixXd Tangents::factor() {
    const Eigen::Index columns = tangents_.cols();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(tangents_);
    tangents_ = qr.householderQ() * Eigen::MatrixXd::Identity(tangents_.rows(), columns);
    return qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
}

void Tangents::set_canonical(const Eigen::MatrixXd& tangents) {
    tangents_ = tangents;
    tangents_.row(n_) /= inertia_share();
}

}  // namespace beamcam::sim
