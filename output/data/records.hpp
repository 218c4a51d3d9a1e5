// Impacts, collisions and the summary of a run as JSON and CSV, with the names that scripts use. Keys have a fixed
// order; numbers have enough digits to read the same bits back; undefined values are null, in CSV an empty cell.
#pragma once

#include <string>
#include <vector>

#include "output/files/errors.hpp"
#include "output/files/target.hpp"
#include "sim/beam/modes.hpp"
#include "sim/cam/lever.hpp"
#include "sim/observe/channels.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/simulate.hpp"
#include "sim/studies/accuracy.hpp"
#include "sim/studies/beam_jump.hpp"
#include "sim/studies/peak_budget.hpp"

namespace beamcam::output {

std::string impacts_json(const sim::Result& result);  // {"impacts": […], "collisions": […]}

// The ending decides: .json, or .csv with the impacts alone. Throws UnsupportedOption for others, IoError.
void write_impacts(const FileTarget& file, const sim::Result& result);

struct ChannelExtremum {
    sim::Channel channel;
    sim::Extremum extremum;
};
// Agreement of the motion with measured data of one channel: differences, measured minus computed, where both have a
// value and θ is reproducible.
struct Agreement {
    std::string label, file;
    sim::Channel channel;
    std::size_t rows = 0;
    double rms = 0;
};
// "units" lists the time and the channels of the extrema.
std::string summary_json(const sim::Problem& problem, const sim::Result& result,
                         const std::vector<ChannelExtremum>& extrema, const std::vector<Agreement>& data = {});

// {"modes": [{"omega", "hz", "shape": [[x, y], …]}, …]}; omega and hz are null for a diverging mode.
std::string modes_json(const std::vector<sim::Mode>& modes);

// Every row of the assessment, its conditions and the recommendation.
std::string accuracy_json(const sim::Accuracy& accuracy);
// With the speed at which the beam leaves the cam if it is known.
std::string cam_json(const sim::Lever::Summary& summary, const std::optional<sim::BeamJump>& beam);
// The largest value of a channel, its change by each variant, and the recommendation; in the channel's unit.
std::string peak_json(const sim::PeakBudget& budget, const std::string& unit);

}  // namespace beamcam::output
