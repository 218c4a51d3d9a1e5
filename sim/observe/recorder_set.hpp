// The recorders of all requests of one integration. Each records as if it were alone and the run ended with it: its
// result does not depend on the others.
#pragma once

#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "sim/observe/recorder.hpp"

namespace beamcam::sim {

class RecorderSet {
  public:
    // The statistics where the integration stands; called after an interval was recorded.
    using StatisticsSource = std::function<RunStatistics()>;

    RecorderSet(const System& system, std::span<const Request> requests);
    double end() const { return end_; }  // last instant of all requests [s]
    bool done() const;                   // every request is complete

    void begin(const Phase& phase, const std::vector<double>& y);
    // From `from` to `to`, where an event follows or not.
    void record(const Segment& segment, double from, double to, bool event, const StatisticsSource& statistics);
    void touch(double t, const double* y, const ContactState& contact);
    void release(double t, const double* y, const ContactState& contact);
    // After an event, and at the start: the motion goes on from here.
    void resume(double t, const std::vector<double>& y, const Phase& phase, const StatisticsSource& statistics);
    // Nothing follows.
    void give_up(double t, const std::vector<double>& y, const StatisticsSource& statistics);

    std::vector<Result> results();  // in the order of the requests; once

  private:
    template <class F>
    void each_unfinished(F&& visit);

    SharedSamples shared_;  // of the step that is recorded
    std::deque<Recorder> recorders_;
    std::vector<double> y_;
    double end_ = 0;
};

}  // namespace beamcam::sim
