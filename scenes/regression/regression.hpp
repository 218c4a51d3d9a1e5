// Renders and simulates the entries of a file of baselines, and judges picture and motion of each separately.
//
// Entries with the same mechanics are integrated once, up to the last instant that any of them shows.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenes/outputs/run.hpp"
#include "scenes/regression/baselines.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

struct RegressionOptions {
    std::vector<std::string> only;    // names or patterns such as "fall-*"; empty: all
    std::vector<std::string> update;  // the same; only these are run, and their references are replaced
    PassRule rule;
    std::optional<std::filesystem::path> report;  // folder for actual, expected and difference pictures
    RunOptions run;
};

// Throws UsageError for unknown names, and the errors of runs and files. If the solver fails, the entry fails.
RegressionResult test_regression(const std::string& path, const RegressionOptions& options);

}  // namespace beamcam::scenes
