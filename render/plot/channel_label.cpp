#include "render/plot/channel_label.hpp"

#include <fmt/format.h>

namespace beamcam::render {

using sim::ChannelKind;

std::string heading(ChannelKind kind, Lang lang) { return phrase(lang, sim::row(kind).label.words) + " "; }

std::string subscript(sim::Channel channel) {
    return sim::traits(channel.kind).of_mode ? std::to_string(channel.index) : sim::row(channel.kind).label.subscript;
}

std::string print_symbol(sim::Channel channel) {
    const sim::ChannelLabel& label = sim::row(channel.kind).label;
    const std::string below = subscript(channel);
    const std::string symbol = label.rate ? fmt::format("\\dot{{{}}}", label.symbol) : label.symbol;
    if (below.empty()) return fmt::format("${}$", symbol);
    return sim::traits(channel.kind).of_mode ? fmt::format("${}_{{{}}}$", symbol, below)
                                             : fmt::format("${}_{{\\r{{{}}}}}$", symbol, below);
}

}  // namespace beamcam::render
