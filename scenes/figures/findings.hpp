// The findings on the paper as a Markdown table: each with its numbers, computed by this run, and the test that checks
// it.
#pragma once

#include <functional>
#include <string>

#include "scenes/figures/studies.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

struct Finding {
    std::string paper, truth;  // Markdown: what the paper prints, what is true
    std::string numbers;       // with units
    std::string test;          // suite and name
};

// Adds the studies of the findings; the returned function reads their results.
std::function<std::vector<Finding>(const Results&)> prepare_findings(Studies& studies);
std::string findings_markdown(const std::vector<Finding>& findings);

}  // namespace beamcam::scenes
