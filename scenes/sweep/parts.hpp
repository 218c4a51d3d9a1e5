// Sweeps in parts for several machines: selection of a part, and joining of the parts.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "scenes/sweep/make_points.hpp"

namespace beamcam::scenes {

// "2/3"; "auto" or "auto/3": from the variables of an array task of Slurm. `variable` is std::getenv. Throws
// UsageError.
Shard shard_of(const std::string& text, const std::function<const char*(const char*)>& variable);

// Joins the parts of a sweep. Throws IoError, with the name of the file, for missing, repeated, unfinished, damaged or
// foreign parts; SceneError.
struct CollectedSweep {
    Scene scene;
    output::SweepData data;
};
CollectedSweep collect(const std::vector<std::filesystem::path>& files);

}  // namespace beamcam::scenes
