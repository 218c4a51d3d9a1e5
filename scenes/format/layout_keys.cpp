// The keys of a layout: panels, and rows and columns of them.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/format/checks.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/value_formats.hpp"

namespace beamcam::scenes {

using render::LayoutNode, render::PanelKind, render::PanelSpec, render::PanelType;

namespace {

constexpr std::size_t kMostPanels = 24;  // a layout deeper or larger than this fits no picture
constexpr int kDeepestLayout = 8;

// ---- panels ------------------------------------------------------------------------------------

std::vector<std::string> channel_names(const sim::Problem& problem) {
    std::vector<std::string> names;
    for (const sim::Channel& channel : all_channels(problem))
        if (channel.kind != sim::ChannelKind::t) names.push_back(name(channel));
    return names;
}

std::vector<std::string> panel_words(const sim::Problem& problem) {
    std::vector<std::string> words;
    for (const PanelType& type : render::panel_types()) words.emplace_back(type.name);
    for (std::string& channel : channel_names(problem)) words.push_back(std::move(channel));
    return words;
}

std::optional<sim::Channel> known_channel(const sim::Problem& problem, std::string_view text) {
    for (const sim::Channel& channel : all_channels(problem))
        if (channel.kind != sim::ChannelKind::t && name(channel) == text) return channel;
    return std::nullopt;
}

void read_panel(ObjectReader& r, const Node& node, const std::string& key, PanelSpec& out) {
    const sim::Problem& problem = r.context().scene.problem;
    const bool is_text = node.kind == Node::Kind::string;
    const auto& types = render::panel_types();
    if (const auto type = std::ranges::find_if(types, [&](const auto& t) { return is_text && node.text == t.name; });
        type != types.end()) {
        out.kind = type->kind;
    } else if (const auto channel = is_text ? known_channel(problem, node.text) : std::nullopt) {
        out.kind = PanelKind::strip;
        out.channels = {*channel};
    } else {
        r.fail(node, key,
               fmt::format("{} = {} is no panel{}", r.path(key), as_written(node),
                           is_text ? suggestion_or_list(node.text, panel_words(problem)) : ""));
    }
}

ValueFormat panel_format(PanelSpec& panel) {
    return {"panel or channel", R"({"anyOf": [{"const": "strip"}, {"$ref": "#/$defs/panelName"}]})",
            [&panel](ObjectReader& r, const Node& node, const std::string& key) { read_panel(r, node, key, panel); },
            [&panel] { return text_node(type_of(panel.kind).name); }};
}

void read_strip_channels(ObjectReader& r, const Node& node, const std::string& key, PanelSpec& panel) {
    const sim::Problem& problem = r.context().scene.problem;
    if (node.kind != Node::Kind::array || node.items.empty())
        return r.fail(
            node, key,
            fmt::format("{} must be an array of names such as [\"theta\"], not {}", r.path(key), as_written(node)));
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const Node& item = node.items[i];
        const std::string at = fmt::format("{}.{}", key, i);
        const auto fail = [&](const std::string& why) {
            r.fail(item, at, fmt::format("{} = {} {}", r.path(at), as_written(item), why));
        };
        const bool is_text = item.kind == Node::Kind::string;
        const auto channel = is_text ? known_channel(problem, item.text) : std::nullopt;
        if (!channel) {
            fail("is no channel of this beam" + (is_text ? suggestion_or_list(item.text, channel_names(problem)) : ""));
            continue;
        }
        const std::string unit = sim::unit(*channel, problem);
        if (!panel.channels.empty() && unit != sim::unit(panel.channels.front(), problem))
            fail(fmt::format("is measured in {}, {} in {}; one strip has one unit, make two of it",
                             unit.empty() ? "1" : unit, name(panel.channels.front()),
                             sim::unit(panel.channels.front(), problem)));
        else if (std::ranges::find(panel.channels, *channel) != panel.channels.end())
            fail("stands twice");
        else
            panel.channels.push_back(*channel);
    }
}

bool names_a_strip(const ObjectReader& r) { return r.place("panel").text == type_of(PanelKind::strip).name; }

ValueFormat strip_channels_format(PanelSpec& panel) {
    ValueFormat form = channels_format(panel.channels);
    form.read = [&panel](ObjectReader& r, const Node& node, const std::string& key) {
        if (names_a_strip(r))
            read_strip_channels(r, node, key, panel);
        else
            r.fail(node, key, fmt::format("{} belongs to \"panel\": \"strip\"", r.path(key)));
    };
    return form;
}

ValueFormat window_format(PanelSpec& panel) {
    const auto read = [&panel](ObjectReader& r, const Node& node, const std::string& key) {
        double window = 0;
        if (!type_of(panel.kind).takes_window)
            return r.fail(node, key, fmt::format("{} belongs to strips and \"energy\"", r.path(key)));
        panel.by_collision = node.kind == Node::Kind::string && node.text == "collision";
        if (panel.by_collision && !type_of(panel.kind).takes_collisions)
            return r.fail(node, key, fmt::format("{} of the energies is a time, not a collision", r.path(key)));
        if (!panel.by_collision &&
            r.ranged_value(node, key, sim::dimension::kTime,
                           {0, sim::Range::kInfinity, true, false, "must be positive, or \"collision\""}, window))
            panel.window = window;
    };
    const auto write = [&panel]() -> std::optional<Node> {
        if (panel.by_collision) return text_node("collision");
        return panel.window ? std::optional(number_node(*panel.window)) : std::nullopt;
    };
    return {
        "time or \"collision\"",
        R"({"anyOf": [{"const": "collision"}, {"type": "number", "exclusiveMinimum": 0}, {"$ref": "#/$defs/withUnit"}]})",
        read, write};
}

// The names of the panels that this holds for, each in `quotes`.
std::string names_of(const char* quotes, bool (*holds)(const PanelType&)) {
    std::vector<std::string> names;
    for (const PanelType& type : render::panel_types())
        if (holds(type)) names.push_back(fmt::format("{0}{1}{0}", quotes, type.name));
    return fmt::format("{}", fmt::join(names, ", "));
}

void visit_panel(SceneVisitor& v, PanelSpec& panel) {
    v.value(sim::required("panel", "\"mechanism\""), panel_format(panel),
            (names_of("", [](const PanelType&) { return true; }) + ", or a channel.").c_str());
    v.value("channels", strip_channels_format(panel), "Of a strip: curves of one unit.");
    v.check([&panel](ObjectReader& r) {
        if (panel.kind == PanelKind::strip && r.has("panel") && !r.has("channels") && panel.channels.empty())
            r.fail(*r.node(), "channels",
                   fmt::format("{} is a strip and needs \"channels\", for example [\"theta\"]", r.object_name()));
    });
    v.value(
        "window", window_format(panel),
        "Of a strip or the energies: so much time, all of it when left out; or, of a strip, one \"collision\" after "
        "the other.");
    const std::string timeless = names_of("\"", [](const PanelType&t) { return !t.takes_window; }),
                      steady = names_of("\"", [](const PanelType&t) { return !t.takes_collisions; });
    v.constrain_schema((R"({"allOf": [
        {"if": {"properties": {"panel": {"const": "strip"}}},
         "then": {"required": ["channels"]}, "else": {"properties": {"channels": false}}},
        {"if": {"properties": {"panel": {"enum": [)" +
                        timeless + R"(]}}},
         "then": {"properties": {"window": false}}},
        {"if": {"properties": {"panel": {"enum": [)" +
                        steady + R"(]}}},
         "then": {"properties": {"window": {"not": {"const": "collision"}}}}}]})")
                           .c_str());
    int motion = panel.member + 1;
    v.integer(sim::written_if(motion > 1, "motion"), motion, 1, static_cast<int>(kMostCompared),
              "Which of the compared motions, counted from 1.");
    panel.member = motion - 1;
}

// ---- rows and columns --------------------------------------------------------------------------

// An item that is a name alone.
ValueFormat named_panel_format(std::vector<LayoutNode>& children) {
    const auto read = [&children](ObjectReader& r, const Node& node, const std::string& key) {
        LayoutNode& child = children.emplace_back();
        if (node.kind == Node::Kind::string && node.text == type_of(PanelKind::strip).name)
            r.fail(node, key,
                   fmt::format("{} = {} needs channels: write {{\"panel\": \"strip\", \"channels\": [\"theta\"]}}",
                               r.path(key), in_quotes(node.text)));
        else if (node.kind != Node::Kind::string)
            r.fail(
                node, key,
                fmt::format("{} must be a panel's name or an object {{ … }}, not {}", r.path(key), as_written(node)));
        else
            read_panel(r, node, key, child.panel);
    };
    return {"panel or channel", R"({"$ref": "#/$defs/panelName"})", read, [] { return std::nullopt; }};
}

void visit_children(SceneVisitor& v, LayoutNode& node, const char* key, const char* meaning) {
    List children = SceneVisitor::items_of(node.children);
    children.least = 1, children.most = kMostPanels, children.of = "panels", children.nested = "layoutNode";
    children.form = named_panel_format(node.children);
    v.list(sim::required(key, "[\"theta\", \"gap\"]"), children, meaning);
}

int depth_of(const LayoutNode& node) {
    int deepest = 0;
    for (const LayoutNode& child : node.children) deepest = std::max(deepest, depth_of(child));
    return deepest + 1;
}

}  // namespace

void visit(SceneVisitor& v, LayoutNode& node) {
    using Kind = LayoutNode::Kind;
    const auto shape = [&](Kind kind, const char* meaning, std::function<void(SceneVisitor&)> keys) {
        return sim::Alternative{{}, meaning, node.kind == kind, [&node, kind, keys](sim::Visitor& inside) {
                                    node.kind = kind;
                                    keys(static_cast<SceneVisitor&>(inside));
                                }};
    };
    v.alternatives({shape(Kind::panel, "A panel.", [&](SceneVisitor& s) { visit_panel(s, node.panel); }),
                    shape(Kind::rows, "Panels one below the other.",
                          [&](SceneVisitor& s) { visit_children(s, node, "rows", "Panels, from the top."); }),
                    shape(Kind::columns, "Panels side by side.",
                          [&](SceneVisitor& s) { visit_children(s, node, "columns", "Panels, from the left."); })});
    v.exclusive("rows", "columns");
    v.number("share", node.share, sim::dimension::kNone, {0, 1000, true, false, "is outside 0 … 1000"},
             "Share of the room, against its neighbours.");
}

ValueFormat layout_format(std::optional<LayoutNode>& layout) {
    const auto read = [&layout](ObjectReader& r, const Node& node, const std::string& key) {
        layout.reset();
        if (node.kind == Node::Kind::string && node.text == "auto") return;
        std::vector<LayoutNode> one;
        named_panel_format(one).read(r, node, key);
        layout = one.front();
    };
    const auto write = [&layout]() -> std::optional<Node> {
        return layout ? std::nullopt : std::optional(text_node("auto"));
    };
    return {"\"auto\", panel or object", R"({"anyOf": [{"const": "auto"}, {"$ref": "#/$defs/panelName"}]})", read,
            write};
}

// ---- what the panels ask of the motions -----------------------------------------------------------

namespace {

// What the panel shows of a contact that the picture's motions do not have; empty: nothing.
std::string without_cam(const sim::Problem& own, const Picture& picture, const PanelSpec& panel) {
    const auto has_cam = [&](std::size_t motion) {
        return (picture.compare.empty() ? own : picture.compare[motion].problem).cam.has_value();
    };
    bool any = false;
    for (std::size_t i = 0; i < std::max<std::size_t>(1, picture.compare.size()); ++i) any = any || has_cam(i);
    if (type_of(panel.kind).needs_cam)
        return has_cam(static_cast<std::size_t>(panel.member)) ? "" : type_of(panel.kind).name;
    for (const sim::Channel& channel : panel.channels)
        if (sim::needs_cam(channel.kind) && !any) return name(channel);
    return {};
}

}  // namespace

void check_layout(ObjectReader& r, const Picture& picture) {
    if (!picture.layout || !r.has("layout")) return;
    const auto refuse = [&](const std::string& problem) {
        r.fail(r.place("layout"), "layout", r.path("layout") + problem);
    };
    const std::vector<PanelSpec> panels = render::panels_of(*picture.layout);
    if (panels.size() > kMostPanels || depth_of(*picture.layout) > kDeepestLayout + 1)
        refuse(fmt::format(" is more than a picture can show; {} panels and {} levels are the most", kMostPanels,
                           kDeepestLayout));
    const std::size_t motions = std::max<std::size_t>(1, picture.compare.size());
    for (const PanelSpec& panel : panels)
        if (static_cast<std::size_t>(panel.member) >= motions)
            return refuse(
                fmt::format(": \"motion\": {} is not there; the picture shows {}", panel.member + 1, motions));
    for (const PanelSpec& panel : panels)
        if (panel.by_collision && !picture.compare.empty())
            refuse(
                fmt::format(": \"window\": \"collision\" is of one motion's collisions, and the picture compares {}; "
                            "give a time such as \"50 ms\"",
                            picture.compare.size()));
    if (r.diagnostics().failed("cam")) return;
    for (const PanelSpec& panel : panels)
        if (const std::string what = without_cam(r.context().scene.problem, picture, panel); !what.empty())
            refuse(
                fmt::format(": \"{}\" is of the contact, and there is no cam; remove the panel, or give the scene a "
                            "\"cam\"",
                            what));
}

}  // namespace beamcam::scenes
