// The recorders of all requests of one integration.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "sim/observe/recorder.hpp"

namespace beamcam::sim {

// The recorders of one integration. Each hears of it what it would hear if it were alone and the run
// ended with it: its result does not depend on the others.
class RecorderSet {
  public:
    // The statistics where the integration stands. Asked for after an interval was recorded.
    using StatisticsSource = std::function<RunStatistics()>;

    RecorderSet(const System& system, std::span<const Request> requests);
    double end() const { return end_; }  // the furthest that anybody looks [s]
    bool done() const;                   // all have what their requests ask for

    void begin(const Phase& phase, const std::vector<double>& y);
    // From `from` to `to`, where an event follows or not. `known` are the summary of an earlier run. Returns the
    // summary; null where no recorder takes the whole interval.
    const SegmentSummary* record(const Segment& segment, double from, double to, bool event,
                                 const StatisticsSource& statistics, const SegmentSummary* known = nullptr);
    void touch(double t, const double* y, const ContactState& contact);
    void release(double t, const double* y, const ContactState& contact);
    // After an event, and at the start: the motion goes on from here.
    void resume(double t, const std::vector<double>& y, const Phase& phase, const StatisticsSource& statistics);
    // Nothing follows.
    void give_up(double t, const std::vector<double>& y, const StatisticsSource& statistics);

    std::vector<Result> results();  // in the order of the requests; once

  private:
    bool is_recording(const Recorder& recorder) const {
        return !done_[static_cast<std::size_t>(&recorder - recorders_.data())];
    }
    void finish(Recorder& recorder, double t, const double* y, const StatisticsSource& statistics);

    std::vector<Recorder> recorders_;
    std::vector<char> done_;  // by recorder
    std::vector<double> y_;
    SegmentSummary summary_;
    double end_ = 0;
};

// The last instant that a request looks at [s].
double end_of(const Request& request);

}  // namespace beamcam::sim
