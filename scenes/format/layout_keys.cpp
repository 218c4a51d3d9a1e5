// The keys of a layout: panels in rows and columns.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/format/checks.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/value_formats.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

using render::LayoutNode, render::PanelKind, render::PanelSpec, render::PanelType;

namespace {

constexpr std::size_t kMostPanels = 24;  // larger or deeper layouts do not fit into a picture
constexpr int kDeepestLayout = 8;

// ---- panels ------------------------------------------------------------------------------------

// The channels that a strip can show: all but the time.
std::vector<sim::Channel> strip_channels(const sim::Problem& problem) {
    std::vector<sim::Channel> channels = all_channels(problem);
    std::erase_if(channels, [](const sim::Channel& channel) { return channel.kind == sim::ChannelKind::t; });
    return channels;
}

void read_panel(ObjectReader& r, const Node& node, const std::string& key, PanelSpec& out) {
    const std::vector<sim::Channel> channels = strip_channels(r.context().scene.problem);
    std::vector<std::string> names;
    for (const PanelType& type : render::panel_types()) names.emplace_back(type.name);
    const std::size_t panels = names.size();
    std::ranges::move(channel_names(channels), std::back_inserter(names));
    const auto found = static_cast<std::size_t>(std::ranges::find(names, node.text) - names.begin());
    if (node.kind != Node::Kind::string || found == names.size()) {
        r.reject_value(node, key, " is not a panel{}",
                       node.kind == Node::Kind::string ? suggestion_or_list(node.text, names) : "");
    } else if (found < panels) {
        out.kind = render::panel_types()[found].kind;
    } else {
        out.kind = PanelKind::strip;
        out.channels = {channels[found - panels]};
    }
}

ValueFormat panel_format(PanelSpec& panel) {
    return {"panel or channel", R"({"anyOf": [{"const": "strip"}, {"$ref": "#/$defs/panelName"}]})",
            [&panel](ObjectReader& r, const Node& node, const std::string& key) { read_panel(r, node, key, panel); },
            [&panel] { return Node(type_of(panel.kind).name); }};
}

void check_strip_units(ObjectReader& r, const std::string& key, const std::vector<sim::Channel>& channels) {
    const sim::Problem& problem = r.context().scene.problem;
    for (std::size_t i = 1; i < channels.size(); ++i)
        if (const std::string unit = sim::unit(channels[i], problem), first = sim::unit(channels.front(), problem);
            unit != first)
            r.reject(fmt::format("{}.{}", key, i),
                     ": {} is measured in {}, but {} in {}; a strip has one unit: use two strips", name(channels[i]),
                     unit.empty() ? "1" : unit, name(channels.front()), first.empty() ? "1" : first);
}

bool is_strip(const ObjectReader& r) { return r.place("panel").text == type_of(PanelKind::strip).name; }

ValueFormat strip_channels_format(PanelSpec& panel) {
    ValueFormat format = channels_format(panel.channels);
    format.read = [&panel](ObjectReader& r, const Node& node, const std::string& key) {
        if (!is_strip(r)) return r.reject(key, " belongs to \"panel\": \"strip\"");
        const std::size_t items = node.items.size();
        read_channels(r, node, key, strip_channels(r.context().scene.problem), panel.channels);
        if (panel.channels.size() == items) check_strip_units(r, key, panel.channels);
    };
    return format;
}

ValueFormat window_format(PanelSpec& panel) {
    const auto read = [&panel](ObjectReader& r, const Node& node, const std::string& key) {
        if (!type_of(panel.kind).takes_window) return r.reject(key, " belongs to the panels \"strip\" and \"energy\"");
        panel.by_collision = node.kind == Node::Kind::string && node.text == "collision";
        if (panel.by_collision && !type_of(panel.kind).takes_collisions)
            return r.reject(key, " of the panel \"energy\" must be a time, not \"collision\"");
        if (panel.by_collision) return;
        if (const auto window =
                r.ranged_value(node, key, sim::dimension::kTime,
                               {0, sim::Range::kInfinity, true, false, "must be positive, or \"collision\""}))
            panel.window = window;
    };
    const auto write = [&panel] { return panel.by_collision ? Node("collision") : Node(panel.window); };
    return {
        "time or \"collision\"",
        R"({"anyOf": [{"const": "collision"}, {"type": "number", "exclusiveMinimum": 0}, {"$ref": "#/$defs/withUnit"}]})",
        read, write};
}

// "mechanism, strip, …"
std::string names_of_panels() {
    std::vector<std::string> names;
    for (const PanelType& type : render::panel_types()) names.emplace_back(type.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void visit_panel(SceneVisitor& v, PanelSpec& panel) {
    v.value(sim::required("panel", "\"mechanism\""), panel_format(panel),
            (names_of_panels() + ", or a channel.").c_str());
    v.value("channels", strip_channels_format(panel), "Of a strip: its curves, all of one unit.");
    v.check([&panel](ObjectReader& r) {
        if (panel.kind == PanelKind::strip && r.has("panel") && !r.has("channels") && panel.channels.empty())
            r.reject_object("channels", " is a strip; it needs \"channels\", for example [\"theta\"]");
    });
    v.value("window", window_format(panel),
            "Of a strip or the energies: length of the time axis; by default all of the time. Of a strip also "
            "\"collision\": one collision at a time.");
    int motion = panel.member + 1;
    v.integer(sim::written_if(motion > 1, "motion"), motion, 1, static_cast<int>(kMostCompared),
              "Number of the compared motion, counted from 1.");
    panel.member = motion - 1;
}

// ---- rows and columns --------------------------------------------------------------------------

// An item that is only a name.
ValueFormat named_panel_format(std::vector<LayoutNode>& children) {
    const auto read = [&children](ObjectReader& r, const Node& node, const std::string& key) {
        LayoutNode& child = children.emplace_back();
        if (node.kind == Node::Kind::string && node.text == type_of(PanelKind::strip).name)
            r.reject_value(node, key, " needs channels: write {{\"panel\": \"strip\", \"channels\": [\"theta\"]}}");
        else if (node.kind != Node::Kind::string)
            r.expect(node, key, "a panel's name or an object {{ … }}");
        else
            read_panel(r, node, key, child.panel);
    };
    return {"panel or channel", R"({"$ref": "#/$defs/panelName"})", read, [] { return Node(); }};
}

void visit_children(SceneVisitor& v, LayoutNode& node, const char* key, const char* meaning) {
    List children = SceneVisitor::items_of(node.children);
    children.min_size = 1, children.max_size = kMostPanels, children.of = "panels", children.nested = "layoutNode";
    children.format = named_panel_format(node.children);
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
    const auto shape = [&](Kind kind, const char* meaning, const std::function<void(SceneVisitor&)>& keys) {
        return sim::Alternative{{}, meaning, node.kind == kind, [&node, kind, keys](sim::Visitor& inside) {
                                    node.kind = kind;
                                    keys(static_cast<SceneVisitor&>(inside));
                                }};
    };
    v.alternatives({shape(Kind::panel, "A panel.", [&](SceneVisitor& s) { visit_panel(s, node.panel); }),
                    shape(Kind::rows, "Panels from top to bottom.",
                          [&](SceneVisitor& s) { visit_children(s, node, "rows", "Panels or layouts."); }),
                    shape(Kind::columns, "Panels from left to right.",
                          [&](SceneVisitor& s) { visit_children(s, node, "columns", "Panels or layouts."); })});
    v.exclusive("rows", "columns");
    v.number("share", node.share, sim::dimension::kNone, {0, 1000, true, false, "is outside 0 … 1000"},
             "Share of the width or height, relative to the neighbours.");
}

ValueFormat layout_format(std::optional<LayoutNode>& layout) {
    const auto read = [&layout](ObjectReader& r, const Node& node, const std::string& key) {
        layout.reset();
        if (node.kind == Node::Kind::string && node.text == "auto") return;
        std::vector<LayoutNode> one;
        named_panel_format(one).read(r, node, key);
        layout = one.front();
    };
    return {"\"auto\", panel or object", R"({"anyOf": [{"const": "auto"}, {"$ref": "#/$defs/panelName"}]})", read,
            [&layout] { return layout ? Node() : Node("auto"); }};
}

// ---- rules between panels and motions ----------------------------------------------------------

namespace {

// The panel or channel that needs a cam, if the motions that it shows have none; else empty.
std::string needs_missing_cam(const sim::Problem& own, const Picture& picture, const PanelSpec& panel) {
    const auto has_cam = [&](std::size_t motion) {
        return (picture.compare.empty() ? own : picture.compare[motion].problem).cam.has_value();
    };
    bool any = false;
    for (std::size_t i = 0; i < std::max<std::size_t>(1, picture.compare.size()); ++i) any = any || has_cam(i);
    if (type_of(panel.kind).needs_cam)
        return has_cam(static_cast<std::size_t>(panel.member)) ? "" : type_of(panel.kind).name;
    for (const sim::Channel& channel : panel.channels)
        if (sim::traits(channel.kind).needs_cam && !any) return name(channel);
    return {};
}

}  // namespace

void check_layout(ObjectReader& r, const Picture& picture) {
    if (!picture.layout || !r.has("layout")) return;
    const std::vector<PanelSpec> panels = render::panels_of(*picture.layout);
    if (panels.size() > kMostPanels || depth_of(*picture.layout) > kDeepestLayout + 1)
        r.reject("layout", " is too large for a picture; use at most {} panels and {} levels", kMostPanels,
                 kDeepestLayout);
    const std::size_t motions = std::max<std::size_t>(1, picture.compare.size());
    for (const PanelSpec& panel : panels)
        if (static_cast<std::size_t>(panel.member) >= motions)
            return r.reject("layout", ": \"motion\": {} does not exist; the picture shows {}", panel.member + 1,
                            counted(motions, "motion"));
    for (const PanelSpec& panel : panels)
        if (panel.by_collision && !picture.compare.empty())
            r.reject("layout",
                     ": \"window\": \"collision\" needs one motion, but the picture compares {}; write a time such as "
                     "\"50 ms\"",
                     picture.compare.size());
    if (r.diagnostics().failed("cam")) return;
    for (const PanelSpec& panel : panels)
        if (const std::string shown = needs_missing_cam(r.context().scene.problem, picture, panel); !shown.empty())
            r.reject("layout",
                     ": \"{}\" shows contact data, but the scene has no cam; remove the panel, or add a \"cam\"",
                     shown);
}

}  // namespace beamcam::scenes
