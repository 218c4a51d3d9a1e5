// Channels: scalar functions of time along a trajectory, named as in the CSV header.
// Signs and frames: MODEL.md, "Definitions".
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

enum class ChannelKind {
    t,
    theta,
    theta_dot,
    tip_deflection,
    tip_rate,
    contact_force,
    friction_force,
    gap,
    contact_x,
    contact_s,
    cam_angle,
    q,  // q1…qN, with Channel::index
    energy_kinetic,
    energy_potential,
    energy_elastic,
    energy_contact,
    loss_structural,
    loss_contact,
    loss_friction,
    work_cam,
    work_drive,
    energy_residual,
    separation,
    separation_paper
};

struct Channel {
    ChannelKind kind = ChannelKind::t;
    int index = 0;  // of q, from 1
    bool operator==(const Channel&) const = default;
};

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();  // the value of an undefined channel

std::string name(Channel channel);                          // "theta", "q1"
const char* unit(Channel channel, const Problem& problem);  // "rad", "m", "" for none
bool needs_cam(ChannelKind kind);                           // undefined without a cam
// The channel of that name, or nothing; the index of q is not checked against the problem.
std::optional<Channel> channel_named(std::string_view name);
// Every channel of this problem in the order of DESIGN's list (q1…qN expanded).
std::vector<Channel> all_channels(const Problem& problem);

// The angle by which two computations of one motion are compared: θ; where the hub's is prescribed, the tip's
// deflection over the length. `scale`: radians per unit of the channel.
struct ComparedAngle {
    Channel channel;
    double scale = 1;
    bool of_tip() const { return channel.kind == ChannelKind::tip_deflection; }
};
ComparedAngle compared_angle(const Problem& problem);

// Rows in the order of the request; `values[c][row]`; NaN where undefined (written as an empty cell).
struct Table {
    std::vector<Channel> channels;
    std::vector<std::vector<double>> values;
    std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
};

}  // namespace beamcam::sim
