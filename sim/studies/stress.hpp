// The stress campaign: a few thousand problems at the extremes of what a scene may say, each of which must end or
// be refused in words. Plates are grids of two extremes; every cell holds several variants. Beside them stand a
// list of single hard cases and a plate of random mixtures of everything. No files, no threads.
//
// What counts as survival: no exception but those of simulate.hpp, every recorded number finite, the energy
// ledger closed or its opening told, no energy gained on a cam at rest, a partial trajectory after a failure.
#pragma once

#include <string>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

enum class Outcome {
    closed,   // reached the end, ledger within ten times rtol of the energy scale
    open,     // reached the end, and told that the ledger does not close so well
    refused,  // by `validate`, before any work
    stopped,  // by SolverError: last good time, cause, remedy
    failed    // anything else
};
const char* name(Outcome outcome);

struct StressCase {
    std::size_t plate = 0, row = 0, column = 0;  // into `Campaign::plates`
    std::string variant;
    Problem problem;
    double end = 0;  // [s]
};

struct Plate {
    std::string title, row_title, column_title;
    std::vector<std::string> rows, columns;
};

struct Campaign {
    std::vector<Plate> plates;
    std::vector<StressCase> cases;
};

// The same every time. `full`: all of them, more than 2000; otherwise one in ten or so, and the short ones of the
// single hard cases.
Campaign stress_campaign(bool full);

struct StressResult {
    Outcome outcome = Outcome::failed;
    std::string words;            // the first warning, refusal or failure
    double closure = 0;           // largest ledger residual over rtol × energy scale; NaN unless it ended
    double steps_per_second = 0;  // steps taken per simulated second
    double reached = 0;           // [s]
    long steps = 0;
    std::size_t impacts = 0;
};

// Runs one case; throws nothing.
StressResult survive(const StressCase& one);

}  // namespace beamcam::sim
