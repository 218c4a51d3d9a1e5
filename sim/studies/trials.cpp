#include "sim/studies/trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/run/simulate.hpp"

namespace beamcam::sim {
namespace {

constexpr double kAllRuns = 20;  // after this time, in limits of one run, timings are not repeated

std::string over_limit(double limit) { return fmt::format("{}: longer than {:g} s", kLeftOut, limit); }

}  // namespace

void Trials::begin(double share, double more) {
    share_ = share;
    more_ = more;
    runs_ = 0;
    if (!report(0)) throw Interrupted();
}

std::optional<TrialRun> Trials::simulate_until(const Problem& problem, double end, double limit, bool sampled) {
    Request request;
    request.end_time = end;
    if (sampled) {
        TableRequest table;
        table.channels = {angle_.channel};
        for (int k = 0; k <= kInstants; ++k) table.times.push_back(end * k / kInstants);
        request.tables.push_back(std::move(table));
    }
    const auto start = Clock::now();
    bool stopped = false;
    TrialRun run;
    try {
        run.result = simulate(problem, request, [&](double t) {
            stopped = seconds_since(start) <= limit && !report(std::min(1.0, t / end));
            return seconds_since(start) <= limit && !stopped;
        });
    } catch (const Interrupted&) {
        if (stopped) throw;
        return std::nullopt;
    }
    run.seconds = seconds_since(start);
    ++runs_;
    if (!report(0)) throw Interrupted();
    if (!sampled) return run;
    run.angle = std::move(run.result.tables[0].values[0]);
    for (double& value : run.angle) value *= angle_.scale;
    return run;
}

std::optional<TrialRun> Trials::try_until(const Problem& variant, double end, double limit, std::string& note) {
    try {
        if (auto run = simulate_until(variant, end, limit, true)) return run;
        note = over_limit(limit);
    } catch (const SolverError& failure) {
        note = fmt::format("failed: {}", failure.what());
    } catch (const std::invalid_argument& rejected) {
        note = fmt::format("rejected: {}", rejected.what());
    }
    return std::nullopt;
}

void Trials::measure(AccuracyRow& row, const Problem& variant, const TrialRun& truth, double end, double limit,
                     int repeats) {
    const std::optional<TrialRun> run = try_until(variant, end, limit, row.note);
    if (!run) return;
    compare(row, *run, truth, end);
    if (const auto timing = time(variant, end, 2 * limit, repeats, kAllRuns * limit * (1 + share_))) {
        row.time = *timing;
    } else {
        row.error.reset();
        row.note = over_limit(limit);
    }
}

std::optional<Timing> Trials::time(const Problem& variant, double end, double limit, int repeats, double enough) {
    std::vector<double> seconds;
    for (int k = 0; k < repeats; ++k) {
        const std::optional<TrialRun> run = simulate_until(variant, end, limit, false);
        if (!run) return std::nullopt;
        seconds.push_back(run->seconds);
        if (seconds_since(started_) > enough) break;
    }
    std::ranges::sort(seconds);
    return Timing{seconds[seconds.size() / 2], seconds.front(), seconds.back(), static_cast<int>(seconds.size())};
}

// False: interrupted by the user. How many runs follow `runs_` and the part of the present one is not known: the
// first half of what they add is reported after one, two thirds after two.
bool Trials::report(double part) {
    progress_ = std::max(progress_, share_ + more_ * (1 - 1 / (1 + runs_ + part)));  // a run may fail on its way
    return !report_ || report_(progress_);
}

void Trials::compare(AccuracyRow& row, const TrialRun& run, const TrialRun& truth, double end) const {
    double worst = 0;
    row.trusted_until = end;
    for (std::size_t k = 0; k < truth.angle.size(); ++k) {
        const double off = std::fabs(run.angle[k] - truth.angle[k]);
        if (!(off <= target_) && row.trusted_until == end)
            row.trusted_until = end * static_cast<double>(k > 0 ? k - 1 : 0) / kInstants;
        worst = std::max(worst, off);
    }
    row.error = worst;
    row.steps = run.result.counters.steps;
    row.rhs_evaluations = run.result.counters.rhs_evaluations;
    const auto &mine = run.result.impacts, &theirs = truth.result.impacts;
    row.impacts = static_cast<long>(mine.size());
    if (mine.size() != theirs.size()) return;
    double shift = 0;
    for (std::size_t i = 0; i < mine.size(); ++i)
        shift = std::max(shift, std::fabs(mine[i].t_start - theirs[i].t_start));
    row.touch_error = shift;
}

}  // namespace beamcam::sim
