// The laws by which a straight lever rises and falls over a turn of the cam. MODEL.md (S100), (S101).
//
// Sources: Norton, "Cam Design and Manufacturing Handbook", ch. 3; VDI 2143 part 1.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

inline constexpr double kFullTurn = 2 * std::numbers::pi;  // [rad]

// s(u) of a law and its first three derivatives by u; s(0) = 0, s(1) = 1, s′(0) = s′(1) = 0.
struct LawValue {
    double s = 0, velocity = 0, acceleration = 0, jerk = 0;
};
LawValue law_value(MotionLaw law, double u);  // 0 <= u <= 1
// Where the formula of s changes, in (0, 1).
std::span<const double> law_breaks(MotionLaw law);

// θ of the lever and its derivatives by the cam's turn φ = −ψ.
struct LeverMotion {
    double theta = 0, velocity = 0, acceleration = 0, jerk = 0;  // [rad], per rad, per rad², per rad³
};

class ProgrammedMotion {
  public:
    // A profile whose turns and rises `check_profile` has accepted.
    explicit ProgrammedMotion(const LawProfile& profile);

    struct Segment {
        MotionLaw law;
        double start, over;  // of φ [rad], over > 0
        double theta, rise;  // at its start, over it [rad]
    };
    const std::vector<Segment>& segments() const { return segments_; }
    // The formula of one segment, also a little beyond its ends.
    static LeverMotion at(const Segment& segment, double phi);
    LeverMotion at(double phi) const;  // any φ

  private:
    std::vector<Segment> segments_;  // of one turn, the first from 0
};

}  // namespace beamcam::sim
