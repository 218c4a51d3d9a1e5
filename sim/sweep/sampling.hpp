// The data that a sweep keeps of each motion: samples after a transient, and the states by which the motion is
// classified. MODEL.md §18.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::sim {

// States are compared at this share of a turn of the cam after the start. It is not zero, because a motion that starts
// on its orbit may have an impact there, at which the rate jumps.
inline constexpr double kStrobePhase = 0.381966;

enum class SampleKind {
    impacts,    // each touch, except the end of chatter
    section,    // stroboscopic: the cam's angle ψ equals `level`, modulo 2π
    apexes,     // maxima of θ
    crossings,  // `channel` passes `level` in the given direction
    peaks       // one for all: the largest force, stress, gap … of the time that is kept
};

// A number of cam turns, or a time that is rounded up to whole cam turns.
struct CamSpan {
    double turns = 0;            // >= 0, whole
    std::optional<double> time;  // [s], >= 0; replaces the turns
    bool operator==(const CamSpan&) const = default;
};

struct Sampling {
    SampleKind kind = SampleKind::impacts;
    Channel channel;  // of `crossings`
    double level = 0;
    bool rising = true;
    CamSpan transient{200, {}}, keep{50, {}};
    bool exponents = false;  // also compute the largest Lyapunov exponent of each motion, which may show chaos

    bool operator==(const Sampling&) const = default;
};

// Start of the samples and end of the motion, in whole turns of the cam.
struct SampleSpan {
    long from = 0, to = 0;  // turns, from < to
    double period = 1;      // [s]
    double t_from() const { return static_cast<double>(from) * period; }
    double t_to() const { return static_cast<double>(to) * period; }
    long kept() const { return to - from; }
};
SampleSpan sample_span(const Problem& problem, const Sampling& sampling);

// The columns of a sample, in the order of the files. NaN: does not apply.
enum SampleColumn : std::size_t {
    kSampleTime,
    kCamPhase,  // fraction of a turn of the cam since the start: 0 … 1
    kTheta,
    kThetaDot,
    kContactX,
    kCamAngle,
    kNormalBefore,  // at an impact, as in Impact
    kTangentialBefore,
    kNormalAfter,
    kTangentialAfter,
    kDuration,
    kForcePeak,  // of the time that is kept: only SampleKind::peaks
    kStressPeak,
    kGapPeak,
    kReboundPeak,
    kImpactCount,
    kDurationPeak,
    kLiftShare,
    kSampleColumns
};
using MotionSample = std::array<double, kSampleColumns>;
struct SampleColumnInfo {
    const char *name, *unit, *meaning;
    std::optional<SampleKind> only = {};  // NaN in other samples
    bool is_of(SampleKind kind) const { return !only || *only == kind; }
};
const std::array<SampleColumnInfo, kSampleColumns>& sample_columns();

// The state once in each turn of the cam, kStrobePhase after its start.
struct Strobe {
    double theta = 0, theta_dot = 0;
    long impacts = 0;       // since the start of the samples
    bool touching = false;  // in sustained contact
    bool left = false;      // the beam left the cam since the previous strobe
};

struct SampledMotion {
    std::vector<MotionSample> samples;
    std::vector<Strobe> strobes;  // one for each turn of the samples
    bool over_the_top = false;    // the motion ended because the beam pointed away from the cam
    InitialState end;             // initial state of the motion at the next parameter
    long impacts = 0;             // including the transient
    double accuracy = 0;          // approximate error of angles [rad]
    std::string failure;          // reason of a failed integration

    bool has_end() const { return !over_the_top && failure.empty(); }
};

}  // namespace beamcam::sim
