// One who follows a run beside its recorders, and may end it: the sampler of a sweep. It sees accepted segments only,
// so that it never changes a bit of the motion.
#pragma once

#include <vector>

#include "sim/observe/segment_interval.hpp"

namespace beamcam::sim {

class MotionObserver {
  public:
    virtual ~MotionObserver() = default;
    virtual double end() const = 0;  // of the run, at most [s]
    // The motion goes on from here in this phase: at the start and after every event.
    virtual void resume(double t, const std::vector<double>& y, const Phase& phase) = 0;
    virtual void segment(const SegmentInterval& s) = 0;
    virtual void touch(double t, const std::vector<double>& y, const ContactState& contact) = 0;
    virtual void release(double t, const std::vector<double>& y, const ContactState& contact) = 0;
    // True: nothing more is wanted of the run.
    virtual bool done() const = 0;
};

}  // namespace beamcam::sim
