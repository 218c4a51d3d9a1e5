// The section map: from the state at a cam angle to the state some turns of the cam later. MODEL.md (S75).
#pragma once

#include <Eigen/Core>

#include "sim/base/numerics.hpp"
#include "sim/orbit/flow_map.hpp"
#include "sim/orbit/periodic_orbit.hpp"

namespace beamcam::sim {

// Residual of a converged orbit over its size; one of up to kNegligible is accepted if rounding allows no less.
inline constexpr double kOrbitConverged = 1e-11;

// Scale of the states near an orbit.
struct SectionScale {
    Eigen::VectorXd units;
    double size = 1;
};

// States are scaled: multiplied by `units` and divided by `size`. Functions throw SolverError, Interrupted.
class SectionMap {
  public:
    // `like` supplies the phase and the remaining state variables. `progress` may interrupt each evaluation.
    SectionMap(const Problem& problem, double section, int turns, InitialState like, const SectionScale& scale,
               Progress progress);
    struct Value {
        Eigen::VectorXd image;
        Eigen::MatrixXd derivative;  // empty if not requested
        FlowMap map;
    };
    Value at(const Eigen::VectorXd& y, bool derivative) const;

    Eigen::VectorXd scaled(const InitialState& state) const;
    PeriodicOrbit orbit(const Eigen::VectorXd& y, const Value& value) const;

  private:
    InitialState state(const Eigen::VectorXd& y) const;  // whose `scaled` is y

    Problem problem_;
    double section_, cam_phase_, period_, size_;
    int turns_;
    InitialState like_;
    Eigen::VectorXd units_;
    Progress progress_;
};

SectionScale section_scale(const Problem& problem, const PeriodicOrbit& orbit, const Progress& progress);

// The problem with tight tolerances, with which Newton's method converges to rounding.
Problem for_orbits(Problem problem);

// The problem with its cam at this angle at t = 0.
Problem at_section(Problem problem, double section);
// The size of an orbit: the speed of its fastest impact in units or, without impacts, the norm of the state y in units.
double size_of(const Problem& problem, const FlowMap& map, const Eigen::VectorXd& y);

}  // namespace beamcam::sim
