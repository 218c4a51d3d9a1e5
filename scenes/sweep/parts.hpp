// A sweep cut into parts for several machines: which part a program makes, and the parts joined again.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "scenes/sweep/make_points.hpp"

namespace beamcam::scenes {

// "2/3"; "auto" or "auto/3": by the variables that Slurm, Grid Engine and PBS set for a task of an array. `variable` is
// std::getenv. Throws UsageError.
SweepPart part_argument(const std::string& text, const std::function<const char*(const char*)>& variable);

// The parts as one sweep, and its points by their grid. Throws IoError: a part that is missing, there twice or not
// finished, a part of another sweep, a file that is no part; each by name.
struct CollectedSweep {
    Scene scene;
    output::SweepData data;
};
CollectedSweep collect(const std::vector<std::filesystem::path>& files);

// A ready script for an engine that runs the parts: "slurm", "parallel" or "snakemake". `command` is beamcam sweep with
// its options, without -o.
std::string engine_script(const std::string& engine, const std::string& command, const std::string& file, int parts);

}  // namespace beamcam::scenes
