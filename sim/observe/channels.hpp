// Channels: scalar functions of time along a trajectory, named as in the CSV header.
// Signs and frames: MODEL.md, "Definitions".
#pragma once

#include <algorithm>
#include <array>
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

// Properties of a channel that its evaluation and its bounds use.
struct ChannelTraits {
    bool needs_cam = false;             // undefined without a cam
    bool needs_contact = false;         // geometry or forces of the contact
    bool needs_gap = false;             // in contact
    bool needs_vibration_work = false;  // what damping and drive do to the vibration
    bool of_gap = false;                // a function of the gap and its rate
    bool of_hub = false;
    bool of_tip = false;
    bool of_beam_energy = false;
    bool separation = false;
    bool monotone = false;         // largest and smallest at ends, where the contact follows its law and the cam turns
    bool zero_where_held = false;  // but for errors, where contact is a constraint
    bool zero_at_rest = false;     // but for errors, where nothing moves
    bool estimated() const { return of_tip || separation; }
    bool follows_contact() const { return needs_contact && !separation; }
};

struct ChannelRow {
    ChannelKind kind;
    const char* name;
    const char* unit;
    ChannelTraits traits{};
};
// In the order of ChannelKind.
inline constexpr std::array kChannels{
    ChannelRow{ChannelKind::t, "t", "s"},
    ChannelRow{ChannelKind::theta, "theta", "rad", {.of_hub = true}},
    ChannelRow{ChannelKind::theta_dot, "theta_dot", "rad/s", {.of_hub = true, .zero_at_rest = true}},
    ChannelRow{ChannelKind::tip_deflection, "tip_deflection", "m", {.of_tip = true}},
    ChannelRow{ChannelKind::tip_rate, "tip_rate", "m/s", {.of_tip = true, .zero_at_rest = true}},
    ChannelRow{
        ChannelKind::contact_force, "contact_force", "N", {.needs_cam = true, .needs_contact = true, .of_gap = true}},
    ChannelRow{
        ChannelKind::friction_force, "friction_force", "N", {.needs_cam = true, .needs_contact = true, .of_gap = true}},
    ChannelRow{ChannelKind::gap,
               "gap",
               "m",
               {.needs_cam = true, .needs_contact = true, .of_gap = true, .zero_where_held = true}},
    ChannelRow{ChannelKind::contact_x, "contact_x", "m", {.needs_cam = true, .needs_contact = true}},
    ChannelRow{ChannelKind::contact_s, "contact_s", "m", {.needs_cam = true, .needs_contact = true}},
    ChannelRow{ChannelKind::cam_angle, "cam_angle", "rad", {.needs_cam = true, .monotone = true}},
    ChannelRow{ChannelKind::q, "q", "m"},
    ChannelRow{ChannelKind::energy_kinetic, "energy_kinetic", "J", {.of_beam_energy = true, .zero_at_rest = true}},
    ChannelRow{ChannelKind::energy_potential, "energy_potential", "J", {.of_beam_energy = true}},
    ChannelRow{ChannelKind::energy_elastic, "energy_elastic", "J", {.of_beam_energy = true}},
    ChannelRow{ChannelKind::energy_contact,
               "energy_contact",
               "J",
               {.needs_cam = true, .needs_gap = true, .of_gap = true, .zero_where_held = true}},
    ChannelRow{ChannelKind::loss_structural, "loss_structural", "J", {.needs_vibration_work = true, .monotone = true}},
    ChannelRow{
        ChannelKind::loss_contact, "loss_contact", "J", {.needs_cam = true, .needs_gap = true, .monotone = true}},
    ChannelRow{
        ChannelKind::loss_friction, "loss_friction", "J", {.needs_cam = true, .needs_gap = true, .monotone = true}},
    ChannelRow{ChannelKind::work_cam, "work_cam", "J", {.needs_cam = true}},
    ChannelRow{ChannelKind::work_drive, "work_drive", "J", {.needs_vibration_work = true}},
    ChannelRow{ChannelKind::energy_residual, "energy_residual", "J", {.needs_gap = true, .needs_vibration_work = true}},
    ChannelRow{ChannelKind::separation,
               "separation",
               "m/s^2",
               {.needs_cam = true, .needs_contact = true, .separation = true, .zero_at_rest = true}},
    ChannelRow{ChannelKind::separation_paper,
               "separation_paper",
               "m/s^2",
               {.needs_cam = true, .needs_contact = true, .separation = true, .zero_at_rest = true}},
};
static_assert(std::ranges::all_of(kChannels,
                                  [](const ChannelRow& c) { return &kChannels[std::size_t(c.kind)] == &c; }));
constexpr const ChannelRow& row(ChannelKind kind) { return kChannels[static_cast<std::size_t>(kind)]; }
constexpr const ChannelTraits& traits(ChannelKind kind) { return row(kind).traits; }

struct Channel {
    ChannelKind kind = ChannelKind::t;
    int index = 0;  // of q, from 1
    bool operator==(const Channel&) const = default;
};

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();  // the value of an undefined channel

std::string name(Channel channel);                          // "theta", "q1"
const char* unit(Channel channel, const Problem& problem);  // "rad", "m", "" for none
// The channel of that name, or nothing; the index of q is not checked against the problem.
std::optional<Channel> channel_named(std::string_view name);
// Every channel of this problem in the order of ChannelKind (q1…qN expanded).
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
