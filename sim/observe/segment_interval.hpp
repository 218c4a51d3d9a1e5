// One step of the trajectory as the recorders see it, and its contribution to every result.
#pragma once

#include <optional>
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

// Largest values up to the end of an interval: of the open impact, and of the whole run.
struct ImpactPeaks {
    decltype(Impact::force_peak) force{}, t_force{};  // [N], [s]
    double penetration = 0;                           // [m]
};
struct RunPeaks {
    double energy_scale = 0, energy_residual_max = 0, largest_elastic = 0;  // [J]; the last: of the bending energy
};

// Everything about an interval that does not depend on the request; computed once, for all recorders.
struct SegmentSummary : RunPeaks {
    // Absent: not searched.
    std::optional<ImpactPeaks> impact;
    std::optional<std::vector<Apex>> apexes;
    std::optional<std::vector<ZeroCrossing>> theta_zero;
};

}  // namespace beamcam::sim
