// What is wanted of a motion.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "sim/observe/channels.hpp"
#include "sim/observe/pose.hpp"

namespace beamcam::sim {

// What is wanted. Times may lie in any order, must be >= 0, and the run extends to the largest of
// them and of `end_time`.
struct TableRequest {
    std::vector<double> times;  // [s]; rows come in this order
    std::vector<Channel> channels;
    // Abscissa and ordinate of a curve that is to be drawn: rows are added between the times until pieces between
    // neighbouring rows follow it. All rows then come in the order of time.
    std::optional<std::pair<Channel, Channel>> curve = {};
    double stray = 0.01;  // of the curve from the pieces, in its range; splines through the rows stray less
};
struct PoseRequest {
    std::vector<double> times;  // [s]
    int stations = 97;          // points along the centre line, >= 2
    // Takes each pose, by the row of its time, as soon as it is known: then Result::poses keeps none. A row may be told
    // again, and not all are told when the run fails.
    std::function<void(std::size_t row, const Pose& pose)> take{};
    // Also so many poses in contact, between the first and the last of the times: at each touch and within the steps
    // that follow it. Their rows go on from those of the times, and begin anew when those do.
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
    std::vector<Channel> extrema;  // located on the dense output
    bool turning_points = true;    // apexes and zero crossings of θ, which need a look at every ripple
    bool horizon = false;          // during which intervals θ is reproducible (horizon.hpp); costs more runs
    // The run ends at the event with which the motion has had as many of each kind; else at the end above.
    std::optional<EventCounts> enough = {};
};

}  // namespace beamcam::sim
