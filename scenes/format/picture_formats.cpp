// Notations of places, colours and parts of pictures.
#include <fmt/format.h>

#include <charconv>

#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/value_formats.hpp"

namespace beamcam::scenes {

// ---- places of the mechanism -------------------------------------------------------------------

namespace {

constexpr sim::Named<render::Anchor::Kind> kAnchors[] = {{render::Anchor::Kind::all, "all"},
                                                         {render::Anchor::Kind::tip, "tip"},
                                                         {render::Anchor::Kind::contact, "contact"},
                                                         {render::Anchor::Kind::cam, "cam"},
                                                         {render::Anchor::Kind::hub, "hub"}};

std::optional<render::Anchor> read_anchor(ObjectReader& r, const Node& node, const std::string& key) {
    if (node.kind == Node::Kind::array && node.items.size() == 2) {
        const auto at = r.numbers_value(node, key, sim::dimension::kLength);
        if (!at) return std::nullopt;
        return render::Anchor{render::Anchor::Kind::place, {at->front(), at->back()}};
    }
    std::vector<std::string> names;
    for (const auto& [kind, name] : kAnchors) {
        if (word_in(node) == name) return render::Anchor{kind, {}};
        names.emplace_back(name);
    }
    r.reject_value(node, key, " is neither a place [x, y] nor a part of the mechanism{}",
                   suggestion_or_list(node.text, names));
    return std::nullopt;
}

template <class Value>
ValueFormat format_of_anchor(Value& anchor) {
    const auto write = [](const render::Anchor& one) -> Node {
        for (const auto& [kind, name] : kAnchors)
            if (one.kind == kind) return name;
        return array_node({one.place.x, one.place.y});
    };
    return format_of(anchor, "\"all\", \"tip\", \"contact\", \"cam\", \"hub\" or [x, y]",
                     R"({"$ref": "#/$defs/anchor"})", read_anchor, write);
}

}  // namespace

ValueFormat anchor_format(render::Anchor& anchor) { return format_of_anchor(anchor); }
ValueFormat anchor_format(std::optional<render::Anchor>& anchor) { return format_of_anchor(anchor); }

// ---- colours, parts of the picture -------------------------------------------------------------

namespace {

std::optional<std::uint32_t> parse_color(std::string_view text) {
    if (text.size() != 7 || text.front() != '#') return std::nullopt;
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

Node color_node(std::uint32_t color) { return fmt::format("#{:06x}", color); }

}  // namespace

ValueFormat background_format(render::View& view) {
    const auto read = [&view](ObjectReader& r, const Node& node, const std::string& key) {
        const std::string text = word_in(node);
        view.transparent = text == "transparent";
        view.paper = parse_color(text);
        if (!view.transparent && !view.paper && text != "paper")
            r.reject_value(node, key,
                           " is not a background; write \"paper\", \"transparent\" or a colour such as \"#f4f1ea\"");
    };
    const auto write = [&view] {
        return view.paper ? color_node(*view.paper) : Node(view.transparent ? "transparent" : "paper");
    };
    return {"\"paper\", \"transparent\" or \"#rrggbb\"",
            R"({"anyOf": [{"enum": ["paper", "transparent"]}, {"type": "string", "pattern": "^#[0-9a-fA-F]{6}$"}]})",
            read, write};
}

}  // namespace beamcam::scenes
