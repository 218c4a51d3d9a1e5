// The angle at which a straight beam touches the cam, bounds of its acceleration, and the intervals in which the cam
// presses against the beam. MODEL.md (S81), (S82), (S84). The beam is on the counter-clockwise side of the disc;
// RigidMotion mirrors the other side.
#pragma once

#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// θ_c and its derivatives by the cam's angle ψ.
struct SurfaceAngle {
    double angle = 0, slope = 0, bend = 0;  // θ_c, dθ_c/dψ, d²θ_c/dψ²
    double lever = 0;                       // ℓ, from the axis to the contact [m]
};

class CamSurface {
  public:
    // `reach` = R + d. The beam's own acceleration is α − k cos θ. The hub's axis lies outside of the disc enlarged to
    // `reach`, at every angle of the cam.
    CamSurface(const Cam& cam, double reach, double k, double alpha);

    SurfaceAngle at(double s) const;                                            // s: time within the turn [s]
    double rate(const SurfaceAngle& c) const { return -cam_.speed * c.slope; }  // θ̇_c [rad/s]
    double acceleration(const SurfaceAngle& c) const { return cam_.speed * cam_.speed * c.bend; }  // θ̈_c [rad/s²]
    // f = θ̈_c + k cos θ_c − α [rad/s²], positive where a beam that follows the cam needs a contact force.
    double push(const SurfaceAngle& c) const;

    // No θ̈_c of the turn lies beyond these; they exceed its extrema by less than a hundredth of its range.
    double highest_acceleration() const { return highest_; }
    double lowest_acceleration() const { return lowest_; }

    // Intervals with f < 0: a following beam lifts off at `from`, and f > 0 again from `to` on. In the order of `from`,
    // which lies within the turn; `to` may lie beyond its end.
    struct Lift {
        double from, to;
    };
    const std::vector<Lift>& lifts() const { return lifts_; }
    bool always_pulls() const { return always_pulls_; }

  private:
    // θ̈_c and f at an instant.
    struct Place {
        double s, acceleration, push;
    };
    // Bounds of |d²θ̈_c/ds²| and |d²f/ds²| within an interval.
    struct Bends {
        double acceleration, push;
    };
    Place place(double s) const;
    Bends bends(double from, double to) const;
    void bound_acceleration(const Place& a, const Place& b, double margin, int halvings);
    void find_zeros(const Place& a, const Place& b, int halvings, std::vector<double>& zeros) const;
    void set_lifts(std::vector<double> zeros, bool starts_pulled);

    Cam cam_;
    double reach_, k_, alpha_, period_;
    double highest_ = 0, lowest_ = 0;
    std::vector<Lift> lifts_;
    bool always_pulls_ = false;  // f < 0 at every angle: no beam follows this cam
};

}  // namespace beamcam::sim
