#include "sim/observe/channels.hpp"

#include <charconv>
#include <utility>

namespace beamcam::sim {

std::string name(Channel channel) {
    std::string text = row(channel.kind).name;
    if (traits(channel.kind).of_mode) text.insert(1, std::to_string(channel.index));
    return text;
}

const char* unit(Channel channel, const Problem& problem) {
    if (traits(channel.kind).of_mode && problem.beam.model == ModelKind::exact)
        return channel.kind == ChannelKind::q ? "rad" : "rad/s";
    return row(channel.kind).unit;
}

std::optional<Channel> channel_named(std::string_view text) {
    for (const ChannelRow& e : kChannels)
        if (!e.traits.of_mode && text == e.name) return Channel{e.kind, 0};
    int index = 0;
    if (text.size() < 2 || text.front() != 'q' || text[1] == '0') return std::nullopt;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), index);
    if (error != std::errc() || index < 1) return std::nullopt;
    for (const ChannelKind kind : {ChannelKind::q, ChannelKind::q_dot})
        if (name({kind, index}) == text) return Channel{kind, index};
    return std::nullopt;
}

std::vector<Channel> all_channels(const Problem& problem) {
    const int modes = problem.beam.model == ModelKind::rigid ? 0 : problem.beam.modes;
    std::vector<Channel> channels;
    for (const ChannelRow& e : kChannels) {
        if (!e.traits.of_mode) channels.push_back({e.kind, 0});
        for (int i = 1; e.traits.of_mode && i <= modes; ++i) channels.push_back({e.kind, i});
    }
    return channels;
}

ComparedAngle compared_angle(const Problem& problem) {
    if (is_prescribed(problem.hub.drive) && problem.beam.model != ModelKind::rigid)
        return {{ChannelKind::tip_deflection, 0}, 1 / problem.beam.length};
    return {{ChannelKind::theta, 0}, 1};
}

}  // namespace beamcam::sim
