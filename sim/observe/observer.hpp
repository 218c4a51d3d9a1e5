// Whoever follows a motion while it is integrated: the recorder of a request, the sampler of a sweep. An observer
// receives accepted steps only and evaluates them through a System of its own, so that it never changes a bit of the
// motion.
#pragma once

#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {

// `segment` restricted to [from, to], in one phase of the motion.
struct SegmentInterval {
    const Segment* segment;
    double from, to;
    bool last;  // the observer's end is at `to`, which belongs to the interval
    bool ends_before(double t) const { return last ? t > to : t >= to; }
};

class Observer {
  public:
    virtual ~Observer() = default;
    virtual double end() const = 0;  // the last instant that it observes [s]
    virtual bool done() const = 0;   // it needs nothing that follows
    // A phase begins: at the start and after every event.
    virtual void resume(double t, const std::vector<double>& y, const Phase& phase) = 0;
    virtual void step(const SegmentInterval& s) = 0;
    virtual void touch(double /*t*/, const std::vector<double>& /*y*/, const ContactState&) {}
    virtual void release(double /*t*/, const std::vector<double>& /*y*/, const ContactState&) {}
};

}  // namespace beamcam::sim
