// Entries with the same mechanics. Each has its own plan, so that its pictures do not depend on the other entries; one
// integration serves the requests of all.
#pragma once

#include <vector>

#include "scenes/plan/plan.hpp"
#include "scenes/regression/entry_test.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

class EntryGroup {
  public:
    void add(EntryTest& test) { jobs_.push_back({&test, {}, 0, 0}); }
    // Adds the counts of simulations and pictures to `all`.
    void run(const RegressionOptions& options, RegressionResult& all);

  private:
    struct Job {
        EntryTest* test = nullptr;
        Plan plan;
        std::size_t motion = 0;  // index of the recorded table in the plan's request
        double until = 0;        // the last instant that the entry shows [s]
    };

    const sim::Problem& problem() const { return jobs_.front().test->entry().scene.problem; }
    void run_alone(const RegressionOptions& options, RegressionResult& all, const sim::SolverError& error);
    static void prepare(Job& job);
    static void record_compared(Job& job);
    static void judge(Job& job, std::vector<sim::Result> results, const RegressionOptions& options);

    std::vector<Job> jobs_;
};

}  // namespace beamcam::scenes
