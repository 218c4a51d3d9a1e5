// Finds the outputs that are up to date.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/data/file_list.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// SHA-256 of everything that the files of one output depend on: an input that it misses would keep an outdated file.
std::string inputs_key(const Scene& scene, std::size_t output);

// The key of each output of the scene; empty for standard output.
std::vector<std::string> inputs_keys(const Scene& scene);

// `directory` as in RunOptions.
ExistingWork find_existing(const Scene& scene, const std::vector<std::string>& inputs, const std::string& directory,
                           output::FileList& file_list);

// The path of an output's file; with an empty `directory` the name is the path.
std::filesystem::path place_of(const std::string& directory, const std::string& file);

}  // namespace beamcam::scenes
