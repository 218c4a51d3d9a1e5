// What names the same work: which program this is, which motion a problem has, which inputs an output was made from.
// Equal names mean equal bits; anything else would serve something stale.
#pragma once

#include <string>

#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// Version and build of this program and of the libraries it was started with, and the instructions of the processor
// that its mathematics picks.
const std::string& program_identity();

// SHA-256 of all that decides the motion: physics with every default resolved, and the solver's settings. Nothing that
// is only drawn, named or asked for; not the end time either, because a shorter run is a prefix of a longer one.
std::string motion_key(const sim::Problem& problem);

// SHA-256 of all that the files of one output depend on. `until`: how far the run goes, for outputs that tell of the
// whole run. `part`: which frames of a film; empty: all.
std::string inputs_key(const Scene& scene, std::size_t output, double until, const std::string& part);

}  // namespace beamcam::scenes
