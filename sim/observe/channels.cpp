#include "sim/observe/channels.hpp"

#include <array>
#include <charconv>
#include <utility>

namespace beamcam::sim {
namespace {

struct Entry {
    ChannelKind kind;
    const char* name;
    const char* unit;
};
constexpr std::array kEntries{
    Entry{ChannelKind::t, "t", "s"},
    Entry{ChannelKind::theta, "theta", "rad"},
    Entry{ChannelKind::theta_dot, "theta_dot", "rad/s"},
    Entry{ChannelKind::tip_deflection, "tip_deflection", "m"},
    Entry{ChannelKind::tip_rate, "tip_rate", "m/s"},
    Entry{ChannelKind::contact_force, "contact_force", "N"},
    Entry{ChannelKind::friction_force, "friction_force", "N"},
    Entry{ChannelKind::gap, "gap", "m"},
    Entry{ChannelKind::contact_x, "contact_x", "m"},
    Entry{ChannelKind::contact_s, "contact_s", "m"},
    Entry{ChannelKind::cam_angle, "cam_angle", "rad"},
    Entry{ChannelKind::q, "q", "m"},
    Entry{ChannelKind::energy_kinetic, "energy_kinetic", "J"},
    Entry{ChannelKind::energy_potential, "energy_potential", "J"},
    Entry{ChannelKind::energy_elastic, "energy_elastic", "J"},
    Entry{ChannelKind::energy_contact, "energy_contact", "J"},
    Entry{ChannelKind::loss_structural, "loss_structural", "J"},
    Entry{ChannelKind::loss_contact, "loss_contact", "J"},
    Entry{ChannelKind::loss_friction, "loss_friction", "J"},
    Entry{ChannelKind::work_cam, "work_cam", "J"},
    Entry{ChannelKind::work_drive, "work_drive", "J"},
    Entry{ChannelKind::energy_residual, "energy_residual", "J"},
    Entry{ChannelKind::separation, "separation", "m/s^2"},
    Entry{ChannelKind::separation_paper, "separation_paper", "m/s^2"},
};

const Entry& entry(ChannelKind kind) {
    for (const Entry& e : kEntries)
        if (e.kind == kind) return e;
    return kEntries.front();
}

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

std::optional<Channel> channel_named(std::string_view text) {
    for (const Entry& e : kEntries)
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
    for (const Entry& e : kEntries) {
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
