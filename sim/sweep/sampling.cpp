#include "sim/sweep/sampling.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

SampleSpan sample_span(const Problem& problem, const Sampling& sampling) {
    SampleSpan span;
    span.period = cam_period(problem);
    const auto turns = [&](const CamSpan& s) {
        return static_cast<long>(std::ceil(s.time ? *s.time / span.period * (1 - kLongRounding) : s.turns));
    };
    span.from = std::max(0L, turns(sampling.transient));
    span.to = span.from + std::max(1L, turns(sampling.keep));
    return span;
}

const std::array<SampleColumnInfo, kSampleColumns>& sample_columns() {
    static const std::array<SampleColumnInfo, kSampleColumns> columns{{
        {"t", "s", "Time since the start of the motion; of peaks, that of the largest force"},
        {"cam_phase", "1", "Fraction of a turn of the cam since the start"},
        {"theta", "rad", "Angle of the hub"},
        {"theta_dot", "rad/s", "Rate of the hub's angle; at an impact, before it"},
        {"contact_x", "m", "Position of the contact along the beam", SampleKind::impacts},
        {"cam_angle", "rad", "Angle of the cam, unwrapped"},
        {"v_n_before", "m/s", "Normal speed at the touch; negative approaches", SampleKind::impacts},
        {"v_t_before", "m/s", "Tangential speed at the touch, beam minus cam", SampleKind::impacts},
        {"v_n_after", "m/s", "Normal speed at the release", SampleKind::impacts},
        {"v_t_after", "m/s", "Tangential speed at the release", SampleKind::impacts},
        {"duration", "s", "Duration of the contact", SampleKind::impacts},
        {"force_peak", "N", "Largest contact force; empty without compliant or sustained contact", SampleKind::peaks},
        {"stress_peak", "Pa", "Largest bending stress along the beam", SampleKind::peaks},
        {"gap_peak", "m", "Largest gap", SampleKind::peaks},
        {"rebound_peak", "m/s", "Largest normal speed at a release", SampleKind::peaks},
        {"impacts", "1", "Number of touches", SampleKind::peaks},
        {"duration_peak", "s", "Longest contact", SampleKind::peaks},
        {"lift_share", "1", "Share of the time without contact", SampleKind::peaks},
    }};
    return columns;
}

}  // namespace beamcam::sim
