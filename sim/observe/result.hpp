// Results of a simulation: samples, poses, impacts, extrema, the energy balance.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/integrate/integrator.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/pose.hpp"

namespace beamcam::sim {

// The state of the motion where a touch begins or ends.
struct TouchState {
    double theta = 0, theta_dot = 0;  // [rad], [rad/s]
    double contact_s = 0;             // [m]
    std::vector<double> q;            // the scene's coordinates [m]; of `exact` [rad]
};

// One touch, from approach to release. Speeds: v_n < 0 approaches; v_t is beam minus cam material.
struct Impact {
    double t_start = 0;                          // [s]
    std::optional<double> t_end;                 // absent: still touching at the end of the run
    double x = 0;                                // contact_x at touch [m]
    double cam_angle = 0;                        // ψ at touch [rad]
    double s = 0;                                // contact_s at touch [m]; for pictures, in no table
    double v_n_before = 0, v_t_before = 0;       // at touch [m/s]
    std::optional<double> v_n_after, v_t_after;  // at release [m/s]
    std::optional<double> duration;              // [s]
    std::optional<double> force_peak;            // [N]; absent: a pure impulse has no finite force; or not requested
    std::optional<double> t_peak;                // of that force [s]
    double penetration_peak = 0;                 // [m]; NaN: not requested
    double impulse_n = 0, impulse_t = 0;         // [N s]
    std::optional<double> restitution;           // −v_n_after / v_n_before
    double energy_lost = 0;                      // contact + friction losses between touch and release [J]
    int collision = 0;                           // its number among the collisions, from 1
    std::optional<TouchState> at_touch;          // before the impulse, if there is one; absent: not kept
    std::optional<TouchState> at_release;        // after it
};

// Impacts closer than contact.collision_gap.
struct Collision {
    double t_start = 0;
    std::optional<double> t_end;
    int count = 0;  // of impacts
    double x = 0, v_n_before = 0;
    std::optional<double> v_n_after, restitution;
    std::optional<double> force_peak;  // [N]
    double energy_lost = 0;
    std::optional<double> t_peak = {};  // of the force [s]
    // Of the largest deflection of the tip, to either side, until the next collision or the end of the run [s]; absent:
    // the beam does not bend, or Request::bends is not set.
    std::optional<double> t_bend = {};
};

struct ZeroCrossing {
    double t = 0, theta_dot = 0;
};
struct Apex {  // a maximum of theta, ripple included
    double t = 0, theta = 0;
};
struct Extremum {
    double min = 0, t_min = 0, max = 0, t_max = 0;
};

// [s]; without `to`: to the end of the run.
struct Interval {
    double from = 0;
    std::optional<double> to;
};

struct Result {
    double end_time = 0;                    // reached [s]
    double end_theta = 0;                   // θ there [rad]
    std::vector<Table> tables;              // one per TableRequest
    std::vector<std::vector<Pose>> poses;   // one per PoseRequest, in the order of its times, then those in contact
    std::vector<std::vector<Vec2>> points;  // one per PointRequest [m]
    // The problems that continue the motion from Request::states; absent: not reached.
    std::vector<std::optional<Problem>> states;
    std::vector<Impact> impacts;
    std::vector<Collision> collisions;
    std::vector<ZeroCrossing> theta_zero;
    std::vector<Apex> apexes;
    std::vector<Extremum> extrema;   // one per Request::extrema
    double energy_residual_max = 0;  // [J] largest magnitude at the ends of steps
    double energy_scale = 0;         // [J]
    // With Request::horizon:
    std::optional<double> reproducible_until;       // the first loss, or the end [s]
    std::vector<Interval> not_reproducible;         // [s]
    std::optional<double> reproducible_again_from;  // after the last of these, where it ends before the run [s]
    std::string compared_with;                      // methods and tolerances of the other runs
    std::string reproducibility;                    // a sentence on the four above
    Counters counters;
    std::vector<std::pair<Method, long>> steps_by_method;  // accepted steps of each method that took any
    double wall_seconds = 0;
    bool beyond_model = false;  // the beam bends through larger angles than its model allows
    std::vector<std::string> warnings;
};

// The highest apex of each rebound: between the beginnings of two collisions, or after the last one. A rise that the
// end of the run interrupts has no apex, only ripple. Without collisions every apex is a rebound.
std::vector<Apex> rebounds(const Result& result);

}  // namespace beamcam::sim
