// Contact geometry of the beam's centre line and the disc: foot, gap, gap rate, slip. MODEL.md §7.
#pragma once

#include "sim/dynamics/gap_bound.hpp"

namespace beamcam::sim {

// The beam against the cam at one state.
struct ContactState {
    double x = 0;  // x_c [m]
    bool at_end = false;
    Vec2 normal, tangent;
    double side = 0;               // of the beam, where the disc's centre lies: ±1, 0 beyond its ends
    double gap = 0, gap_rate = 0;  // [m], [m/s]
    double slip = 0;               // v_t [m/s]
    double force = 0;              // N [N]
    double friction = 0;           // F_t on the beam along t [N]
    double factor = 1;             // 1 + D δ̇/δ̇₋ (clamp where negative)
};

// Remembers the last foot, from which the next search begins. The model holds the state in question.
class ContactGeometry {
  public:
    ContactGeometry(const Problem& problem, const Model& model);

    // The next evaluation searches the whole beam.
    void search_again() { search_next_ = true; }
    // The next evaluation begins at x, near which the foot is known to be.
    void begin_at(double x) {
        x_last_ = x;
        search_next_ = false;
    }
    // x, normal, gap and rates; no forces. `search`: over the whole beam, else near the last foot. `shift`: added to
    // the gap.
    ContactState evaluate(const Model& model, const GapBound& bound, double t, bool search, double shift);
    // Rows of ∂(n·r)/∂ξ, and of ∂(t·r)/∂ξ with the moment of the offset face.
    void rows(const Model& model, const ContactState& c, double* jn, double* jt) const;
    // g̈ at ξ̈ = 0 (S44).
    double gap_acceleration_at_rest(const Model& model, double t, const ContactState& c) const;

  private:
    void search_whole_beam(const Model& model, Vec2 disc, bool straight);
    Vec2 foot(const Model& model, Vec2 disc, ContactState& c);

    Cam cam_;
    double hub_radius_, length_, offset_;
    int samples_;  // of a search over the whole beam, less one
    double x_last_;
    BeamPoint at_;
    bool search_next_ = true;
};

}  // namespace beamcam::sim
