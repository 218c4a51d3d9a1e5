// Finds the outputs that are up to date.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/data/file_list.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// SHA-256 of everything that the files of one output depend on: an input that it misses would keep an outdated file.
// `until`: end of the run, for outputs about the whole run. `part`: of a sweep, "2/3"; empty: all.
std::string inputs_key(const Scene& scene, std::size_t output, double until, const std::string& part);

struct UpToDate {
    ExistingWork existing;
    std::vector<std::string> inputs;  // key of each output of the scene; empty for standard output
};

// `directory` as in RunOptions. `ignore_files`: no file counts as up to date.
UpToDate check_up_to_date(const Scene& scene, const Shard& shard, const std::string& directory,
                          output::FileList& file_list, bool ignore_files);

// The path of an output's file; with an empty `directory` the name is the path.
std::filesystem::path place_of(const std::string& directory, const std::string& file);

}  // namespace beamcam::scenes
