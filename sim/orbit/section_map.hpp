// The section map: from the state at a cam angle to that some turns of the cam later. MODEL.md §16a.
#pragma once

#include <Eigen/Core>

#include "sim/orbit/flow_map.hpp"
#include "sim/orbit/periodic_orbit.hpp"

namespace beamcam::sim {

// From the state at a cam angle, in units and over `size`, to that some turns later.                            (S75)
class SectionMap {
  public:
    // `like` has the phase and the rest of the state.
    SectionMap(const Problem& problem, double section, int turns, InitialState like, Eigen::VectorXd units,
               double size);
    struct Value {
        Eigen::VectorXd image;
        Eigen::MatrixXd derivative;  // empty if not asked for
        FlowMap map;
    };
    Value at(const Eigen::VectorXd& y, bool derivative) const;

    Eigen::VectorXd scaled(const InitialState& state) const;
    PeriodicOrbit orbit(const Eigen::VectorXd& y, const Value& value) const;
    double period() const { return period_; }

  private:
    Problem problem_;
    double section_, cam_phase_, period_, size_;
    int turns_;
    InitialState like_;
    Eigen::VectorXd units_;
};

// What states near an orbit are measured in.
struct SectionScale {
    Eigen::VectorXd units;
    double size = 1;
};
SectionScale section_scale(const Problem& problem, const PeriodicOrbit& orbit);

// Tolerances of the integration for orbits: tight, so that Newton's method ends near rounding.
Problem for_orbits(Problem problem);

// The problem with its cam at this angle at t = 0.
Problem at_section(Problem problem, double section);
// What deviations are measured by: the speed of impacts, or the state y in units itself without any.
double size_of(const Problem& problem, const FlowMap& map, const Eigen::VectorXd& y);

}  // namespace beamcam::sim
