// The motions that the outputs of one run need: each is integrated once. Different motions are integrated in parallel.
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "scenes/motions/progress.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

class MotionStore {
  public:
    struct Options {
        int threads = 1;
        bool quiet = false, verbose = false;
    };
    // `progress` must outlive this.
    MotionStore(Progress& progress, const Options& options) : progress_(progress), options_(options) {}

    // Requests results of a motion and returns the number of the request. `label` precedes its warnings.
    std::size_t request(const sim::Problem& problem, std::vector<sim::Request> requests, const std::string& label = {});
    // Computes all requests. Throws what sim::simulate throws.
    void compute();
    // One result for each sim::Request, with the same bits as in a run for it alone.
    std::vector<sim::Result> take_results(std::size_t request) { return std::move(requests_[request].results); }
    // The partial results of a failed integration; empty if another motion failed.
    const std::vector<sim::Result>& partial_results(std::size_t request) const { return requests_[request].partial; }

    // Integrates immediately, for plans that depend on events.
    sim::Result find_events(const sim::Problem& problem, const sim::Request& request);

    const sim::Effort& effort() const { return effort_; }

  private:
    struct MotionRequest {
        std::string key;
        sim::Problem problem;
        std::vector<sim::Request> requests;
        std::string label;
        std::vector<sim::Result> results, partial;
    };
    using Group = std::vector<MotionRequest*>;  // the requests for one motion

    std::vector<Group> groups();
    void compute(const Group& group, const sim::Progress& progress);
    void report(const Group& group) const;
    std::vector<sim::Result> integrate(const sim::Problem& problem, std::span<const sim::Request> requests,
                                       const sim::Progress& progress);

    Progress& progress_;
    Options options_;
    std::deque<MotionRequest> requests_;
    std::size_t computed_ = 0;  // number of computed requests
    std::mutex mutex_;          // guards the effort
    sim::Effort effort_;
};

}  // namespace beamcam::scenes
