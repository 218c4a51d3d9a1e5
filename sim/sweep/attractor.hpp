// What a motion does after its transient, by stated criteria. MODEL.md §18.
#pragma once

#include <span>

#include "sim/problem/keys.hpp"
#include "sim/sweep/sampling.hpp"

namespace beamcam::sim {

enum class AttractorClass {
    rest,            // nothing moves
    following,       // the beam never leaves the cam
    periodic,        // (n, m): n turns of the cam, m impacts
    quasi_periodic,  // no period, and the largest exponent is zero within its error
    chaotic,         // the largest exponent is positive beyond its error
    aperiodic,       // no period within the samples; the exponent is not known, or doubtful
    over_the_top,    // the beam leaves the half plane of the cam
    unsettled        // the transient is not over, or the motion could not be followed
};
std::span<const Named<AttractorClass>> names(AttractorClass);
const char* name(AttractorClass);
// Whether samples of such a motion are a section of its attractor.
bool has_section(AttractorClass kind);

// The largest Lyapunov exponent over the samples, per second, with the standard error of its mean over blocks.
struct LargestExponent {
    double value = kNan, error = kNan;
    double late_growth = kNan;  // logarithm of what the later half of the turns alone multiplies differences by
};

struct Attractor {
    AttractorClass kind = AttractorClass::unsettled;
    int period = 0;                    // turns of the cam; 0: none
    double impacts_per_period = kNan;  // of an attractor without period: per turn
    LargestExponent exponent;  // NaN where it is not known; −∞ where lasting contact forgets every difference
};

// The class of a motion without period when its exponent has become known.                                     (S89)
Attractor with_exponent(const Problem& problem, Attractor attractor, const LargestExponent& exponent);

// (S86)–(S89)
Attractor classify(const Problem& problem, const SampledMotion& motion);

}  // namespace beamcam::sim
