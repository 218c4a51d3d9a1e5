// Bounds of the beam, its hub and its contact within a part of a step, from those of its modes: what the bounds of all
// channels have in common. MODEL.md §12, (S59).
#pragma once

#include <algorithm>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/observe/mode_basis.hpp"
#include "sim/observe/mode_vibrations.hpp"

namespace beamcam::sim {

class PartBounds {
  public:
    PartBounds(System& system, const ModeBasis& basis);  // which must outlive it

    // What bounds the part [from, to] of a step; they live while it is observed.
    struct Part {
        double from = 0, to = 0;
        double elapsed = 0;  // since the start of the step [s]
        bool whole = false;  // all of it: the nodes of `modes` are those of the part
        const ModalBounds* modes = nullptr;
        const MotionBounds* motion = nullptr;
        const TouchSamples* touch = nullptr;  // null in flight
        double length() const { return to - from; }
    };
    void set(const Part& part);

    Part part;
    std::vector<ModeVibrations> groups;
    double deflection = 0, inclination = 0, alpha = 0;  // of |v|, |v′|, |α|
    double inertia_root = 0, weight_root = 0;           // of √|qᵀBq|, √|qᵀGq|
    double hub_acceleration = 0;                        // of |θ̈|
    double torque = 0;                                  // of the drive
    // With a cam.
    double disc_speed = 0;             // of the disc's centre
    double nearest = 0, farthest = 0;  // of the place of the contact, x_c
    double arm = 0;                    // of the contact's distance from the root
    double lever() const { return std::min(basis_.reach, basis_.reach - basis_.length + arm); }  // from the axis
    double away = 0;                                        // of the distance from the disc's centre to the beam
    double gap_low = 0, gap_high = 0;                       // of the gap, without an evaluation
    double rim_share = 1;                                   // of the arc on the disc, per displacement of the beam
    bool foot_moves() const { return nearest < farthest; }  // else it stays at an end of the beam
    double foot_speed = 0, slide = 0;  // of the contact along a straight beam, and along the bent one
    // Of the normal force while they touch, and of its derivatives.
    double force = 0, force_per_depth = 0, force_per_rate = 0;

  private:
    void sum_modes();
    void place_contact();
    void bound_gap(double distance, double to_root, double turn, double moved);
    void bound_force();

    System& system_;
    const ModeBasis& basis_;
};

}  // namespace beamcam::sim
