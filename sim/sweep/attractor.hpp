// Classification of a motion after its transient. MODEL.md (S86)–(S89).
#pragma once

#include <span>

#include "sim/sweep/sampling.hpp"

namespace beamcam::sim {

enum class AttractorClass {
    rest,          // nothing moves
    following,     // the beam never leaves the cam
    periodic,      // (n, m): n turns of the cam, m impacts
    chaotic,       // no period, and the exponents that the sweep asked for show chaos
    aperiodic,     // no period
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

struct Attractor {
    AttractorClass kind = AttractorClass::unsettled;
    int period = 0;                    // turns of the cam; 0: none
    double impacts_per_period = kNan;  // without a period: per turn
    // The largest Lyapunov exponent and its standard error [1/s]. NaN: not asked for, or unknown; −∞: sustained contact
    // annihilates all differences.
    double exponent = kNan, exponent_error = kNan;
};

// The class by the states alone, never `chaotic`. (S86)–(S88)
Attractor classify(const Problem& problem, const SampledMotion& motion);

}  // namespace beamcam::sim
