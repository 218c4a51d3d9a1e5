// Everything that a run produces: its recorders and, if there are, the writer of its trajectory and an observer.
#pragma once

#include <algorithm>

#include "sim/observe/recorder_set.hpp"
#include "sim/observe/trajectory.hpp"
#include "sim/run/motion_observer.hpp"
#include "sim/run/run_state.hpp"

namespace beamcam::sim {

class RunOutput {
  public:
    RunOutput(const System& system, std::span<const Request> requests, TrajectoryWriter* keep, MotionObserver* observer,
              RecorderSet::StatisticsSource statistics)
        : recorders_(system, requests), keep_(keep), observer_(observer), statistics_(std::move(statistics)) {}

    double end() const { return observer_ ? std::max(recorders_.end(), observer_->end()) : recorders_.end(); }
    bool done() const { return observer_ ? observer_->done() : recorders_.done(); }
    void begin(const RunState& s) {
        recorders_.begin(s.phase, s.y);
        if (keep_) keep_->begin(s.phase, s.y);
    }
    void segment(const Segment& segment, double from, double to, bool event) {
        const SegmentSummary* summary = recorders_.record(segment, from, to, event, statistics_);
        if (keep_) keep_->record(segment, from, to, event, statistics_(), summary);
        if (observer_) observer_->segment({&segment, from, to, to == end() && !event});
    }
    void touch(double t, const std::vector<double>& y, const ContactState& c) {
        recorders_.touch(t, y.data(), c);
        if (keep_) keep_->touch(t, y, c);
        if (observer_) observer_->touch(t, y, c);
    }
    void release(double t, const std::vector<double>& y, const ContactState& c) {
        recorders_.release(t, y.data(), c);
        if (keep_) keep_->release(t, y, c);
        if (observer_) observer_->release(t, y, c);
    }
    // The motion goes on from here: after an event, and at the start.
    void resume(const RunState& s) {
        recorders_.resume(s.t, s.y, s.phase, statistics_);
        if (keep_) keep_->resume(s.t, s.y, s.phase, statistics_());
        if (observer_) observer_->resume(s.t, s.y, s.phase);
    }
    std::vector<Result> finish(const RunState& s) {
        if (keep_) keep_->end(s.t);
        return recorders_.results();
    }
    std::vector<Result> fail(const RunState& s) {
        recorders_.give_up(s.t, s.y, statistics_);
        return recorders_.results();
    }

  private:
    RecorderSet recorders_;
    TrajectoryWriter* keep_;
    MotionObserver* observer_;
    RecorderSet::StatisticsSource statistics_;
};

}  // namespace beamcam::sim
