// The key of the inputs of an output. Equal keys mean equal bits of its files; a key that misses an input would keep an
// outdated file.
#pragma once

#include <cstddef>
#include <string>

#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// SHA-256 of everything that the files of one output depend on. `until`: end of the run, for outputs about the whole
// run. `part`: the frames of a film; empty: all.
std::string inputs_key(const Scene& scene, std::size_t output, double until, const std::string& part);

}  // namespace beamcam::scenes
