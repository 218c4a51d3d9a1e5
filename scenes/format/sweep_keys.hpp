// The keys and the options of a sweep share these: the notations of samples and seeds, and the checks of a sweep.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// "impacts", "apexes", "section:cam_angle=0", "section:theta_dot=0:falling". Returns why the text is not valid, or "".
std::string parse_sample(std::string_view text, const sim::Problem& problem, sim::Sampling& sampling);
// "same", "carry-up,carry-down", "random:8".
std::string parse_seeds(std::string_view text, SweepSeeds& seeds);

// Replaces the file and column of a key by the values of the column, in SI units if the file states another unit. The
// path of the file is relative to `folder`. Returns why there are none, or "".
std::string read_column(SweptKey& over, const std::filesystem::path& folder, const sim::Problem& problem);

// Why the key is not one that can vary; empty: it is.
std::string problem_with_number_key(const sim::Problem& problem, const std::string& key);

// The errors of a sweep of this problem, each with its key ("over.0.key").
struct SweepProblem {
    std::string key, text;
};
std::vector<SweepProblem> problems_of(const Sweep& sweep, const sim::Problem& problem);

}  // namespace beamcam::scenes
