// Branches of periodic orbits over a parameter: pseudo-arc-length continuation through folds, with the points where
// stability or the pattern of impacts changes. MODEL.md §16a; its closed forms (S78) are what this is tested against.
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
const char* name(OrbitChange change);

struct SpecialPoint {
    OrbitChange change = OrbitChange::fold;
    BranchPoint at;
    double uncertainty = 0;  // of the parameter
};

struct Branch {
    std::vector<BranchPoint> points;  // along the arc
    std::vector<SpecialPoint> special;
    std::string first_end, last_end;  // why it ends there
};

struct ContinuationRequest {
    double from = 0, to = 1;  // of the parameter
    double step = 0.01;       // longest step, in shares of the range
    int most_points = 2000;   // in either direction
    int doublings = 0;        // so many period doublings are followed onto the doubled branch
};

// The branch through an orbit of `family(parameter)`, in both directions, and the branches that double from it. Throws
// Interrupted, when `progress` (which sees the parameter) says so.
std::vector<Branch> continue_orbit(const Family& family, const BranchPoint& start, const ContinuationRequest& request,
                                   const Progress& progress = {});

}  // namespace beamcam::sim
