// Everything that a run produces: its recorders and, if the trajectory is kept, its writer.
#pragma once

#include "sim/observe/recorder_set.hpp"
#include "sim/observe/trajectory.hpp"
#include "sim/run/run_state.hpp"

namespace beamcam::sim {

class RunOutput {
  public:
    RunOutput(const System& system, std::span<const Request> requests, TrajectoryWriter* keep,
              RecorderSet::StatisticsSource statistics)
        : recorders_(system, requests), keep_(keep), statistics_(std::move(statistics)) {}

    double end() const { return recorders_.end(); }
    void begin(const RunState& s) {
        recorders_.begin(s.phase, s.y);
        if (keep_) keep_->begin(s.phase, s.y);
    }
    void segment(const Segment& segment, double from, double to, bool event) {
        const SegmentSummary* summary = recorders_.record(segment, from, to, event, statistics_);
        if (keep_) keep_->record(segment, from, to, event, statistics_(), summary);
    }
    void touch(double t, const std::vector<double>& y, const ContactState& c) {
        recorders_.touch(t, y.data(), c);
        if (keep_) keep_->touch(t, y, c);
    }
    void release(double t, const std::vector<double>& y, const ContactState& c) {
        recorders_.release(t, y.data(), c);
        if (keep_) keep_->release(t, y, c);
    }
    // The motion goes on from here: after an event, and at the start.
    void resume(const RunState& s) {
        recorders_.resume(s.t, s.y, s.phase, statistics_);
        if (keep_) keep_->resume(s.t, s.y, s.phase, statistics_());
    }
    std::vector<Result> finish() {
        if (keep_) keep_->end(end());
        return recorders_.results();
    }
    std::vector<Result> fail(const RunState& s) {
        recorders_.give_up(s.t, s.y, statistics_);
        return recorders_.results();
    }

  private:
    RecorderSet recorders_;
    TrajectoryWriter* keep_;
    RecorderSet::StatisticsSource statistics_;
};

}  // namespace beamcam::sim
