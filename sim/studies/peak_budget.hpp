// How sure the largest value of a channel is, such as the contact force: its change with the number of shapes, the beam
// model, the tolerance and the contact law. MODEL.md §16.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/observe/channels.hpp"

namespace beamcam::sim {

struct PeakRow {
    std::string change;          // "16 modes", "stiffness × 2"
    int modes = 0;               // of a run with another number of shapes
    std::optional<double> peak;  // absent: the run failed or took too long, for the reason in `note`
    double t = 0;                // [s]
    std::string note = {};
};

struct PeakBudget {
    Channel channel;
    double end_time = 0;  // [s]
    double peak = 0;      // the value of largest magnitude
    double t = 0;         // its instant [s]
    std::vector<PeakRow> rows;
    std::string recommendation;
};

// `longest`: runs that take longer are left out [s]. `progress` receives the completed fraction; if it returns false,
// Interrupted is thrown. Throws the exceptions of `simulate` for the problem's own settings, and std::invalid_argument
// for a channel without values.
PeakBudget peak_budget(const Problem& problem, Channel channel, double end_time, double longest,
                       const std::function<bool(double share)>& progress = {});

// The change of a row relative to the peak; NaN if the peak is zero.
double relative_change(const PeakBudget& budget, const PeakRow& row);

}  // namespace beamcam::sim
