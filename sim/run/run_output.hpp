// Everything that a run produces: its recorders and, if the trajectory is kept, its writer.
#pragma once

#include "sim/observe/observe.hpp"
#include "sim/observe/trajectory.hpp"
#include "sim/run/run_state.hpp"

namespace beamcam::sim {

class RunOutput {
  public:
    RunOutput(const System& system, std::span<const Request> requests, TrajectoryWriter* keep,
              Audience::TallySource tally)
        : audience_(system, requests), keep_(keep), tally_(std::move(tally)) {}

    double end() const { return audience_.end(); }
    void begin(const RunState& s) {
        audience_.begin(s.phase, s.y);
        if (keep_) keep_->begin(s.phase, s.y);
    }
    void segment(const Segment& segment, double from, double to, bool event) {
        const Notes* notes = audience_.stretch(segment, from, to, event, tally_);
        if (keep_) keep_->stretch(segment, from, to, event, tally_(), notes);
    }
    void touch(double t, const std::vector<double>& y, const ContactState& c) {
        audience_.touch(t, y.data(), c);
        if (keep_) keep_->touch(t, y, c);
    }
    void release(double t, const std::vector<double>& y, const ContactState& c) {
        audience_.release(t, y.data(), c);
        if (keep_) keep_->release(t, y, c);
    }
    // The motion goes on from here: after an event, and at the start.
    void resume(const RunState& s) {
        audience_.resume(s.t, s.y, s.phase, tally_);
        if (keep_) keep_->resume(s.t, s.y, s.phase, tally_());
    }
    std::vector<Result> finish() {
        if (keep_) keep_->end(end());
        return audience_.results();
    }
    std::vector<Result> fail(const RunState& s) {
        audience_.give_up(s.t, s.y, tally_);
        return audience_.results();
    }

  private:
    Audience audience_;
    TrajectoryWriter* keep_;
    Audience::TallySource tally_;
};

}  // namespace beamcam::sim
