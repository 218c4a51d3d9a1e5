// Renders and simulates what a file of baselines asks for, and judges it: the picture and the motion separately.
//
// Entries that share a scene are integrated once, no further than they look, and nothing that they do not need is
// drawn. Nothing is read from caches: what is tested is this program.
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
    std::vector<std::string> update;  // the same; only these are run and replaced
    bool add_digest = false;          // accept the digests of what is equivalent, or of a new renderer
    PassRule rule;
    Tolerance tolerance;                          // over that of every entry
    std::optional<std::filesystem::path> report;  // folder for actual and difference pictures
    RunOptions run;
};

// Throws UsageError for unknown names, and what runs and files throw. A solver that fails is a verdict.
RegressionResult test_regression(const std::string& path, const RegressionOptions& options);

}  // namespace beamcam::scenes
