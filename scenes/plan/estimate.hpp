// Estimates the cost of a plan from earlier runs.
#pragma once

#include <string>
#include <vector>

#include "scenes/motions/history.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// Names of work in the history, from the most specific to the most general.
std::vector<std::string> picture_work(const Pictures& pictures, int threads);  // per picture
std::vector<std::string> figure_work(const FigureFile& figure);                // per figure
std::vector<std::string> data_work(const DataFile& data);                      // per number

// Fills the costs of the plan.
void estimate(Plan& plan, const History& history, int threads);

}  // namespace beamcam::scenes
