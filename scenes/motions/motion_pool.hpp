// The motions that the outputs of one command need. Requests for the same motion share one integration; different
// motions are integrated in parallel.
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "scenes/motions/motion_request.hpp"
#include "scenes/motions/progress.hpp"

namespace beamcam::scenes {

class MotionPool {
  public:
    struct Options {
        int threads = 1;
        bool quiet = false, verbose = false;
    };
    // `progress` must outlive this.
    MotionPool(Progress& progress, const Options& options) : progress_(progress), options_(options) {}

    // Returns the number of the request.
    std::size_t add(MotionRequest request);
    // Computes all requests that were added since the last call.
    void compute();
    // The result of a request, with the same bits as in a run for it alone. Throws the sim::SolverError of its motion.
    sim::Result& result(std::size_t request);
    // The result of a failed integration until its end; null if it did not fail or did not begin.
    const sim::Result* partial(std::size_t request) const;
    // Integrates immediately, to find events on which other requests depend.
    sim::Result find_events(const sim::Problem& problem, const sim::Request& request);

    std::size_t motions() const { return motions_; }  // that were computed
    const sim::Effort& effort() const { return effort_; }

  private:
    struct Entry {
        MotionRequest wanted;
        sim::Result result;
        bool partial = false;
        std::exception_ptr failure = {};
    };
    using Group = std::vector<Entry*>;  // the requests for one motion

    std::vector<Group> groups();
    void compute(const Group& group, const sim::Progress& progress);
    void report(const Group& group) const;
    std::vector<sim::Result> integrate(const sim::Problem& problem, std::span<const sim::Request> requests,
                                       const sim::Progress& progress);

    Progress& progress_;
    Options options_;
    std::deque<Entry> entries_;
    std::size_t computed_ = 0, motions_ = 0;  // numbers of computed entries, and of their motions
    std::mutex mutex_;                        // guards the effort
    sim::Effort effort_;
};

}  // namespace beamcam::scenes
