// What the work of a plan takes, by what it took in earlier runs.
#pragma once

#include <string>
#include <vector>

#include "scenes/motions/history.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// Names of work: this kind of picture first, then those that are like it.
std::vector<std::string> picture_work(const Pictures& pictures, int threads);  // per picture
std::vector<std::string> figure_work(const FigureFile& figure);                // per figure
std::vector<std::string> data_work(const DataFile& data);                      // per number

// Puts what past runs tell into the plan.
void estimate(Plan& plan, const Scene& scene, const History& history, int threads);

}  // namespace beamcam::scenes
