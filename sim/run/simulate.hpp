// Simulates a Problem and returns what the requests contain, and only that. Only the energy balance is always computed;
// it takes no part in step control. Requests never change a bit of the trajectory, and a shorter run is a prefix of a
// longer one.
#pragma once

#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/dynamics/validate.hpp"
#include "sim/observe/request.hpp"
#include "sim/observe/result.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

inline constexpr long kStepsPerReport = 16;  // steps between two calls of `progress`

// The integration failed (exit code 4). `partials` hold the results up to `last_time`.
struct SolverError : std::runtime_error {
    SolverError(const std::string& what, double last_good_time, std::vector<Result> partial_results);
    double last_time;
    std::vector<Result> partials;  // one per Request; empty if nothing was integrated
};
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted") {}
};

// Called from time to time with the time reached; if it returns false the run throws Interrupted.
using Progress = std::function<bool(double t)>;

// The work of one or several calls.
struct Effort {
    long integrations = 0;
    Counters spent;
    void add(const Counters& counters);  // of one integration
    void add(const Effort& more);
};

// Throws SolverError, Interrupted; std::invalid_argument if `validate(problem)` returns a fatal issue.
Result simulate(const Problem& problem, const Request& request, const Progress& progress = {});

// One integration for several requests. Each result has the same bits as with its request alone.
std::vector<Result> simulate(const Problem& problem, std::span<const Request> requests, const Progress& progress = {},
                             Effort* effort = nullptr);

}  // namespace beamcam::sim
