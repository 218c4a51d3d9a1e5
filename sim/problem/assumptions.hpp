// What the model assumes of a beam and a cam other than the paper's: `beamcam check` prints it. MODEL.md (S99).
#pragma once

#include <string>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// [rad] of the beam's slope, beyond which the foreshortening u = −½∫v′² of the modal models misses 2 %.
inline constexpr double kSmallSlope = 0.3;

// "beam: …", "contact.stiffness: …"; `has_stiffness`: the scene gives a contact stiffness. `end_time` [s].
std::vector<std::string> assumptions(const Problem& problem, bool has_stiffness, double end_time);

// By which share shear and rotary inertia would lower the frequency of the highest shape, were it clamped (S99).
double shear_correction(const Beam& beam);
// Slope at the tip of the clamped, horizontal beam under its weight, to first order [rad].
double static_slope(const Problem& problem);

}  // namespace beamcam::sim
