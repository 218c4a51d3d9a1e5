// The motions that the outputs of one run need: each is integrated once, or read from the cache (cache.hpp). Different
// motions are integrated in parallel.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/motions/cache.hpp"
#include "scenes/motions/history.hpp"
#include "scenes/motions/progress.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

class MotionStore {
  public:
    struct Options {
        int threads = 1;
        bool quiet = false, verbose = false;
    };
    // `cache` and `history` may be null; they and `progress` must outlive this.
    MotionStore(const Cache* cache, History* history, Progress& progress, const Options& options)
        : cache_(cache), history_(history), progress_(progress), options_(options) {}

    // Requests results of a motion and returns the number of the request. `label` precedes its warnings. `may_fail`: if
    // all requests for the motion have it, a failure is a warning, and the results are partial or empty.
    std::size_t request(const sim::Problem& problem, std::vector<sim::Request> requests, const std::string& label = {},
                        bool may_fail = false);
    // Computes all requests. Throws what sim::simulate throws.
    void compute();
    // One result for each sim::Request, with the same bits as in a run for it alone.
    std::vector<sim::Result> take_results(std::size_t request) { return std::move(requests_[request].results); }
    // The partial results of a failed integration; empty if another motion failed.
    const std::vector<sim::Result>& partial_results(std::size_t request) const { return requests_[request].partial; }

    // Computes a result immediately, for plans that depend on events. The trajectory is stored, at least until `far`
    // [s], so that later requests until then need no second integration.
    sim::Result find_events(const sim::Problem& problem, const sim::Request& request, double far);

    const sim::Effort& effort() const { return effort_; }
    long from_cache() const { return from_cache_; }
    long kept() const { return kept_; }

  private:
    struct MotionRequest {
        std::string key;
        sim::Problem problem;
        std::vector<sim::Request> requests;
        std::string label;
        bool may_fail = false;
        std::vector<sim::Result> results, partial;
    };
    using Group = std::vector<MotionRequest*>;  // the requests for one motion
    struct Job {
        const std::string& key;
        const sim::Problem& problem;
        std::span<const sim::Request> requests;
        double until = 0;       // latest time that they need [s]
        bool keep = false;      // in the cache
        bool remember = false;  // in remembered_
    };

    std::vector<Group> groups();
    void compute(const Group& group, const sim::Progress& progress);
    void report(const Group& group) const;
    std::vector<sim::Result> run(const Job& job, const sim::Progress& progress);
    void note(const Job& job, bool read_back, double seconds, long steps);
    std::optional<std::vector<sim::Result>> read_back(const Job& job, const sim::Progress& progress);
    std::vector<sim::Result> integrate(const Job& job, const sim::Progress& progress);

    const Cache* cache_;
    History* history_;
    Progress& progress_;
    Options options_;
    std::deque<MotionRequest> requests_;
    std::size_t computed_ = 0;  // number of computed requests
    // Trajectories of find_events, by motion.
    std::map<std::string, std::shared_ptr<const sim::NumberSource>> remembered_;
    std::mutex mutex_;  // guards the counts
    sim::Effort effort_;
    long from_cache_ = 0, kept_ = 0;
};

// True if caching the trajectory saves time for this request. Requests for extrema and events only do not pay for it,
// and the steps of ARKODE cannot be stored as numbers.
bool worth_keeping(const sim::Problem& problem, const sim::Request& request);

}  // namespace beamcam::scenes
