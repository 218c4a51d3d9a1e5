// Requests to a simulation: tables, poses, points, states, extrema and events.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "sim/observe/channels.hpp"
#include "sim/observe/pose.hpp"

namespace beamcam::sim {

// Times may be in any order and must be >= 0; the run extends to the largest of them and of `end_time`.
struct TableRequest {
    std::vector<double> times;  // [s]; rows are in this order
    std::vector<Channel> channels;
    // Abscissa and ordinate of a curve: rows are added between the times until straight pieces between neighbouring
    // rows follow it. All rows are then in the order of time.
    std::optional<std::pair<Channel, Channel>> curve = {};
    double stray = 0.01;  // distance of the motion from the pieces, as a share of its range
    // Ends of the abscissae that are drawn; no rows are added outside.
    std::pair<double, double> drawn{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    // Rows are added until linear interpolation between neighbouring rows follows every channel but the energy
    // residual. They are in the order of time; two rows at one instant are the sides of a jump.
    bool adaptive = false;
    std::optional<double> rate = {};  // [Hz] of equally spaced rows: a warning tells that they miss impacts
};
struct PoseRequest {
    std::vector<double> times;  // [s]
    int stations = 97;          // points along the centre line, >= 2
    // The most additional poses in contact, between the first and the last of the times: at each touch and within the
    // steps after it. Their rows follow those of the times.
    std::size_t contacts = 0;
};
// The path of a material point of the centre line.
struct PointRequest {
    double x = 0;               // arc position, 0…L [m]
    std::vector<double> times;  // [s]
};
// Events of a motion since its start; a collision begins with its first touch.
struct EventCounts {
    std::size_t touches = 0, releases = 0, collisions = 0;
};
struct Request {
    double end_time = 0;  // [s]
    std::vector<TableRequest> tables;
    std::vector<PoseRequest> poses;
    std::vector<PointRequest> points;
    std::vector<Channel> extrema;                 // by samples of each step, refined on its dense output
    bool apexes = false, zero_crossings = false;  // of θ; each searches every ripple of the hub
    bool bends = false;                           // Collision::t_bend
    bool impact_peaks = true;                     // the largest force and penetration of each impact
    std::vector<double> states;                   // [s]: Result::states at these times
    bool horizon = false;  // intervals in which θ is reproducible (horizon.hpp); costs a second run
    // The run ends early at the event that completes these counts.
    std::optional<EventCounts> enough = {};
};

}  // namespace beamcam::sim
