#include "sim/observe/channels.hpp"

#include <charconv>
#include <utility>

namespace beamcam::sim {

std::string name(Channel channel) {
    std::string text = row(channel.kind).name;
    if (channel.kind == ChannelKind::q) text += std::to_string(channel.index);
    return text;
}

const char* unit(Channel channel, const Problem& problem) {
    if (channel.kind == ChannelKind::q && problem.beam.model == ModelKind::exact) return "rad";
    return row(channel.kind).unit;
}

std::optional<Channel> channel_named(std::string_view text) {
    for (const ChannelRow& e : kChannels)
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
    for (const ChannelRow& e : kChannels) {
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
