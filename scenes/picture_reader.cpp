// How a picture is arranged, how time runs in it, and what it compares.
#include <charconv>
#include <filesystem>
#include <optional>

#include "scenes/overrides.hpp"
#include "scenes/reader.hpp"
#include "scenes/sections.hpp"

namespace beamcam::scenes {
namespace {

namespace dim = dimension;
using render::LayoutNode, render::PanelKind, render::PanelSpec;

// Reasons: a speed below a millionth makes hours of film of a millisecond; eight motions are all that colours and
// eyes tell apart; a layout deeper or larger than this fits no picture.
constexpr double kSlowest = 1e-6, kFastest = 1000;
constexpr std::size_t kMostCompared = 8, kMostPanels = 24;
constexpr int kDeepestLayout = 8;

// ---- layout ------------------------------------------------------------------------------------

std::optional<sim::Channel> known_channel(const PictureContext& c, std::string_view text) {
    for (const sim::Channel& channel : all_channels(c.scene.problem))
        if (channel.kind != sim::ChannelKind::t && name(channel) == text) return channel;
    return std::nullopt;
}

std::vector<std::string> panel_words(const PictureContext& c) {
    std::vector<std::string> words{"mechanism", "phase", "energy", "close-up", "traces", "strip"};
    for (const sim::Channel& channel : all_channels(c.scene.problem))
        if (channel.kind != sim::ChannelKind::t) words.push_back(name(channel));
    return words;
}

std::optional<PanelSpec> panel_named(const PictureContext& c, std::string_view text) {
    for (const PanelKind kind : {PanelKind::mechanism, PanelKind::strip, PanelKind::phase, PanelKind::energy,
                                 PanelKind::close_up, PanelKind::traces})
        if (text == render::name(kind)) return PanelSpec{.kind = kind};
    if (const auto channel = known_channel(c, text)) return PanelSpec{.kind = PanelKind::strip, .channels = {*channel}};
    return std::nullopt;
}

void read_strip_channels(const PictureContext& c, Fields& f, const Node& node, PanelSpec& panel) {
    if (node.kind != Node::Kind::array || node.items.empty())
        return f.fail(
            node, "channels",
            fmt::format("{} must be an array of names such as [\"theta\"], not {}", f.path("channels"), shown(node)));
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const Node& item = node.items[i];
        const std::string key = fmt::format("channels.{}", i);
        const auto channel = item.kind == Node::Kind::string ? known_channel(c, item.text) : std::nullopt;
        if (!channel) {
            std::vector<std::string> known = panel_words(c);
            known.erase(known.begin(), known.begin() + 6);
            f.fail(item, key,
                   fmt::format("{} = {} is no channel of this beam{}", f.path(key), shown(item),
                               item.kind == Node::Kind::string ? suggestion_or_list(item.text, known) : ""));
            continue;
        }
        const std::string unit = sim::unit(*channel, c.scene.problem);
        if (!panel.channels.empty() && unit != sim::unit(panel.channels.front(), c.scene.problem))
            f.fail(item, key,
                   fmt::format("{} = {} is measured in {}, {} in {}; one strip has one unit, make two of it",
                               f.path(key), in_quotes(item.text), unit.empty() ? "1" : unit,
                               name(panel.channels.front()), sim::unit(panel.channels.front(), c.scene.problem)));
        else if (std::find(panel.channels.begin(), panel.channels.end(), *channel) != panel.channels.end())
            f.fail(item, key, fmt::format("{} = {} stands twice", f.path(key), in_quotes(item.text)));
        else
            panel.channels.push_back(*channel);
    }
}

LayoutNode read_node(const PictureContext& c, Fields& parent, const Node& node, const std::string& key, int depth);

void read_children(const PictureContext& c, Fields& f, const Node& node, const char* key, int depth, LayoutNode& out) {
    if (node.kind != Node::Kind::array || node.items.empty())
        return f.fail(node, key, fmt::format("{} must be an array of panels, not {}", f.path(key), shown(node)));
    if (node.items.size() > kMostPanels || depth > kDeepestLayout)
        return f.fail(node, key,
                      fmt::format("{} is more than a picture can show; {} panels and {} levels are the most",
                                  f.path(key), kMostPanels, kDeepestLayout));
    for (std::size_t i = 0; i < node.items.size(); ++i)
        out.children.push_back(read_node(c, f, node.items[i], fmt::format("{}.{}", key, i), depth + 1));
}

void read_window(Fields& f, const Node& node, PanelSpec& panel) {
    if (node.kind == Node::Kind::string && node.text == "collision") {
        panel.by_collision = true;
        return;
    }
    double window = 0;
    if (!f.value(node, "window", dim::kTime, window)) return;
    if (!(window > 0))
        return f.fail(node, "window",
                      fmt::format("{} = {} must be positive, or \"collision\"", f.path("window"), shown(node)));
    panel.window = window;
}

LayoutNode read_panel(const PictureContext& c, Fields& f) {
    LayoutNode out;
    if (const Node* node = f.require("panel", "\"mechanism\"")) {
        const auto panel = node->kind == Node::Kind::string ? panel_named(c, node->text) : std::nullopt;
        if (panel)
            out.panel = *panel;
        else
            f.fail(*node, "panel",
                   fmt::format("{} = {} is no panel{}", f.path("panel"), shown(*node),
                               node->kind == Node::Kind::string ? suggestion_or_list(node->text, panel_words(c)) : ""));
    }
    if (const Node* node = f.take("channels")) {
        if (out.panel.kind != PanelKind::strip || !out.panel.channels.empty())
            f.fail(*node, "channels", fmt::format("{} belongs to \"panel\": \"strip\"", f.path("channels")));
        else
            read_strip_channels(c, f, *node, out.panel);
    } else if (out.panel.kind == PanelKind::strip && out.panel.channels.empty() && f.node()) {
        c.findings.error(f.node()->place, f.path("channels"),
                         fmt::format("{} is a strip and needs \"channels\", for example [\"theta\"]", f.what()));
    }
    if (const Node* node = f.take("window")) {
        if (out.panel.kind != PanelKind::strip && out.panel.kind != PanelKind::energy)
            f.fail(*node, "window", fmt::format("{} belongs to strips and \"energy\"", f.path("window")));
        else
            read_window(f, *node, out.panel);
        if (out.panel.by_collision && out.panel.kind == PanelKind::energy)
            f.fail(*node, "window", fmt::format("{} of the energies is a time, not a collision", f.path("window")));
    }
    int motion = 1;
    if (f.whole("motion", 1, static_cast<int>(kMostCompared), motion)) out.panel.member = motion - 1;
    return out;
}

LayoutNode read_node(const PictureContext& c, Fields& parent, const Node& node, const std::string& key, int depth) {
    if (node.kind == Node::Kind::string) {
        const auto panel = panel_named(c, node.text);
        if (panel && (panel->kind != PanelKind::strip || !panel->channels.empty())) return {.panel = *panel};
        if (panel)
            parent.fail(node, key,
                        fmt::format("{} = {} needs channels: write {{\"panel\": \"strip\", \"channels\": [\"theta\"]}}",
                                    parent.path(key), in_quotes(node.text)));
        else
            parent.fail(node, key,
                        fmt::format("{} = {} is no panel{}", parent.path(key), in_quotes(node.text),
                                    suggestion_or_list(node.text, panel_words(c))));
        return {};
    }
    Fields f(c.findings, &node, parent.path(key));
    LayoutNode out;
    const bool rows = f.has("rows"), columns = f.has("columns");
    if (rows || columns) {
        if (rows && columns && f.node())
            c.findings.error(f.node()->place, f.path("rows"),
                             fmt::format("{} has both \"rows\" and \"columns\"; put one into the other", f.what()));
        out.kind = rows ? LayoutNode::Kind::rows : LayoutNode::Kind::columns;
        const char* which = rows ? "rows" : "columns";
        read_children(c, f, *f.take(which), which, depth, out);
    } else {
        out = read_panel(c, f);
    }
    if (const Node* share = f.take("share"))
        if (f.value(*share, "share", dim::kNone, out.share) && !(out.share > 0 && out.share <= 1000))
            f.fail(*share, "share", fmt::format("{} = {} is outside 0 … 1000", f.path("share"), shown(*share)));
    f.finish();
    return out;
}

bool is_of_contact(sim::ChannelKind kind) {
    switch (kind) {
        case sim::ChannelKind::contact_force:
        case sim::ChannelKind::friction_force:
        case sim::ChannelKind::gap:
        case sim::ChannelKind::contact_x:
        case sim::ChannelKind::contact_s:
        case sim::ChannelKind::cam_angle:
        case sim::ChannelKind::energy_contact:
        case sim::ChannelKind::loss_contact:
        case sim::ChannelKind::loss_friction:
        case sim::ChannelKind::work_cam:
        case sim::ChannelKind::separation:
        case sim::ChannelKind::separation_paper:
            return true;
        case sim::ChannelKind::t:
        case sim::ChannelKind::theta:
        case sim::ChannelKind::theta_dot:
        case sim::ChannelKind::tip_deflection:
        case sim::ChannelKind::tip_rate:
        case sim::ChannelKind::q:
        case sim::ChannelKind::energy_kinetic:
        case sim::ChannelKind::energy_potential:
        case sim::ChannelKind::energy_elastic:
        case sim::ChannelKind::loss_structural:
        case sim::ChannelKind::work_drive:
        case sim::ChannelKind::energy_residual:
            return false;
    }
    return false;
}

// What the panel shows of a contact that the picture's motions do not have; empty: nothing.
std::string without_cam(const PictureContext& c, const Picture& picture, const PanelSpec& panel) {
    const auto has_cam = [&](std::size_t motion) {
        return (picture.compare.empty() ? c.scene.problem : picture.compare[motion].problem).cam.has_value();
    };
    bool any = false;
    for (std::size_t i = 0; i < std::max<std::size_t>(1, picture.compare.size()); ++i) any = any || has_cam(i);
    if (panel.kind == PanelKind::close_up || panel.kind == PanelKind::traces)
        return has_cam(static_cast<std::size_t>(panel.member)) ? "" : render::name(panel.kind);
    for (const sim::Channel& channel : panel.channels)
        if (is_of_contact(channel.kind) && !any) return name(channel);
    return {};
}

void read_layout(const PictureContext& c, Fields& f, Picture& picture) {
    const Node* node = f.take("layout");
    if (!node) return;
    if (node->kind == Node::Kind::string && node->text == "auto") {
        picture.layout.reset();
        return;
    }
    picture.layout = read_node(c, f, *node, "layout", 1);
    const std::vector<PanelSpec> panels = render::panels_of(*picture.layout);
    if (panels.size() > kMostPanels)
        f.fail(*node, "layout",
               fmt::format("{} has {} panels; {} are the most", f.path("layout"), panels.size(), kMostPanels));
    const std::size_t motions = std::max<std::size_t>(1, picture.compare.size());
    for (const PanelSpec& panel : panels)
        if (static_cast<std::size_t>(panel.member) >= motions)
            return f.fail(*node, "layout",
                          fmt::format("{}: \"motion\": {} is not there; the picture shows {}", f.path("layout"),
                                      panel.member + 1, motions));
    for (const PanelSpec& panel : panels)
        if (panel.by_collision && !picture.compare.empty())
            f.fail(
                *node, "layout",
                fmt::format(
                    "{}: \"window\": \"collision\" is of one motion's collisions, and the picture compares {}; give a "
                    "time such as \"50 ms\"",
                    f.path("layout"), picture.compare.size()));
    if (c.findings.failed("cam")) return;
    for (const PanelSpec& panel : panels)
        if (const std::string what = without_cam(c, picture, panel); !what.empty())
            f.fail(
                *node, "layout",
                fmt::format("{}: \"{}\" is of the contact, and there is no cam; remove the panel, or give the scene a "
                            "\"cam\"",
                            f.path("layout"), what));
}

// ---- compare -----------------------------------------------------------------------------------

// The mechanics of another scene file, beside this one.
std::optional<Node> other_scene(const PictureContext& c, Fields& f, const Node& node) {
    if (node.kind != Node::Kind::string) {
        f.fail(node, "scene", fmt::format("{} must be a file name in quotes, not {}", f.path("scene"), shown(node)));
        return std::nullopt;
    }
    const auto path = std::filesystem::path(c.file.source.name).parent_path() / node.text;
    const SceneFiles::Mechanics& other = c.file.files.mechanics(path.string());
    if (!other.sections)
        f.fail(node, "scene", fmt::format("{} = {}: {}", f.path("scene"), in_quotes(node.text), other.problem));
    return other.sections;
}

void move_all(Node& node, Place place) {
    node.place = place;
    for (Node& item : node.items) move_all(item, place);
    for (Member& member : node.members) member.key_place = place, move_all(member.value, place);
}

// Mechanics that cannot be are told at the entry that makes them so.
void judge(const PictureContext& c, const Node& place, const std::string& path, const sim::Problem& problem) {
    for (const sim::Finding& finding : sim::validate(problem))
        if (finding.fatal)
            c.findings.error(place.place, path, fmt::format("{}: {}: {}", path, finding.path, finding.message));
}

std::optional<Compared> read_compared(const PictureContext& c, Fields& parent, const Node& node, std::size_t index) {
    Fields f(c.findings, &node, parent.path(fmt::format("compare.{}", index)));
    if (!f.node()) return std::nullopt;
    Compared out;
    f.text("label", out.label);
    Node mechanics = mechanics_of(c.file.root);
    if (const Node* scene = f.take("scene")) {
        auto other = other_scene(c, f, *scene);
        if (!other) return std::nullopt;
        move_all(*other, scene->place);
        mechanics = std::move(*other);
    }
    std::vector<Message> wrong;
    if (const Node* set = f.take("set")) {
        if (set->kind != Node::Kind::object) {
            f.fail(
                *set, "set",
                fmt::format("{} must be an object such as {{\"cam.speed\": 5}}, not {}", f.path("set"), shown(*set)));
            return std::nullopt;
        }
        for (const Member& member : set->members) {
            const std::string first = member.key.substr(0, member.key.find('.'));
            if (!is_mechanics(first)) {
                c.findings.error(member.key_place, f.path("set." + member.key),
                                 fmt::format("{}: {} is no part of the mechanics; only {} can differ", f.path("set"),
                                             in_quotes(member.key), mechanics_sections()));
                continue;
            }
            set_value(mechanics, member.key, member.value, wrong);
        }
    }
    f.finish();
    for (const Message& message : wrong) c.findings.error(message.place, f.path("set"), message.text);
    Findings inner;
    Fields fields(inner, &mechanics, "");
    Scene scene;
    read_physics(inner, fields, scene);
    fields.finish();
    if (inner.any()) {
        for (const Message& message : inner.take()) c.findings.error(message.place, f.path("set"), message.text);
        return std::nullopt;
    }
    if (c.findings.failed(f.path("set"))) return std::nullopt;
    judge(c, node, f.path(""), scene.problem);
    if (out.label.empty()) out.label = fmt::format("{}", index + 1);
    out.problem = scene.problem;
    scene.name.clear();
    out.physics = to_json(scene);
    return out;
}

void read_compare(const PictureContext& c, Fields& f, Picture& picture) {
    using render::Comparison;
    f.choice<Comparison>("comparison", {{"panels", Comparison::panels}, {"ghosts", Comparison::ghosts}},
                         picture.comparison);
    const Node* node = f.take("compare");
    if (!node && picture.comparison == Comparison::ghosts && f.node())
        c.findings.warning(
            f.node()->place,
            fmt::format("{} = \"ghosts\" shows none without \"compare\", or more scenes given to `beamcam render`",
                        f.path("comparison")));
    if (!node) return;
    if (node->kind != Node::Kind::array || node->items.size() < 2 || node->items.size() > kMostCompared)
        return f.fail(*node, "compare",
                      fmt::format("{} must be an array of 2 to {} motions, for example [{{\"label\": \"flexible\"}}, "
                                  "{{\"label\": \"rigid\", \"set\": {{\"beam.model\": \"rigid\"}}}}]",
                                  f.path("compare"), kMostCompared));
    for (std::size_t i = 0; i < node->items.size(); ++i)
        if (auto compared = read_compared(c, f, node->items[i], i)) picture.compare.push_back(std::move(*compared));
}

// ---- speed and events --------------------------------------------------------------------------

bool speed_value(Fields& f, const Node& node, std::string_view key, double& out) {
    double value = 0;
    if (!f.value(node, key, dim::kNone, value)) return false;
    if (!(value >= kSlowest && value <= kFastest)) {
        f.fail(node, key,
               fmt::format("{} = {} is outside {} … {}; 1 is real time, 0.1 a tenth of it", f.path(key), shown(node),
                           kSlowest, kFastest));
        return false;
    }
    out = value;
    return true;
}

void duration_value(Fields& f, const char* key, double& out) {
    double value = 0;
    const Node* node = f.take(key);
    if (!node || !f.value(*node, key, dim::kTime, value)) return;
    if (!(value >= 0))
        f.fail(*node, key, fmt::format("{} = {} must not be negative", f.path(key), shown(*node)));
    else
        out = value;
}

void read_speed(const PictureContext& c, Fields& f, Speed& speed) {
    const Node* node = f.take("speed");
    if (!node) return;
    if (node->kind != Node::Kind::object) {
        speed_value(f, *node, "speed", speed.factor);
        return;
    }
    Fields s(c.findings, node, f.path("speed"));
    SlowMotion slow;
    bool around = false;
    if (const Node* what = s.require("around", "\"impacts\""))
        s.choice_value<bool>(*what, "around", {{"impacts", true}}, around);
    if (const Node* factor = s.take("factor")) speed_value(s, *factor, "factor", slow.factor);
    if (const Node* otherwise = s.take("otherwise")) speed_value(s, *otherwise, "otherwise", speed.factor);
    duration_value(s, "before", slow.before);
    duration_value(s, "after", slow.after);
    duration_value(s, "ease", slow.ease);
    s.finish();
    speed.around = slow;
}

void read_events(const PictureContext& c, Fields& f, std::vector<FilmEvent>& events) {
    const Node* node = f.take("events");
    if (!node) return;
    if (node->kind != Node::Kind::array)
        return f.fail(*node, "events",
                      fmt::format("{} must be an array [ … ], not {}", f.path("events"), shown(*node)));
    for (std::size_t i = 0; i < node->items.size(); ++i) {
        Fields e(c.findings, &node->items[i], f.path(fmt::format("events.{}", i)));
        if (!e.node()) continue;
        FilmEvent event;
        if (const Node* at = e.require("at", "\"impact:1\"")) read_at(e, *at, "at", event.at);
        duration_value(e, "freeze", event.freeze);
        duration_value(e, "show", event.show);
        e.text("text", event.text);
        e.finish();
        events.push_back(std::move(event));
    }
}

}  // namespace

std::optional<Instant> parse_instant(std::string_view text) {
    for (const auto& [word, kind] : {std::pair{std::string_view("impact:"), Instant::Kind::impact},
                                     std::pair{std::string_view("collision:"), Instant::Kind::collision}}) {
        if (!text.starts_with(word)) continue;
        const std::string_view digits = text.substr(word.size());
        Instant out{.kind = kind};
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out.number);
        const bool whole = error == std::errc{} && end == digits.data() + digits.size() && digits.front() != '0';
        return whole && out.number >= 1 ? std::optional(out) : std::nullopt;
    }
    return std::nullopt;
}

bool read_at(Fields& f, const Node& node, std::string_view key, Instant& out) {
    if (node.kind == Node::Kind::string && (node.text.starts_with("impact") || node.text.starts_with("collision"))) {
        const auto instant = parse_instant(node.text);
        if (!instant) {
            f.fail(node, key,
                   fmt::format("{} = {}: impacts and collisions are counted from 1, \"impact:1\"", f.path(key),
                               in_quotes(node.text)));
            return false;
        }
        out = *instant;
        return true;
    }
    double t = 0;
    if (!f.value(node, key, dim::kTime, t)) return false;
    if (t < 0) {
        f.fail(node, key, fmt::format("{} = {} is before the start; times begin at 0", f.path(key), shown(node)));
        return false;
    }
    out = {.kind = Instant::Kind::time, .t = t};
    return true;
}

void read_arrangement(const PictureContext& context, Fields& f, Picture& picture) {
    read_compare(context, f, picture);
    read_layout(context, f, picture);
}

void read_pace(const PictureContext& context, Fields& f, FrameSpan& span) {
    read_speed(context, f, span.speed);
    read_events(context, f, span.events);
}

}  // namespace beamcam::scenes
