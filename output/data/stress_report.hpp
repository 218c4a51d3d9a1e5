// The results of a stress campaign as text, CSV and JSON.
#pragma once

#include <string>
#include <vector>

#include "sim/studies/stress.hpp"

namespace beamcam::output {

// A line for each plate with the count of each outcome, worst ledger and most steps a second; then every failure
// with its cause, then how often each cause of stopping came up.
std::string stress_text(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results);

// One line a case: plate, row, column, variant, outcome, closure, steps_per_second, steps, impacts, reached, words.
std::string stress_csv(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results);

// {"plates": […], "cases": [{"plate", "row", "column", "variant", "outcome", "closure", "steps_per_second", …}, …]}
std::string stress_json(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results);

}  // namespace beamcam::output
