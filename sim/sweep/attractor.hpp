// Classification of a motion after its transient. MODEL.md (S86)–(S89b).
#pragma once

#include <span>

#include "sim/sweep/sampling.hpp"

namespace beamcam::sim {

enum class AttractorClass {
    rest,          // nothing moves
    following,     // the beam never leaves the cam
    periodic,      // (n, m): n turns of the cam, m impacts
    chaotic,       // the largest exponent exceeds three times its error
    aperiodic,     // no period, or one that depends on rounding, and an exponent that is zero, unknown or doubtful
    over_the_top,  // the beam leaves the half plane of the cam
    unsettled      // the transient is not over, or the integration failed
};
inline std::span<const Named<AttractorClass>> names(AttractorClass) {
    using enum AttractorClass;
    static constexpr Named<AttractorClass> all[] = {
        {rest, "rest"},           {following, "following"},       {periodic, "periodic"},  {chaotic, "chaotic"},
        {aperiodic, "aperiodic"}, {over_the_top, "over-the-top"}, {unsettled, "unsettled"}};
    return all;
}

// True if samples of a motion of this class form a section of its attractor.
bool has_section(AttractorClass kind);

// The largest Lyapunov exponent over the samples [1/s], with the standard error from blocks. NaN: unknown; −∞:
// sustained contact annihilates all differences.
struct LargestExponent {
    double value = kNan, error = kNan;
    double late_growth = kNan;  // logarithm of the growth of differences in the later half of the turns
    double doubt = 0;           // amount by which near-grazing impacts may make it too large (S74) [1/s]
};

struct Attractor {
    AttractorClass kind = AttractorClass::unsettled;
    int period = 0;                    // turns of the cam; 0: none
    double impacts_per_period = kNan;  // without a period: per turn
    LargestExponent exponent;
};

// The class of a motion without period, given its exponent.                                                    (S89)
Attractor with_exponent(Attractor attractor, const LargestExponent& exponent);

// (S86)–(S89)
Attractor classify(const Problem& problem, const SampledMotion& motion);

}  // namespace beamcam::sim
