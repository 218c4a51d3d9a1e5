#include "sim/orbit/section_map.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/base/linear_algebra.hpp"
#include "sim/orbit/constants.hpp"

namespace beamcam::sim {

Problem at_section(Problem problem, double section) {
    problem.cam->phase = section;
    return problem;
}

Problem for_orbits(Problem problem) {
    problem = with_tight_tolerance(std::move(problem));
    problem.solver.method = Method::automatic;
    problem.solver.max_steps = std::min(problem.solver.max_steps, kMaxMapSteps);
    return problem;
}

SectionScale section_scale(const Problem& problem, const PeriodicOrbit& orbit, const Progress& progress) {
    const FlowMap map = flow_map(at_section(problem, orbit.section), orbit.start, orbit.period, progress);
    return {difference_units(problem), motion_size(problem, map, orbit.start)};
}

SectionMap::SectionMap(const Problem& problem, double section, int turns, InitialState like, const SectionScale& scale,
                       Progress progress)
    : problem_(at_section(problem, section)),
      section_(section),
      cam_phase_(section_phase(problem, section)),
      period_(turns * cam_period(problem)),
      turns_(turns),
      like_(std::move(like)),
      n_(scale.units.size() - kMemories + (like_.phase.touching && System(problem).has_bristle() ? 1 : 0)),
      scale_(scale.size / scale.units.array()),
      progress_(std::move(progress)) {
    std::fill(like_.y.begin() + n_, like_.y.end(), 0.0);
}

Eigen::VectorXd SectionMap::scaled(const InitialState& state) const {
    return Eigen::Map<const Eigen::VectorXd>(state.y.data(), n_).cwiseQuotient(scale_.head(n_));
}

InitialState SectionMap::state(const Eigen::VectorXd& y) const {
    InitialState state = like_;
    Eigen::Map<Eigen::VectorXd>(state.y.data(), n_) = y.cwiseProduct(scale_.head(n_));
    return state;
}

SectionMap::Value SectionMap::at(const Eigen::VectorXd& y) const {
    Value value;
    value.map = flow_map(problem_, state(y), period_, progress_);
    value.image = scaled(value.map.end);
    return value;
}

Eigen::MatrixXd SectionMap::derivative(const Eigen::VectorXd& y, const Value& value) const {
    const Neighbours neighbours(problem_, scale_, Differences::extrapolated, progress_);
    const Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(scale_.size(), n_);
    return neighbours.along(0, state(y), period_, value.map, basis).topRows(n_);
}

PeriodicOrbit SectionMap::orbit(const Eigen::VectorXd& y, const Value& value, const Eigen::MatrixXd& derivative) const {
    PeriodicOrbit orbit;
    orbit.section = section_;
    orbit.start = state(y);
    orbit.initial = initial_of(System(problem_), orbit.start.y);
    orbit.cam_phase = cam_phase_;
    orbit.turns = turns_;
    orbit.period = period_;
    orbit.holds = value.map.holds;
    orbit.lifts = value.map.lifts;
    orbit.residual = (value.image - y).norm();
    for (const MotionTouch& touch : value.map.touches)
        orbit.impacts.push_back({section_ - problem_.cam->speed * touch.t, touch.approach, touch.x, touch.overhang});
    const Eigen::VectorXcd multipliers = eigenvalues(derivative);
    orbit.multipliers.assign(multipliers.begin(), multipliers.end());
    std::ranges::stable_sort(orbit.multipliers, {},
                             [](const std::complex<double>& m) { return std::tuple(-std::abs(m), -m.imag()); });
    return orbit;
}

}  // namespace beamcam::sim
