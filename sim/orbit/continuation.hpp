// Branches of periodic orbits over a parameter: pseudo-arc-length continuation through folds, with the points at which
// stability or the pattern of impacts changes. MODEL.md (S76), (S77); tested against the closed forms (S78).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/orbit/periodic_orbit.hpp"

namespace beamcam::sim {

// The problem at a value of the parameter.
using Family = std::function<Problem(double)>;

struct BranchPoint {
    double parameter = 0;
    PeriodicOrbit orbit;
};

enum class OrbitChange { fold, period_doubling, neimark_sacker, branching, grazing, corner, release };
inline std::span<const Named<OrbitChange>> names(OrbitChange) {
    using enum OrbitChange;
    static constexpr Named<OrbitChange> all[] = {{fold, "fold"},
                                                 {period_doubling, "period-doubling"},
                                                 {neimark_sacker, "neimark-sacker"},
                                                 {branching, "branching"},
                                                 {grazing, "grazing"},
                                                 {corner, "corner"},
                                                 {release, "release"}};
    return all;
}

struct SpecialPoint {
    OrbitChange change = OrbitChange::fold;
    BranchPoint at;
    double uncertainty = 0;  // of the parameter
};

struct Branch {
    std::vector<BranchPoint> points;  // in the order of the arc
    std::vector<SpecialPoint> special;
    std::string first_end, last_end;      // reasons for the two ends
    std::vector<PeriodicOrbit> at_start;  // its orbits at the parameter of the start; some may repeat
};

struct ContinuationRequest {
    double from = 0, to = 1;  // of the parameter
    double step = 0.01;       // longest step, as a fraction of the range
    int most_points = 2000;   // in each direction
    int doublings = 0;        // number of generations of period-doubled branches
};

// The branch through an orbit of `family(parameter)`, in both directions, and the branches that bifurcate from it by
// period doubling. Each ends, in each direction, after about the number of steps that a run may have (max_steps);
// motions of a few steps do not count. `progress` receives the parameter. Throws Interrupted.
std::vector<Branch> continue_orbit(const Family& family, const BranchPoint& start, const ContinuationRequest& request,
                                   const Progress& progress = {});

}  // namespace beamcam::sim
