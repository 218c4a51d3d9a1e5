// The straight rigid lever that follows the cam: its pivot is the hub's axis, its face is parallel to the line through
// the pivot at the offset d, towards the cam. Positions, derivatives by the cam's turn φ = −ψ, and the speed at which
// it jumps off. MODEL.md (S106)–(S108).
#pragma once

#include <optional>

#include "sim/cam/cam_shape.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::sim {

class Lever {
  public:
    // With a cam, on that side of it on which the beam of the problem starts.
    explicit Lever(const Problem& problem);

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
    // Moment about the pivot that presses the lever at rest onto the cam [N m]: of gravity, the hub's spring and the
    // torque at the start.
    double pressing_moment(double theta) const;
    double farthest_foot() const;          // largest x_c of a turn [m]; not a number where no lever reaches the cam
    double side() const { return side_; }  // 1 where the lever lies counter-clockwise from the cam, else −1

    // The least speed of the cam at which the lever leaves it, and where. Speed 0: the lever is not pressed there.
    // Nothing if it stays on the cam at any speed, or if the drive's torque or angle depends on time.
    struct Jump {
        double speed = 0, phi = 0;  // [rad/s], [rad] in [0, 2π)
    };
    std::optional<Jump> jump() const;

    const CamShape& shape() const { return *shape_; }

    // The numbers by which a designer judges a cam. Angles are NaN where no lever reaches the cam.
    struct Summary {
        double base_radius = 0;                   // least distance of the outline from the axis [m]
        double rho_min = 0, rho_max = 0;          // of the radius of curvature [m]
        double rho_min_normal = 0;                // α of the first such place [rad]
        double rho_min_phi = 0;                   // turn at which the lever touches it there, in [0, 2π) [rad]
        double pressure_angle_max = 0;            // [rad]
        std::optional<Jump> jump = std::nullopt;  // nothing: it does not jump, or no closed form applies
    };
    Summary summary() const;

  private:
    double starting_side(const Problem& problem);
    double turn_at_normal(double alpha) const;  // φ in [0, 2π)

    std::shared_ptr<const CamShape> shape_;
    double distance_, direction_, offset_;  // of C from the pivot [m], [rad]; d [m]
    double inertia_, weight_, torque_;      // [kg m²], moment of gravity at θ = 0 and torque of the drive [N m]
    std::optional<HubSpring> spring_;
    double sense_;     // of the cam's rotation: 1 where φ increases
    double side_ = 1;  // σ
    bool is_driven_;   // by a torque or angle that depends on time
};

}  // namespace beamcam::sim
