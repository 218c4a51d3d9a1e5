// The motions that the outputs of one call look at: each is integrated once, whoever asks, or read back from an earlier
// run (cache.hpp). Different motions side by side on several threads.
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
    // `cache` and `history`: null when there are none; they and `progress` must outlive this.
    MotionStore(const Cache* cache, History* history, Progress& progress, const Options& options)
        : cache_(cache), history_(history), progress_(progress), options_(options) {}

    // Somebody wants this of a motion; `label` stands before its warnings. Returns the wish's number. A motion that all
    // who want it can do without may fail: that is told, and its results are what it reached, or empty.
    std::size_t request(const sim::Problem& problem, std::vector<sim::Request> requests, const std::string& label = {},
                        bool may_fail = false);
    // Fulfils all wishes. Throws what sim::simulate throws.
    void compute();
    // One for each request; with the bits of the run that the request had been alone.
    std::vector<sim::Result> take_results(std::size_t request) { return std::move(requests_[request].results); }
    // What a failed integration reached; nothing where it was another motion that failed.
    const std::vector<sim::Result>& partial_results(std::size_t request) const { return requests_[request].partial; }

    // At once, for whoever must know it before anything else can be asked. The motion is remembered as far as the
    // request needs, at least until `far` [s], so that wishes until then cost no second integration.
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
    using Group = std::vector<MotionRequest*>;  // of one motion
    struct Job {
        const std::string& key;
        const sim::Problem& problem;
        std::span<const sim::Request> requests;
        double until = 0;       // the latest that they look at [s]
        bool keep = false;      // on disk
        bool remember = false;  // for this call
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
    std::size_t computed_ = 0;  // so many of the first
    // Trajectories of `find`, by motion.
    std::map<std::string, std::shared_ptr<const sim::NumberSource>> remembered_;
    std::mutex mutex_;  // of the counts
    sim::Effort effort_;
    long from_cache_ = 0, kept_ = 0;
};

// Whether a trajectory pays to be kept for what is asked of it: extremes and events alone would only pay for it, and
// the steps of ARKODE's method are more than numbers.
bool worth_keeping(const sim::Problem& problem, const sim::Request& request);

}  // namespace beamcam::scenes
