#include "scenes/motions/motion_pool.hpp"

#include <algorithm>
#include <functional>

#include "output/files/standard_output.hpp"
#include "scenes/motions/fan_out.hpp"
#include "sim/base/counted.hpp"
#include "sim/observe/recorder.hpp"

namespace beamcam::scenes {
namespace {

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

std::size_t MotionPool::add(MotionRequest request) {
    entries_.push_back({std::move(request), {}});
    return entries_.size() - 1;
}

sim::Result& MotionPool::result(std::size_t request) {
    Entry& entry = entries_[request];
    if (entry.failure) std::rethrow_exception(entry.failure);
    return entry.result;
}

const sim::Result* MotionPool::partial(std::size_t request) const {
    return entries_[request].partial ? &entries_[request].result : nullptr;
}

std::vector<MotionPool::Group> MotionPool::groups() {
    std::vector<Group> all;
    for (; computed_ < entries_.size(); ++computed_) {
        Entry& entry = entries_[computed_];
        const auto same = std::ranges::find_if(
            all, [&](const Group& group) { return group.front()->wanted.key == entry.wanted.key; });
        if (same == all.end())
            all.push_back({&entry});
        else
            same->push_back(&entry);
    }
    // The request that reaches furthest comes first: its warnings hold for all.
    for (Group& group : all)
        std::ranges::stable_sort(group, std::greater(), [](const Entry* e) { return end_of(e->wanted.request); });
    return all;
}

void MotionPool::compute() {
    const std::vector<Group> all = groups();
    if (all.empty()) return;
    motions_ += all.size();
    double total = 0;
    for (const Group& group : all) total += end_of(group.front()->wanted.request);
    ProgressSum sum(all.size(), progress_);
    progress_.begin("simulate", total, "s");
    fan_out(all.size(), options_.threads, [&](std::size_t k) { compute(all[k], sum.of(k)); });
    progress_.end();
    for (const Group& group : all) report(group);
}

void MotionPool::compute(const Group& group, const sim::Progress& progress) {
    std::vector<sim::Request> requests;
    for (const Entry* entry : group) requests.push_back(entry->wanted.request);
    try {
        std::vector<sim::Result> results = integrate(group.front()->wanted.problem, requests, progress);
        for (std::size_t i = 0; i < group.size(); ++i) group[i]->result = std::move(results[i]);
    } catch (const sim::SolverError& error) {
        Group earlier;  // these requests end before the failure
        for (std::size_t i = 0; i < group.size(); ++i) {
            if (i > 0 && end_of(requests[i]) < error.last_time) {
                earlier.push_back(group[i]);
                continue;
            }
            group[i]->failure = std::current_exception();
            group[i]->partial = !error.partials.empty();
            if (group[i]->partial) group[i]->result = error.partials[i];
        }
        if (!earlier.empty()) compute(earlier, progress);
    }
}

void MotionPool::report(const Group& group) const {
    const auto done = std::ranges::find(group, nullptr, &Entry::failure);
    if (done == group.end()) return;
    const sim::Result& run = (*done)->result;
    std::string label = group.front()->wanted.file;
    for (const Entry* entry : group)
        if (entry->wanted.file.empty()) label.clear();
    if (const std::string& name = group.front()->wanted.label; !label.empty() && !name.empty()) label += ", " + name;
    if (!options_.quiet)
        for (const std::string& warning : run.warnings)
            output::print_message("warning: {}{}{}\n", label, label.empty() ? "" : ": ", warning);
    if (options_.verbose && run.counters.steps > 0)
        output::print_message("motion{}{}: {}, {}, {} in {}, energy error {:.2e} J of {:.3g} J\n",
                              label.empty() ? "" : " of ", label, counted(run.counters.steps, "step"),
                              counted(run.counters.rhs_evaluations, "right-hand side"),
                              counted(run.impacts.size(), "impact"), counted(run.collisions.size(), "collision"),
                              run.energy_residual_max, run.energy_scale);
}

sim::Result MotionPool::find_events(const sim::Problem& problem, const sim::Request& request) {
    progress_.begin("impacts", end_of(request), "s");
    auto results = integrate(problem, {&request, 1}, [this](double t) { return progress_.reach(t); });
    progress_.end();
    return std::move(results.front());
}

std::vector<sim::Result> MotionPool::integrate(const sim::Problem& problem, std::span<const sim::Request> requests,
                                               const sim::Progress& progress) {
    sim::Effort effort;
    auto results = sim::simulate(problem, requests, progress, &effort);
    const std::lock_guard lock(mutex_);
    effort_.add(effort);
    return results;
}

}  // namespace beamcam::scenes
