#include "scenes/motions/motion_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "output/files/standard_output.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/identity.hpp"
#include "sim/base/counted.hpp"
#include "sim/observe/recorder.hpp"

namespace beamcam::scenes {
namespace {

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

std::size_t MotionStore::request(const sim::Problem& problem, std::vector<sim::Request> requests,
                                 const std::string& label) {
    requests_.push_back({motion_key(problem), problem, std::move(requests), label, {}, {}});
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
    const MotionRequest& first = *group.front();
    for (const MotionRequest* wish : group)
        requests.insert(requests.end(), wish->requests.begin(), wish->requests.end());
    const auto hand_out = [&](std::vector<sim::Result> results, std::vector<sim::Result> MotionRequest::*to) {
        auto next = std::make_move_iterator(results.begin());
        for (MotionRequest* wish : group) {
            const auto end = next + static_cast<std::ptrdiff_t>(wish->requests.size());
            (wish->*to).assign(next, end);
            next = end;
        }
    };
    try {
        hand_out(integrate(first.problem, requests, progress), &MotionRequest::results);
    } catch (const sim::SolverError& error) {
        if (!error.partials.empty()) hand_out(error.partials, &MotionRequest::partial);
        throw;
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

sim::Result MotionStore::find_events(const sim::Problem& problem, const sim::Request& request) {
    const ProgressStage stage(progress_, "impacts", end_of(request), "s");
    return std::move(integrate(problem, {&request, 1}, [this](double t) { return progress_.reach(t); }).front());
}

std::vector<sim::Result> MotionStore::integrate(const sim::Problem& problem, std::span<const sim::Request> requests,
                                                const sim::Progress& progress) {
    sim::Effort effort;
    auto results = sim::simulate(problem, requests, progress, &effort);
    const std::lock_guard lock(mutex_);
    effort_.add(effort);
    return results;
}

}  // namespace beamcam::scenes
