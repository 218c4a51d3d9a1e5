// How an orbit touches the cam: its impacts and its rest. Along a branch the pattern changes by grazing and release
// (S77).
#pragma once

#include <string>

#include "sim/orbit/periodic_orbit.hpp"

namespace beamcam::sim {

// Orbits have the same pattern unless grazing or release lies between them. Before sustained contact the number of
// impacts is infinite and is not compared.
bool same_pattern(const PeriodicOrbit& a, const PeriodicOrbit& b);

// The change from one pattern to the next, in words. `beyond` is null if no orbit was found there.
std::string change_of_pattern(const PeriodicOrbit& orbit, const PeriodicOrbit* beyond);

// The first or the last impact is so close to the section that a small change could move it across.
bool near_section(const PeriodicOrbit& orbit);

}  // namespace beamcam::sim
