// The findings on the paper as a Markdown table: each with its numbers, computed here and now, and the test that
// keeps it.
#pragma once

#include <functional>
#include <string>

#include "scenes/figures/studies.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

struct Finding {
    std::string paper, truth;  // Markdown; what it prints, what holds
    std::string numbers;       // with units
    std::string test;          // suite and name
};

// Adds what the findings need; the function reads it from the results.
std::function<std::vector<Finding>(const Results&)> prepare_findings(Studies& studies);
std::string findings_markdown(const std::vector<Finding>& findings);

}  // namespace beamcam::scenes
