// Sweeps read from the options of a command.
#pragma once

#include <string>

#include "output/json/tree.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// The keys of the scene's sweep, {} if it has none.
Node sweep_tree(const Scene& scene);
// Reads such keys, in which paths of files are relative to the working directory, into the scene. Returns the first
// error, or "".
std::string read_sweep(const Node& keys, Scene& scene);

// Why the key is not one that can vary; empty: it is.
std::string problem_with_number_key(const sim::Problem& problem, const std::string& key);

}  // namespace beamcam::scenes
