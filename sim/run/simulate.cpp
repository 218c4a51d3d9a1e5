#include "sim/run/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <optional>

#include "sim/base/clock.hpp"
#include "sim/observe/recorder.hpp"
#include "sim/run/horizon.hpp"
#include "sim/run/run.hpp"

namespace beamcam::sim {
namespace {

std::vector<Result> integrate(const Problem& problem, std::span<const Request> requests, const Progress& progress,
                              Effort* effort) {
    std::optional<Run> run;
    try {
        run.emplace(problem, progress);
    } catch (const StepFailure& failure) {  // the model itself
        throw SolverError(fmt::format("at the start: {}; use fewer modes", failure.what()), 0, {});
    }
    std::deque<Recorder> recorders;
    for (const Request& request : requests) {
        recorders.emplace_back(run->system(), request, [&run] { return run->statistics(); });
        run->add(recorders.back());
    }
    const auto results = [&] {
        std::vector<Result> all;
        for (Recorder& recorder : recorders) all.push_back(std::move(recorder.result()));
        return all;
    };
    try {
        run->integrate();
    } catch (SolverError& error) {
        if (run->state().t == 0) throw;  // nothing was integrated
        for (Recorder& recorder : recorders)
            if (!recorder.done()) recorder.finish(run->state().t, run->state().y.data());
        error.partials = results();
        throw;
    }
    if (effort) effort->add(run->statistics().counters);
    return results();
}

// The comparison run of the horizon. If it fails or exhausts its budget of steps, although the motion itself did not,
// the same method at a tighter tolerance replaces it, as far as that one comes.
Result comparison_run(const Problem& problem, const Request& angle, const Progress& progress, Effort* effort,
                      Comparison& compared) {
    const auto run = [&] { return std::move(integrate(compared.problem, {&angle, 1}, progress, effort).front()); };
    try {
        return run();
    } catch (const SolverError& error) {
        if (compared.same_method) {
            if (error.partials.empty()) throw;
            return error.partials.front();
        }
    }
    compared = tighter_comparison(problem);
    return comparison_run(problem, angle, progress, effort, compared);
}

// A horizon needs one more run.
std::vector<Result> integrate_with_horizons(const Problem& problem, std::span<const Request> requests,
                                            const Progress& progress, Effort* effort) {
    double end = -1;
    for (const Request& request : requests)
        if (request.horizon) end = std::max(end, end_of(request));
    if (end < 0) return integrate(problem, requests, progress, effort);
    std::vector<Request> all(requests.begin(), requests.end());
    all.push_back(horizon_request(problem, end));
    std::vector<Result> results = integrate(problem, all, progress, effort);
    const Result plain = std::move(results.back());
    results.pop_back();
    const Request& angle = all.back();
    Comparison compared = comparison(problem, end);
    const Result other = comparison_run(problem, angle, progress, effort, compared);
    for (std::size_t i = 0; i < requests.size(); ++i)
        if (requests[i].horizon) report_reproducibility(problem, angle, plain, other, compared, results[i]);
    return results;
}

}  // namespace

SolverError::SolverError(const std::string& what, double last_good_time, std::vector<Result> partial_results)
    : std::runtime_error(what), last_time(last_good_time), partials(std::move(partial_results)) {}

void Effort::add(const Counters& counters) {
    if (counters.steps > 0) ++integrations;  // without steps, only the initial state was evaluated
    spent += counters;
}

void Effort::add(const Effort& more) {
    const long together = integrations + more.integrations;
    add(more.spent);
    integrations = together;
}

std::vector<Result> simulate(const Problem& problem, std::span<const Request> requests, const Progress& progress,
                             Effort* effort) {
    require_valid(problem);
    const auto start = Clock::now();
    std::vector<Result> results = integrate_with_horizons(problem, requests, progress, effort);
    const double seconds = seconds_since(start);
    for (Result& result : results) result.wall_seconds = seconds;
    return results;
}

Result simulate(const Problem& problem, const Request& request, const Progress& progress) {
    return std::move(simulate(problem, {&request, 1}, progress).front());
}

}  // namespace beamcam::sim
