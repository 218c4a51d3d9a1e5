// The trace of the contact: the largest force so far at each place of the disc's rim and of the beam's face.
//
// Samples are sorted into bins a pixel wide. The maximum does not depend on the order of the samples, so the trace is
// the same in whatever order frames are drawn.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/observe/channels.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::render {

struct TraceSample {
    double t = 0, x = 0, s = 0, force = 0;  // [s], on the beam [m], on the disc from its mark [m], [N]
};
// The rows of the table in contact (force > 0, defined places), sorted by time, and a sample for each impact that falls
// between them: its place at touch and its peak force. Missing columns give no samples.
std::vector<TraceSample> contact_samples(const sim::Table& table, std::span<const sim::Impact> impacts);

class Trace {
  public:
    // Numbers of bins on the rim of the given circumference and on the beam of the given length, each >= 1.
    Trace(std::span<const TraceSample> samples, double circumference, std::size_t rim_places, double length,
          std::size_t beam_places);
    void advance_to(double t);                              // includes samples at t; going back is possible
    const std::vector<float>& rim() const { return rim_; }  // 0: never touched
    const std::vector<float>& beam() const { return beam_; }

  private:
    std::span<const TraceSample> samples_;
    double circumference_, length_;
    std::vector<float> rim_, beam_;
    std::size_t shown_ = 0;
};

}  // namespace beamcam::render
