// One simulation: a Problem and what is wanted of it go in, exactly that comes out.
//
// Nothing is computed because it might be wanted: no table, no pose, no ledger beyond the request
// (the energy ledger is always kept; it never changes a step). What is asked for never changes the
// trajectory: asking for more or less leaves every bit of it as it was, and a shorter run is a
// prefix of a longer one.
#pragma once

#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/observe/request.hpp"
#include "sim/observe/result.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// The integration could not go on (exit code 4). `partials` hold what was reached by then.
struct SolverError : std::runtime_error {
    SolverError(const std::string& what, double last_good_time, std::vector<Result> partial_results);
    double last_time;
    std::vector<Result> partials;  // one per Request; none where no state to start from was found
};
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted") {}
};

// Called now and then with the time reached; returning false ends the run with `Interrupted`.
using Progress = std::function<bool(double t)>;

// What was really done, by one call or several: nothing for what came from a kept trajectory.
struct Effort {
    long integrations = 0;
    Counters spent;
    void add(const Counters& counters);  // of one integration
    void add(const Effort& more);
};

class Trajectory;
class TrajectoryWriter;

// Throws SolverError, Interrupted; std::invalid_argument when `validate(problem)` has fatal findings.
Result simulate(const Problem& problem, const Request& request, const Progress& progress = {});

// One integration for several requests. Each result has the same bits as if its request had been alone. `keep`
// takes the trajectory down (trajectory.hpp).
std::vector<Result> simulate(const Problem& problem, std::span<const Request> requests, const Progress& progress = {},
                             TrajectoryWriter* keep = nullptr, Effort* effort = nullptr);

// The same from a trajectory that was kept: the same bits again. A horizon still costs its other runs. Throws
// std::invalid_argument where the trajectory does not reach as far as the requests.
std::vector<Result> replay(const Problem& problem, const Trajectory& trajectory, std::span<const Request> requests,
                           const Progress& progress = {}, Effort* effort = nullptr);

}  // namespace beamcam::sim
