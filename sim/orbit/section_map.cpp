#include "sim/orbit/section_map.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/linear_algebra.hpp"
#include "sim/orbit/multipliers.hpp"

namespace beamcam::sim {

constexpr double kTightRtol = 1e-12, kTightAtol = 1e-14;  // the limits set by rounding
constexpr int kMaxMapSteps = 3'000'000;                   // integration steps of one section map: minutes

Problem at_section(Problem problem, double section) {
    problem.cam->phase = section;
    return problem;
}

double size_of(const Problem& problem, const FlowMap& map, const Eigen::VectorXd& y) {
    double fastest = 0;
    for (const TangentTouch& touch : map.touches) fastest = std::max(fastest, touch.approach);
    return fastest > 0 ? fastest * std::sqrt(problem.beam.line_density() * problem.beam.length) : y.norm();
}

Problem for_orbits(Problem problem) {
    problem.solver.method = Method::automatic;
    problem.solver.rtol = std::min(problem.solver.rtol, kTightRtol);
    problem.solver.atol = std::min(problem.solver.atol, kTightAtol);
    problem.solver.max_steps = std::min(problem.solver.max_steps, kMaxMapSteps);
    return problem;
}

SectionScale section_scale(const Problem& problem, const PeriodicOrbit& orbit, const Progress& progress) {
    const FlowMap map = flow_map(at_section(problem, orbit.section), orbit.start, orbit.period, false, progress);
    const Eigen::Map<const Eigen::VectorXd> state(orbit.start.y.data(), map.units.size());
    return {map.units, size_of(problem, map, map.units.cwiseProduct(state))};
}

SectionMap::SectionMap(const Problem& problem, double section, int turns, InitialState like, const SectionScale& scale,
                       Progress progress)
    : problem_(at_section(problem, section)),
      section_(section),
      cam_phase_(section_phase(problem, section)),
      period_(turns * cam_period(problem)),
      size_(scale.size),
      turns_(turns),
      like_(std::move(like)),
      units_(scale.units),
      progress_(std::move(progress)) {
    std::fill(like_.y.begin() + units_.size(), like_.y.end(), 0.0);
}

Eigen::VectorXd SectionMap::scaled(const InitialState& state) const {
    return units_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(state.y.data(), units_.size())) / size_;
}

InitialState SectionMap::state(const Eigen::VectorXd& y) const {
    InitialState state = like_;
    Eigen::Map<Eigen::VectorXd>(state.y.data(), units_.size()) = size_ * y.cwiseQuotient(units_);
    return state;
}

SectionMap::Value SectionMap::at(const Eigen::VectorXd& y, bool derivative) const {
    Value value;
    value.map = flow_map(problem_, state(y), period_, derivative, progress_);
    value.image = scaled(value.map.end);
    if (derivative) value.derivative = units_.asDiagonal() * value.map.derivative * units_.cwiseInverse().asDiagonal();
    return value;
}

PeriodicOrbit SectionMap::orbit(const Eigen::VectorXd& y, const Value& value) const {
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
    for (const TangentTouch& touch : value.map.touches)
        orbit.impacts.push_back({section_ - problem_.cam->speed * touch.t, touch.approach, touch.x, touch.overhang});
    if (like_.phase.held)  // only neighbouring states on the cam
        orbit.multipliers =
            multipliers({flow_map(problem_, orbit.start, period_, true, progress_, StartOnCam::kept).derivative});
    else if (orbit.chatters())
        orbit.multipliers = multipliers({value.derivative});
    else
        orbit.multipliers = multipliers(value.map.factors);
    return orbit;
}

}  // namespace beamcam::sim
