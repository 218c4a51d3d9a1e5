// Periodic orbits and their branches as text, as `orbits` prints them.
#pragma once

#include <string>

#include "output/data/orbit_records.hpp"
#include "render/film/film.hpp"

namespace beamcam::scenes {

// Values of the varied key are in the scene's units: those of --over, if it has any.
std::string to_text(const output::BranchTable& table, const render::Units& units);
std::string value_text(const output::BranchTable& table, double value, const render::Units& units);  // "450 rpm"

// The text about a search without result, and what to try.
std::string nothing_found(const sim::OrbitRequest& request);

}  // namespace beamcam::scenes
