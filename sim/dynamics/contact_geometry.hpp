// Contact geometry of the beam's centre line and the cam: foot of the perpendicular, gap, gap rate, slip. MODEL.md §7.
#pragma once

#include "sim/cam/turning_cam.hpp"
#include "sim/dynamics/gap_bound.hpp"

namespace beamcam::sim {

// The contact in one state of the system.
struct ContactState {
    double x = 0;                  // x_c [m]
    bool at_end = false;           // the foot is an end of the beam
    Vec2 normal, tangent;          // n, t
    double side = 0;               // side of the beam on which the cam lies: ±1; 0 beyond the ends
    OsculatingDisc disc;           // of the cam at the foot
    double gap = 0, gap_rate = 0;  // [m], [m/s]
    double slip = 0;               // v_t [m/s]
    double force = 0;              // N [N]
    double friction = 0;           // F_t on the beam along t [N]
    double factor = 1;             // 1 + D δ̇/δ̇₋; the force is clamped where this is negative
};

// Evaluates the contact in the state of a Model.
class ContactGeometry {
  public:
    ContactGeometry(const Problem& problem, const Model& model, const TurningCam& cam);

    // Everything but the forces. `shift` is added to the gap [m].
    ContactState evaluate(const Model& model, const GapBound& bound, double t, double shift) const;
    // J_n = n·∂r/∂ξ and J_t = t·∂r/∂ξ + d ∂χ/∂ξ (S28).
    void rows(const Model& model, const ContactState& c, double* jn, double* jt) const;
    // g̈ at ξ̈ = 0 (S44).
    double gap_acceleration_at_rest(const Model& model, double t, const ContactState& c) const;

  private:
    double near_foot(const Model& model, const GapBound& bound, double t) const;
    BeamPoint foot(const Model& model, double t, double x, ContactState& c) const;
    Vec2 facing(const BeamPoint& at) const;

    TurningCam cam_;
    double hub_radius_, length_, offset_;
    int samples_;  // intervals of a search along the whole beam
};

}  // namespace beamcam::sim
