// Channels: scalar functions of time along a trajectory, named as in the CSV header.
// Signs and frames: MODEL.md, "Definitions".
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// The words for a channel in pictures, and its symbol; `rate`: that is the symbol's rate by time.
struct ChannelLabel {
    const char *words, *symbol;  // "Hub angle", "θ"
    const char* subscript = "";
    bool rate = false;
};

// Properties of a channel that its evaluation uses.
struct ChannelTraits {
    bool needs_cam = false;    // undefined without a cam
    bool of_mode = false;      // of one modal coordinate: its name contains the number of the mode
    bool accelerated = false;  // follows from ξ̈: as rough as the contact force
    bool squared = false;      // a square or a magnitude: it vibrates twice as fast as the beam
};

enum class ChannelKind {
#define CHANNEL(name, ...) name,
#include "sim/observe/channels.inc"
#undef CHANNEL
};

struct ChannelRow {
    ChannelKind kind;
    const char* name;
    const char* unit;
    const char* meaning;  // with its sign
    ChannelLabel label;
    ChannelTraits traits = {};
};
inline constexpr std::array kChannels{
#define CHANNEL(name, ...) ChannelRow{ChannelKind::name, #name, __VA_ARGS__},
#include "sim/observe/channels.inc"
#undef CHANNEL
};
constexpr const ChannelRow& row(ChannelKind kind) { return kChannels[static_cast<std::size_t>(kind)]; }
constexpr const ChannelTraits& traits(ChannelKind kind) { return row(kind).traits; }

struct Channel {
    ChannelKind kind = ChannelKind::t;
    int index = 0;  // of the mode of q and q_dot, from 1
    bool operator==(const Channel&) const = default;
};

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();  // the value of an undefined channel

std::string name(Channel channel);                          // "theta", "q1", "q1_dot"
const char* unit(Channel channel, const Problem& problem);  // "rad", "m", "" for none
// The channel of that name, or nothing; the number of a mode is not checked against the problem.
std::optional<Channel> channel_named(std::string_view name);
// Every channel of this problem in the order of the rows (q1…qN, q1_dot…qN_dot expanded).
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
