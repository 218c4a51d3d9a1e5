// The straight rigid lever that follows the cam: its pivot is the hub's axis, its face is parallel to the line through
// the pivot at the offset d. Positions, derivatives by the cam's turn φ = −ψ, and the speed at which it jumps off.
// MODEL.md (S106)–(S108).
#pragma once

#include <optional>

#include "sim/cam/cam_shape.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::sim {

class Lever {
  public:
    Lever(const Problem& problem, CamShape shape);  // with a cam
    explicit Lever(const Problem& problem) : Lever(problem, CamShape(problem)) {}

    struct State {
        double alpha = 0, phi = 0;  // angle of the outline's normal, turn of the cam [rad]
        LeverMotion motion;         // θ and its derivatives by φ
        double foot = 0;            // x_c, from the pivot to the contact [m]
        CamPoint point;
    };
    // NaN where the cam is too large for a lever with this pivot and offset.
    State at_normal(double alpha) const;
    State at(double phi) const;

    // Between the normal of the contact and the velocity of the lever's point there; 0 without an offset [rad].
    double pressure_angle(const State& state) const;
    // Moment about the pivot that presses the lever onto the cam, without inertia [N m]: of gravity and a constant
    // torque.
    double pressing_moment(double theta) const;
    double inertia() const { return inertia_; }  // about the pivot [kg m²]

    // The least speed of the cam at which the lever leaves it, and where. Speed 0: the lever is not pressed there.
    // Nothing if it stays on the cam at any speed, or if the drive's torque or angle depends on time.
    struct Jump {
        double speed = 0, phi = 0;  // [rad/s], [rad] in [0, 2π)
    };
    std::optional<Jump> jump() const;

    const CamShape& shape() const { return shape_; }

  private:
    CamShape shape_;
    double distance_, direction_, offset_;  // of C from the pivot [m], [rad]; d [m]
    double inertia_, weight_, torque_;      // [kg m²], moment of gravity at θ = 0 and torque of the drive [N m]
    bool is_driven_;                        // by a torque or angle that depends on time
};

}  // namespace beamcam::sim
