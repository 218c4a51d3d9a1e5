// The output of a run: recorders and, optionally, an observer. They receive accepted segments only, so that output
// never changes the motion.
#pragma once

#include <algorithm>

#include "sim/observe/recorder_set.hpp"
#include "sim/run/run_state.hpp"

namespace beamcam::sim {

// Follows a run beside its recorders and may end it. The sampler of a sweep is one.
class MotionObserver {
  public:
    virtual ~MotionObserver() = default;
    virtual double end() const = 0;  // latest end of the run [s]
    // A phase begins: at the start and after every event.
    virtual void resume(double t, const std::vector<double>& y, const Phase& phase) = 0;
    virtual void segment(const SegmentInterval& s) = 0;
    virtual void touch(double t, const std::vector<double>& y, const ContactState& contact) = 0;
    virtual void release(double t, const std::vector<double>& y, const ContactState& contact) = 0;
    virtual bool done() const = 0;  // true ends the run
};

class RunOutput {
  public:
    RunOutput(const System& system, std::span<const Request> requests, MotionObserver* observer,
              RecorderSet::StatisticsSource statistics)
        : recorders_(system, requests), observer_(observer), statistics_(std::move(statistics)) {}

    double end() const { return observer_ ? std::max(recorders_.end(), observer_->end()) : recorders_.end(); }
    bool done() const { return observer_ ? observer_->done() : recorders_.done(); }
    void begin(const RunState& s) { recorders_.begin(s.phase, s.y); }
    void segment(const Segment& segment, double from, double to, bool event) {
        recorders_.record(segment, from, to, event, statistics_);
        if (observer_) observer_->segment({&segment, from, to, to == end() && !event});
    }
    void touch(double t, const std::vector<double>& y, const ContactState& c) {
        recorders_.touch(t, y.data(), c);
        if (observer_) observer_->touch(t, y, c);
    }
    void release(double t, const std::vector<double>& y, const ContactState& c) {
        recorders_.release(t, y.data(), c);
        if (observer_) observer_->release(t, y, c);
    }
    // A phase begins.
    void resume(const RunState& s) {
        recorders_.resume(s.t, s.y, s.phase, statistics_);
        if (observer_) observer_->resume(s.t, s.y, s.phase);
    }
    std::vector<Result> results() { return recorders_.results(); }
    std::vector<Result> fail(const RunState& s) {
        recorders_.give_up(s.t, s.y, statistics_);
        return recorders_.results();
    }

  private:
    RecorderSet recorders_;
    MotionObserver* observer_;
    RecorderSet::StatisticsSource statistics_;
};

}  // namespace beamcam::sim
