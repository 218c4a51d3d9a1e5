#include "sim/observe/channels.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace beamcam::sim {
namespace {

struct ChannelRow {
    ChannelKind kind;
    const char* name;
    const char* unit;
    bool needs_cam = false;
};
constexpr std::array kEntries{
    // in the order of ChannelKind
    ChannelRow{ChannelKind::t, "t", "s"},
    ChannelRow{ChannelKind::theta, "theta", "rad"},
    ChannelRow{ChannelKind::theta_dot, "theta_dot", "rad/s"},
    ChannelRow{ChannelKind::tip_deflection, "tip_deflection", "m"},
    ChannelRow{ChannelKind::tip_rate, "tip_rate", "m/s"},
    ChannelRow{ChannelKind::contact_force, "contact_force", "N", true},
    ChannelRow{ChannelKind::friction_force, "friction_force", "N", true},
    ChannelRow{ChannelKind::gap, "gap", "m", true},
    ChannelRow{ChannelKind::contact_x, "contact_x", "m", true},
    ChannelRow{ChannelKind::contact_s, "contact_s", "m", true},
    ChannelRow{ChannelKind::cam_angle, "cam_angle", "rad", true},
    ChannelRow{ChannelKind::q, "q", "m"},
    ChannelRow{ChannelKind::energy_kinetic, "energy_kinetic", "J"},
    ChannelRow{ChannelKind::energy_potential, "energy_potential", "J"},
    ChannelRow{ChannelKind::energy_elastic, "energy_elastic", "J"},
    ChannelRow{ChannelKind::energy_contact, "energy_contact", "J", true},
    ChannelRow{ChannelKind::loss_structural, "loss_structural", "J"},
    ChannelRow{ChannelKind::loss_contact, "loss_contact", "J", true},
    ChannelRow{ChannelKind::loss_friction, "loss_friction", "J", true},
    ChannelRow{ChannelKind::work_cam, "work_cam", "J", true},
    ChannelRow{ChannelKind::work_drive, "work_drive", "J"},
    ChannelRow{ChannelKind::energy_residual, "energy_residual", "J"},
    ChannelRow{ChannelKind::separation, "separation", "m/s^2", true},
    ChannelRow{ChannelKind::separation_paper, "separation_paper", "m/s^2", true},
};
static_assert(std::ranges::all_of(kEntries, [](const ChannelRow& e) { return &kEntries[std::size_t(e.kind)] == &e; }));

const ChannelRow& entry(ChannelKind kind) { return kEntries[static_cast<std::size_t>(kind)]; }

}  // namespace

std::string name(Channel channel) {
    std::string text = entry(channel.kind).name;
    if (channel.kind == ChannelKind::q) text += std::to_string(channel.index);
    return text;
}

const char* unit(Channel channel, const Problem& problem) {
    if (channel.kind == ChannelKind::q && problem.beam.model == ModelKind::exact) return "rad";
    return entry(channel.kind).unit;
}

bool needs_cam(ChannelKind kind) { return entry(kind).needs_cam; }

std::optional<Channel> channel_named(std::string_view text) {
    for (const ChannelRow& e : kEntries)
        if (e.kind != ChannelKind::q && text == e.name) return Channel{e.kind, 0};
    if (text.size() > 1 && text.front() == 'q' && text[1] != '0') {
        int index = 0;
        const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), index);
        if (error == std::errc() && end == text.data() + text.size() && index >= 1)
            return Channel{ChannelKind::q, index};
    }
    return std::nullopt;
}

std::vector<Channel> all_channels(const Problem& problem) {
    const int modes = problem.beam.model == ModelKind::rigid ? 0 : problem.beam.modes;
    std::vector<Channel> channels;
    for (const ChannelRow& e : kEntries) {
        if (e.kind != ChannelKind::q) channels.push_back({e.kind, 0});
        for (int i = 1; e.kind == ChannelKind::q && i <= modes; ++i) channels.push_back({e.kind, i});
    }
    return channels;
}

ComparedAngle compared_angle(const Problem& problem) {
    if (is_prescribed(problem.hub.drive) && problem.beam.model != ModelKind::rigid)
        return {{ChannelKind::tip_deflection, 0}, 1 / problem.beam.length};
    return {{ChannelKind::theta, 0}, 1};
}

}  // namespace beamcam::sim
