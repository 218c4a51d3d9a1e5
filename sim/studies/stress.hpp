// The stress campaign: a few thousand problems with extreme values. Every case must finish or be rejected with a clear
// message. The cases are grids over two parameters with several variants in each cell, a grid of random mixtures of all
// keys, and a list of single hard cases.
//
// A case fails unless: only exceptions of simulate.hpp occur, all recorded numbers are finite, the energy balance
// closes or is reported as open, no energy is gained on a cam at rest, and a failed run has partial results.
#pragma once

#include <string>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

enum class Outcome {
    closed,   // finished; the energy balance closes within ten times rtol of the energy scale
    open,     // finished, and reported that the energy balance does not close so well
    refused,  // rejected by `validate`
    stopped,  // SolverError with last good time, cause and remedy
    failed    // anything else
};
inline std::span<const Named<Outcome>> names(Outcome) {
    using enum Outcome;
    static constexpr Named<Outcome> all[] = {
        {closed, "closed"}, {open, "open"}, {refused, "refused"}, {stopped, "stopped"}, {failed, "failed"}};
    return all;
}

struct StressCase {
    std::size_t grid = 0, row = 0, column = 0;  // indices into Campaign::grids, CaseGrid::rows, CaseGrid::columns
    std::string variant;
    Problem problem;
    double end = 0;  // [s]
};

struct CaseGrid {
    std::string title, row_title, column_title;
    std::vector<std::string> rows, columns;
};

struct Campaign {
    std::vector<CaseGrid> grids;
    std::vector<StressCase> cases;
};

// Deterministic. `full`: all cases, more than 2000; otherwise one in eleven, and the single hard cases for shorter
// times.
Campaign stress_campaign(bool full);

struct StressResult {
    Outcome outcome = Outcome::failed;
    std::string message;  // the first warning, validation error or failure
    double closure = 0;   // largest residual of the energy balance over rtol × energy scale; NaN if not finished
    double steps_per_second = 0;  // steps per simulated second
    double reached = 0;           // [s]
    long steps = 0;
    std::size_t impacts = 0;
};

// Runs one case without exceptions.
StressResult run_case(const StressCase& one);

}  // namespace beamcam::sim
