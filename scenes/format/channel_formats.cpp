// Notations of channels.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/value_formats.hpp"

namespace beamcam::scenes {

std::vector<std::string> channel_names(const std::vector<sim::Channel>& channels) {
    std::vector<std::string> names;
    for (const sim::Channel& channel : channels) names.push_back(name(channel));
    return names;
}

sim::Dimension dimension_of(const sim::Channel& channel, const sim::Problem& problem) {
    const QuantityText one = parse_quantity(fmt::format("1 {}", unit(channel, problem)));
    return one.quantity.value().dimension;
}

DimensionOf dimension_of_first(const std::vector<sim::Channel>& channels) {
    return [&channels](const ObjectReader& r) {
        return channels.empty() ? std::nullopt
                                : std::optional(dimension_of(channels.front(), r.context().scene.problem));
    };
}

void read_channels(ObjectReader& r, const Node& node, const std::string& key, const std::vector<sim::Channel>& allowed,
                   std::vector<sim::Channel>& out) {
    if (node.kind != Node::Kind::array || node.items.empty())
        return r.expect(node, key, "an array of names such as [\"theta\", \"gap\"]");
    const std::vector<std::string> names = channel_names(allowed);
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const Node& item = node.items[i];
        const std::string at = fmt::format("{}.{}", key, i);
        const auto fail = [&](const std::string& problem) { r.reject_value(item, at, " {}", problem); };
        const auto found = std::ranges::find(names, item.text);
        if (item.kind != Node::Kind::string)
            r.expect(item, at, "the name of a channel in quotes");
        else if (found == names.end())
            fail(sim::channel_named(item.text) ? "is not a coordinate of this beam"
                                               : "is not a channel" + suggestion_or_list(item.text, names));
        else if (const sim::Channel channel = allowed[static_cast<std::size_t>(found - names.begin())];
                 std::ranges::find(out, channel) != out.end())
            fail("is listed twice; remove one of them");
        else
            out.push_back(channel);
    }
}

ValueFormat channels_format(std::vector<sim::Channel>& channels) {
    const auto read = [&channels](ObjectReader& r, const Node& node, const std::string& key) {
        read_channels(r, node, key, all_channels(r.context().scene.problem), channels);
    };
    return {"[channel, …]",
            R"({"type": "array", "minItems": 1, "uniqueItems": true, "items": {"$ref": "#/$defs/channel"}})", read,
            [&channels] { return channels.empty() ? Node() : Node(channel_names(channels)); }};
}

// One panel for each unit, in order of first occurrence.
static std::vector<SeriesPanel> panels_by_unit(const std::vector<sim::Channel>& channels, const sim::Problem& problem) {
    std::vector<SeriesPanel> panels;
    for (const sim::Channel& channel : channels) {
        const auto same = std::ranges::find(
            panels, std::string_view(unit(channel, problem)),
            [&](const SeriesPanel& panel) { return std::string_view(unit(panel.channels.front(), problem)); });
        if (same == panels.end())
            panels.push_back({.channels = {channel}});
        else
            same->channels.push_back(channel);
    }
    return panels;
}

ValueFormat grouped_channels_format(std::vector<SeriesPanel>& panels) {
    static std::vector<sim::Channel> none;
    ValueFormat format = channels_format(none);
    format.read = [&panels](ObjectReader& r, const Node& node, const std::string& key) {
        std::vector<sim::Channel> channels;
        channels_format(channels).read(r, node, key);
        panels = panels_by_unit(channels, r.context().scene.problem);
    };
    format.write = [] { return Node(); };  // the key "panels" is written instead
    return format;
}

ValueFormat abscissa_format(std::string& against) {
    const auto read = [&against](ObjectReader& r, const Node& node, const std::string& key) {
        std::vector<std::string> known = channel_names(all_channels(r.context().scene.problem));
        known.insert(known.begin(), {"turns", "phase", "frequency"});
        if (node.kind != Node::Kind::string || std::ranges::find(known, node.text) == known.end())
            return r.reject_value(node, key, " is neither \"turns\", \"phase\", \"frequency\" nor a channel{}",
                                  suggestion_or_list(node.text, known));
        against = node.text;
    };
    return {"channel, \"turns\", \"phase\" or \"frequency\"",
            R"({"anyOf": [{"enum": ["turns", "phase", "frequency"]}, {"$ref": "#/$defs/channel"}]})", read,
            [&against] { return Node(against); }};
}

}  // namespace beamcam::scenes
