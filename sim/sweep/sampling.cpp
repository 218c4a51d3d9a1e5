#include "sim/sweep/sampling.hpp"

#include <algorithm>
#include <cmath>

#include "sim/sweep/constants.hpp"

namespace beamcam::sim {

SampleSpan sample_span(const Problem& problem, const Sampling& sampling) {
    SampleSpan span;
    span.period = cam_period(problem);
    const auto turns = [&](const CamSpan& s) {
        return static_cast<long>(std::ceil(s.time ? *s.time / span.period * (1 - kWholeTurn) : s.turns));
    };
    span.from = std::max(0L, turns(sampling.transient));
    span.to = span.from + std::max(1L, turns(sampling.keep));
    return span;
}

const std::array<SampleColumnInfo, kSampleColumns>& sample_columns() {
    static const std::array<SampleColumnInfo, kSampleColumns> columns{{
        {"t", "s", "Time since the start of the motion", false},
        {"cam_phase", "1", "Fraction of a turn of the cam since the start", false},
        {"theta", "rad", "Angle of the hub", false},
        {"theta_dot", "rad/s", "Rate of the hub's angle; at an impact, before it", false},
        {"contact_x", "m", "Position of the contact along the beam", true},
        {"cam_angle", "rad", "Angle of the cam, unwrapped", false},
        {"v_n_before", "m/s", "Normal speed at the touch; negative approaches", true},
        {"v_t_before", "m/s", "Tangential speed at the touch, beam minus cam", true},
        {"v_n_after", "m/s", "Normal speed at the release", true},
        {"v_t_after", "m/s", "Tangential speed at the release", true},
        {"duration", "s", "Duration of the contact", true},
    }};
    return columns;
}

}  // namespace beamcam::sim
