// How a displacement [m/N] and its rate [m/(N s)] at the nodes of a step respond to nodal forces: columns by force.
#pragma once

#include <vector>

#include "sim/integrate/nodal_matrix.hpp"
#include "sim/integrate/oscillator.hpp"

namespace beamcam::sim {

struct NodalCompliance {
    NodalMatrix value, rate;
};
// The displacement in a direction with the rows a of the modes by forces in that with the rows b, or the other way
// round. `hub`: the product of both rows of the hub over its inertia.
NodalCompliance nodal_compliance(const StepTable& table, double mass, double hub, const std::vector<double>& a,
                                 const std::vector<double>& b);

}  // namespace beamcam::sim
