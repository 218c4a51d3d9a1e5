#include "scenes/motions/motion_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "output/files/standard_output.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/motions/pose_spool.hpp"
#include "sim/base/clock.hpp"
#include "sim/base/counted.hpp"
#include "sim/observe/recorder.hpp"
#include "sim/observe/trajectory.hpp"

namespace beamcam::scenes {
namespace {

// A motion with fewer steps is integrated as fast as it is read. A step of the models with quadrature costs fifty times
// as much.
long fewest_steps(const sim::Problem& problem) {
    const sim::ModelKind model = problem.beam.model;
    return model == sim::ModelKind::exact || model == sim::ModelKind::second_order ? 20 : 500;
}

constexpr std::size_t kMostRemembered = std::size_t{1} << 25;  // numbers of a trajectory: 256 MiB

std::string describe(const sim::Problem& problem) {
    if (problem.beam.model == sim::ModelKind::rigid) return name(problem.beam.model);
    return fmt::format("{}, {}", name(problem.beam.model), counted(problem.beam.modes, "mode"));
}

double latest(std::span<const sim::Request> requests) {
    double until = 0;
    for (const sim::Request& request : requests) until = std::max(until, end_of(request));
    return until;
}

// The sum of the progress of parallel runs.
class ProgressSum {
  public:
    ProgressSum(std::size_t runs, Progress& progress) : reached_(runs, 0), progress_(progress) {}
    sim::Progress of(std::size_t run) {
        return [this, run](double t) {
            const std::lock_guard lock(mutex_);
            sum_ += t - reached_[run];
            reached_[run] = t;
            return progress_.reach(sum_);
        };
    }

  private:
    std::mutex mutex_;
    std::vector<double> reached_;
    double sum_ = 0;
    Progress& progress_;
};

}  // namespace

bool worth_keeping(const sim::Problem& problem, const sim::Request& request) {
    const bool dense = !request.tables.empty() || !request.poses.empty() || !request.points.empty();
    return dense && problem.solver.method != sim::Method::arkode_erk && end_of(request) > 0;
}

std::size_t MotionStore::request(const sim::Problem& problem, std::vector<sim::Request> requests,
                                 const std::string& label, bool may_fail) {
    requests_.push_back({motion_key(problem), problem, std::move(requests), label, may_fail, {}, {}});
    return requests_.size() - 1;
}

std::vector<MotionStore::Group> MotionStore::groups() {
    std::vector<Group> all;
    for (; computed_ < requests_.size(); ++computed_) {
        MotionRequest& wish = requests_[computed_];
        const auto same = std::ranges::find_if(all, [&](const Group& group) { return group.front()->key == wish.key; });
        if (same == all.end())
            all.push_back({&wish});
        else
            same->push_back(&wish);
    }
    return all;
}

void MotionStore::compute() {
    const std::vector<Group> all = groups();
    if (all.empty()) return;
    double total = 0;
    for (const Group& group : all) {
        double until = 0;
        for (const MotionRequest* wish : group) until = std::max(until, latest(wish->requests));
        total += until;
    }
    ProgressSum sum(all.size(), progress_);
    {
        const ProgressStage stage(progress_, "simulate", total, "s");
        fan_out(all.size(), options_.threads, [&](std::size_t k) { compute(all[k], sum.of(k)); });
    }
    for (const Group& group : all) report(group);
}

void MotionStore::compute(const Group& group, const sim::Progress& progress) {
    std::vector<sim::Request> requests;
    bool keep = false;
    const MotionRequest& first = *group.front();
    for (const MotionRequest* wish : group)
        for (const sim::Request& request : wish->requests) {
            requests.push_back(request);
            keep = keep || worth_keeping(first.problem, request);
        }
    const auto hand_out = [&](std::vector<sim::Result> results, std::vector<sim::Result> MotionRequest::*to) {
        auto next = std::make_move_iterator(results.begin());
        for (MotionRequest* wish : group) {
            const auto end = next + static_cast<std::ptrdiff_t>(wish->requests.size());
            (wish->*to).assign(next, end);
            next = end;
        }
    };
    // Distributes partial results if all requests allow that.
    const auto leave_out = [&](std::string_view why, std::vector<sim::Result> reached) {
        if (!std::ranges::all_of(group, &MotionRequest::may_fail)) return false;
        if (!reached.empty()) why = why.substr(0, why.find(';'));  // the remedy applies to the scene's own motion only
        const bool nothing = reached.empty();
        if (nothing) reached.resize(requests.size());
        reached.front().warnings = {
            fmt::format("{}, {}: {}", nothing ? "left out" : "cut short", describe(first.problem), why)};
        hand_out(std::move(reached), &MotionRequest::results);
        return true;
    };
    try {
        hand_out(run({first.key, first.problem, requests, latest(requests), keep, false}, progress),
                 &MotionRequest::results);
    } catch (const sim::SolverError& error) {
        if (leave_out(error.what(), error.partials)) return;
        if (!error.partials.empty()) hand_out(error.partials, &MotionRequest::partial);
        throw;
    } catch (const std::invalid_argument& error) {  // an impossible problem of a figure
        if (!leave_out(error.what(), {})) throw;
    }
}

void MotionStore::report(const Group& group) const {
    const MotionRequest& first = *group.front();
    const sim::Result& run = first.results.front();
    if (!options_.quiet)
        for (const std::string& warning : run.warnings)
            output::print_message("warning: {}{}{}\n", first.label, first.label.empty() ? "" : ": ", warning);
    if (options_.verbose && run.counters.steps > 0)
        output::print_message(
            "motion{}{}: {}, {}, {} in {}, energy error {:.2e} J of "
            "{:.3g} J\n",
            first.label.empty() ? "" : " of ", first.label, counted(run.counters.steps, "step"),
            counted(run.counters.rhs_evaluations, "right-hand side"), counted(run.impacts.size(), "impact"),
            counted(run.collisions.size(), "collision"), run.energy_residual_max, run.energy_scale);
}

sim::Result MotionStore::find_events(const sim::Problem& problem, const sim::Request& request, double far) {
    sim::Request further;
    further.end_time = far;
    const sim::Request both[] = {request, further};
    const double until = latest(both);
    const ProgressStage stage(progress_, "impacts", until, "s");
    return std::move(run({motion_key(problem), problem, both, until, true, true}, [this](double t) {
                         return progress_.reach(t);
                     }).front());
}

// ---- one motion ------------------------------------------------------------------------------------

std::vector<sim::Result> MotionStore::run(const Job& job, const sim::Progress& progress) {
    const auto start = Clock::now();
    auto results = read_back(job, progress);
    const bool was_kept = results.has_value();
    if (!results) results = integrate(job, progress);
    long steps = 0;
    for (const sim::Result& result : *results) steps = std::max(steps, result.counters.steps);
    note(job, was_kept, seconds_since(start), steps);
    return std::move(*results);
}

void MotionStore::note(const Job& job, bool read_back, double seconds, long steps) {
    if (!history_) return;
    const bool horizon = std::ranges::any_of(job.requests, &sim::Request::horizon);
    const std::lock_guard lock(mutex_);
    history_->note(motion_work(job.key, job.problem, read_back, horizon), job.until, seconds,
                   static_cast<double>(steps));
}

std::optional<std::vector<sim::Result>> MotionStore::read_back(const Job& job, const sim::Progress& progress) {
    // A shorter trajectory may contain the events of a search.
    const bool search = std::ranges::any_of(job.requests, [](const sim::Request& r) { return r.enough.has_value(); });
    const auto replay = [&](const sim::Trajectory& trajectory) -> std::optional<std::vector<sim::Result>> {
        const bool whole = trajectory.end() >= job.until;
        if (!whole && !search) return std::nullopt;
        try {
            sim::Effort effort;
            auto results = sim::replay(job.problem, trajectory, job.requests, progress, &effort);
            const std::lock_guard lock(mutex_);
            effort_.add(effort);
            return results;
        } catch (const std::invalid_argument&) {
            if (whole) throw;
            return std::nullopt;
        }
    };
    if (const auto known = remembered_.find(job.key); known != remembered_.end())
        if (auto results = replay(sim::Trajectory(job.problem, known->second))) return results;
    if (!cache_) return std::nullopt;
    const auto numbers = cache_->load(job.key, search ? 0 : job.until);
    if (!numbers) return std::nullopt;
    try {
        auto results = replay(sim::Trajectory(job.problem, numbers));
        const std::lock_guard lock(mutex_);
        if (results) ++from_cache_;
        return results;
    } catch (const std::invalid_argument&) {  // a valid checksum, but not a trajectory of this motion
        cache_->drop(job.key);
        return std::nullopt;
    }
}

std::vector<sim::Result> MotionStore::integrate(const Job& job, const sim::Progress& progress) {
    std::optional<Cache::Entry> entry;
    if (job.keep && cache_) entry.emplace(*cache_, job.key);
    const auto remembered = std::make_shared<NumberSpool>();
    bool remember = job.remember;
    sim::TrajectoryWriter writer([&](std::span<const double> numbers) {
        if (entry) entry->add(numbers);
        remember = remember && remembered->size() + numbers.size() <= kMostRemembered;
        if (remember) remembered->add(numbers);
    });
    sim::Effort effort;
    auto results = sim::simulate(job.problem, job.requests, progress, entry || remember ? &writer : nullptr, &effort);
    const std::lock_guard lock(mutex_);
    effort_.add(effort);
    if (remember && writer.complete()) remembered_[job.key] = remembered;
    if (!entry || !writer.complete() || writer.steps() < fewest_steps(job.problem)) return results;
    if (entry->commit(writer.reached(), writer.steps(), describe(job.problem)))
        ++kept_;
    else if (options_.verbose || (entry->too_large() && !options_.quiet))  // each run will integrate it again
        output::print_message("the motion was not added to the cache: {}\n", entry->why());
    return results;
}

}  // namespace beamcam::scenes
