// The trace of the contact: the largest force so far at each place of the disc's rim and of the beam's face.
//
// Samples are sorted into bins a pixel wide.
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

struct Trace {
    std::vector<float> rim, beam;  // the largest force of each bin; 0: never touched
};
// Of the samples up to and at t. Numbers of bins on the rim of the given circumference and on the beam of the given
// length, each >= 1.
Trace trace_until(std::span<const TraceSample> samples, double t, double circumference, std::size_t rim_places,
                  double length, std::size_t beam_places);

}  // namespace beamcam::render
