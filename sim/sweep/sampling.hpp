// What a sweep keeps of each motion: samples after a transient, and the states by which its attractor is judged.
// MODEL.md §18.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::sim {

enum class SampleKind {
    impacts,   // each touch, but not the end of chatter
    section,   // stroboscopic: the cam's angle ψ is `level` up to whole turns
    apexes,    // maxima of θ
    crossings  // `channel` passes `level` in the given direction
};

// A number of cam turns, or a time that is rounded up to whole cam turns.
struct CamSpan {
    double turns = 0;            // >= 0, whole
    std::optional<double> time;  // [s], >= 0; takes the place of the turns
    bool operator==(const CamSpan&) const = default;
};

struct Sampling {
    SampleKind kind = SampleKind::impacts;
    Channel channel;  // of `crossings`
    double level = 0;
    bool rising = true;
    CamSpan transient{200, {}}, keep{50, {}};
    double end_time = std::numeric_limits<double>::infinity();  // [s], beyond which no motion is followed

    bool operator==(const Sampling&) const = default;
};

// When the samples begin and the motion ends, in whole turns of the cam.
struct SampleSpan {
    long from = 0, to = 0;  // turns, from < to
    double period = 1;      // [s]
    double t_from() const { return static_cast<double>(from) * period; }
    double t_to() const { return static_cast<double>(to) * period; }
    long kept() const { return to - from; }
};
SampleSpan sample_span(const Problem& problem, const Sampling& sampling);

// One sample; what does not apply is NaN. The columns of the files, in this order.
enum SampleColumn : std::size_t {
    kSampleTime,
    kCamPhase,  // turns of the cam since the start, without the whole ones: 0 … 1
    kTheta,
    kThetaDot,
    kContactX,
    kCamAngle,
    kNormalBefore,  // at an impact, as in Impact
    kTangentialBefore,
    kNormalAfter,
    kTangentialAfter,
    kDuration,
    kSampleColumns
};
using MotionSample = std::array<double, kSampleColumns>;
struct SampleColumnInfo {
    const char *name, *unit, *meaning;
    bool of_impacts;  // NaN in other samples
};
const std::array<SampleColumnInfo, kSampleColumns>& sample_columns();

// The state once a turn of the cam. Not at the angle of the start, at which a motion that begins on its orbit may have
// an impact, before and after which rates differ: so many turns later.
inline constexpr double kStrobePhase = 0.381966;
struct Strobe {
    double theta = 0, theta_dot = 0;
    long impacts = 0;       // so far, from the start of the samples
    bool touching = false;  // in lasting contact
    bool left = false;      // flight since the strobe before
    double growth = kNan;   // of the largest tangent vector since the strobe before: its logarithm; NaN: not followed
};

struct SampledMotion {
    std::vector<MotionSample> samples;
    std::vector<Strobe> strobes;  // one in each turn of the samples
    bool over_the_top = false;    // the beam pointed away from the cam; the motion ended there
    bool all_following = false;   // it follows the cam for ever, by the sign of the contact force over a whole turn
    InitialState end;             // to go on from at another parameter; its ledger is that of a start
    long impacts = 0;             // all, with those of the transient
    double accuracy = 0;          // of its angles, about [rad]
    std::string failure;          // why the motion could not be followed to its end
};

}  // namespace beamcam::sim
