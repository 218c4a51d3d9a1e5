// One step of the trajectory as the recorders see it, and what each step adds to every result.
#pragma once

#include <vector>

#include "sim/integrate/integrator.hpp"
#include "sim/observe/result.hpp"

namespace beamcam::sim {

// `segment` restricted to [from, to], in one phase of the motion.
struct SegmentInterval {
    const Segment* segment;
    double from, to;
    bool last;  // its end point belongs to it (end of the run)
    bool ends_before(double t) const { return last ? t > to : t >= to; }
};

// What an interval adds to every result, whatever was asked for. Found once, for all recorders.
struct SegmentSummary {
    bool turning_points = false;  // whether the next two were looked for
    std::vector<Apex> apexes;
    std::vector<ZeroCrossing> theta_zero;
    // So far: of the impact still open, of the energy ledger, and the largest bending energy [J].
    decltype(Impact::force_peak) force_peak{};
    double penetration_peak = 0, energy_scale = 0, energy_residual_max = 0, largest_elastic = 0;
};

}  // namespace beamcam::sim
