#include "scenes/format/value_formats.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numeric>

#include "output/files/numbers.hpp"
#include "output/film/video.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {

namespace {

using output::number_in;

// Below 16 px nothing can be drawn; 16384 px is OpenGL's largest viewport.
constexpr int kSmallestSide = 16, kLargestSide = 16384;
constexpr double kSlowestFrameRate = 0.1, kFastestFrameRate = 1000;  // [Hz]; players fail long before

// The format of a value that is always present, by the format of an optional value.
template <class T>
ValueFormat of_present(T& value, ValueFormat (*format)(std::optional<T>&)) {
    std::optional<T> unused;
    ValueFormat out = format(unused);
    out.read = [&value, format](ObjectReader& r, const Node& node, const std::string& key) {
        std::optional<T> read = value;
        format(read).read(r, node, key);
        value = read.value_or(value);
    };
    out.write = [&value, format] {
        std::optional<T> present = value;
        return format(present).write();
    };
    return out;
}

// ---- files -------------------------------------------------------------------------------------

std::string schema_of_file(const std::vector<const char*>& endings, bool numbered) {
    std::string kinds;
    for (const char* ending : endings) kinds += (kinds.empty() ? "" : "|") + std::string(ending + 1);
    static constexpr const char* kInside = R"(^(?!/)(?!.*(^|/)\\.\\.(/|$))(?!(.*/)?\\.[^/]*$))";
    return fmt::format(R"({{"type": "string", "minLength": 1, "maxLength": 4096, "pattern": "{}{}\\.({})$"}})", kInside,
                       numbered ? R"([^#\\u0000-\\u001f\\u007f]*#{1,9}[^/#\\u0000-\\u001f\\u007f]*)"
                                : R"([^#\\u0000-\\u001f\\u007f]+)",
                       kinds);
}

std::string problem_with_name(const std::string& name, const std::vector<const char*>& endings, bool numbered) {
    if (std::string problem = problem_with_file(name); !problem.empty()) return problem;
    const std::string ending = std::filesystem::path(name).extension().string();
    if (std::ranges::find(endings, ending) == endings.end())
        return fmt::format("its name must end in {}", fmt::join(endings, " or "));
    if (numbered) return problem_with_numbering(name);
    return name.find('#') == std::string::npos
               ? ""
               : "only the output \"frames\" can have '#' in its name; choose another name";
}

ValueFormat file_format(std::string& file, const std::vector<const char*>& endings, bool numbered) {
    const auto read = [&file, endings, numbered](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::string)
            return r.fail(node, key,
                          fmt::format("{} must be a file name in quotes, not {}", r.path(key), as_written(node)));
        if (std::string problem = problem_with_name(node.text, endings, numbered); !problem.empty())
            return r.fail(node, key, fmt::format("{} = {}: {}", r.path(key), in_quotes(node.text), problem));
        file = node.text;
    };
    const auto write = [&file]() -> std::optional<Node> {
        return file.empty() ? std::nullopt : std::optional(text_node(file));
    };
    return {"file name", schema_of_file(endings, numbered), read, write};
}

}  // namespace

ValueFormat file_format(std::string& file, std::initializer_list<const char*> endings) {
    return file_format(file, std::vector(endings), false);
}
ValueFormat numbered_file_format(std::string& file) { return file_format(file, {".png"}, true); }

// ---- size and frame rate -----------------------------------------------------------------------

std::optional<Size> parse_size(std::string_view text) {
    const std::size_t x = text.find('x');
    if (x == std::string_view::npos) return std::nullopt;
    const auto width = number_in<int>(text.substr(0, x)), height = number_in<int>(text.substr(x + 1));
    const bool fits =
        width && height && std::min(*width, *height) >= kSmallestSide && std::max(*width, *height) <= kLargestSide;
    return fits ? std::optional(Size{*width, *height}) : std::nullopt;
}

ValueFormat size_format(Size& size) {
    const auto read = [&size](ObjectReader& r, const Node& node, const std::string& key) {
        if (const auto parsed = node.kind == Node::Kind::string ? parse_size(node.text) : std::nullopt) {
            size = *parsed;
            return;
        }
        if (node.kind != Node::Kind::array || node.items.size() != 2)
            return r.fail(node, key,
                          fmt::format("{} must be [width, height] or \"WIDTHxHEIGHT\" in pixels, {} to {} each, not {}",
                                      r.path(key), kSmallestSide, kLargestSide, as_written(node)));
        Size given;
        const bool fine = r.integer_value(node.items[0], key + ".0", kSmallestSide, kLargestSide, given.width) &
                          r.integer_value(node.items[1], key + ".1", kSmallestSide, kLargestSide, given.height);
        if (fine) size = given;
    };
    return {
        "[width, height] or \"1280x720\"",
        fmt::format(
            R"-({{"anyOf": [{{"type": "array", "items": {{"type": "integer", "minimum": {}, "maximum": {}}}, )-"
            R"-("minItems": 2, "maxItems": 2}}, {{"type": "string", "pattern": "^[0-9]{{2,5}}x[0-9]{{2,5}}$"}}]}})-",
            kSmallestSide, kLargestSide),
        read, [&size] {
            return array_node({integer_node(size.width), integer_node(size.height)});
        }};
}

std::optional<FrameRate> parse_frame_rate(std::string_view text) {
    FrameRate rate;
    if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
        const auto over = number_in<int>(text.substr(0, slash)), under = number_in<int>(text.substr(slash + 1));
        if (!over || !under) return std::nullopt;
        rate = {*over, *under};
    } else {
        const auto value = number_in<double>(text);
        if (!value || !(*value >= kSlowestFrameRate && *value <= kFastestFrameRate)) return std::nullopt;
        const output::FrameRate exact = output::frame_rate(*value);  // 29.97 means 30000/1001
        rate = {exact.rate, exact.base};
    }
    if (rate.numerator <= 0 || rate.denominator <= 0 || rate.value() < kSlowestFrameRate ||
        rate.value() > kFastestFrameRate)
        return std::nullopt;
    const int divisor = std::gcd(rate.numerator, rate.denominator);
    return FrameRate{rate.numerator / divisor, rate.denominator / divisor};
}

ValueFormat frame_rate_format(FrameRate& rate) {
    const auto read = [&rate](ObjectReader& r, const Node& node, const std::string& key) {
        const bool readable = node.kind == Node::Kind::number || node.kind == Node::Kind::string;
        if (const auto parsed = readable ? parse_frame_rate(node.text) : std::nullopt)
            rate = *parsed;
        else
            r.fail(node, key,
                   fmt::format("{} = {} is not a frame rate; write {} … {} frames a second, or a fraction such as "
                               "\"30000/1001\"",
                               r.path(key), as_written(node), kSlowestFrameRate, kFastestFrameRate));
    };
    const auto write = [&rate] {
        return rate.denominator == 1 ? integer_node(rate.numerator)
                                     : text_node(fmt::format("{}/{}", rate.numerator, rate.denominator));
    };
    return {"number or \"30000/1001\"",
            fmt::format(R"({{"oneOf": [{{"type": "number", "minimum": {}, "maximum": {}}}, {{"type": "string", )"
                        R"("pattern": "^(?!0+(\\.0*)?(/|$))[0-9]+(\\.[0-9]+|/[0-9]*[1-9][0-9]*)?$"}}]}})",
                        kSlowestFrameRate, kFastestFrameRate),
            read, write};
}

// ---- instants and speed ------------------------------------------------------------------------

std::optional<Instant> parse_instant(std::string_view text) {
    if (text == "last") return Instant{.kind = Instant::Kind::last};
    for (const EventWord& event : kEventWords) {
        if (!text.starts_with(event.word)) continue;
        std::string_view digits = text.substr(event.word.size());
        if (digits.empty() && event.alone) return Instant{.kind = event.kind};
        if (!digits.starts_with(':') || digits.starts_with(":0")) return std::nullopt;
        const auto number = number_in<int>(digits.substr(1));
        return number && *number >= 1 ? std::optional(Instant{.kind = event.kind, .number = *number}) : std::nullopt;
    }
    return std::nullopt;
}

bool names_event(std::string_view text) {
    const auto begins = [&](const EventWord& event) { return text.starts_with(event.word); };
    return text.starts_with("last") || std::ranges::any_of(kEventWords, begins);
}

namespace {

std::optional<Node> written(const std::optional<Instant>& at) {
    if (!at) return std::nullopt;
    if (at->kind == Instant::Kind::time) return number_node(at->t);
    for (const EventWord& event : kEventWords)
        if (event.kind == at->kind) return text_node(fmt::format("{}:{}", event.word, at->number));
    return text_node("last");
}

}  // namespace

ValueFormat instant_format(std::optional<Instant>& at) {
    const auto read = [&at](ObjectReader& r, const Node& node, const std::string& key) {
        double t = 0;
        if (node.kind == Node::Kind::string && names_event(node.text)) {
            if (const auto instant = parse_instant(node.text))
                at = instant;
            else
                r.fail(node, key, fmt::format("{} = {}: {}", r.path(key), in_quotes(node.text), kEventsCount));
        } else if (r.ranged_value(node, key, sim::dimension::kTime, kFromStart, t)) {
            at = {.kind = Instant::Kind::time, .t = t};
        }
    };
    return {"time, \"impact:N\", \"collision:N\", \"apex:N\", \"touch\", \"release\" or \"last\"",
            R"({"$ref": "#/$defs/instant"})", read, [&at] { return written(at); }};
}

ValueFormat instant_format(Instant& at) { return of_present(at, instant_format); }

void set_bound(const Instant& at, std::optional<double>& time, std::optional<Instant>& event) {
    event.reset();
    time.reset();
    if (at.is_event())
        event = at;
    else if (at.kind == Instant::Kind::time)
        time = at.t;
}

ValueFormat bound_format(std::optional<double>& time, std::optional<Instant>& event) {
    std::optional<Instant> unused;
    ValueFormat out = instant_format(unused);
    out.read = [&](ObjectReader& r, const Node& node, const std::string& key) {
        std::optional<Instant> read;
        instant_format(read).read(r, node, key);
        if (read) set_bound(*read, time, event);
    };
    out.write = [&] { return event ? written(event) : time ? written(Instant{.t = *time}) : std::nullopt; };
    return out;
}

ValueFormat bound_format(double& time, std::optional<Instant>& event) {
    std::optional<double> unused;
    ValueFormat out = bound_format(unused, event);
    out.read = [&](ObjectReader& r, const Node& node, const std::string& key) {
        std::optional<double> read;
        bound_format(read, event).read(r, node, key);
        time = read.value_or(time);
    };
    out.write = [&] { return event ? written(event) : written(Instant{.t = time}); };
    return out;
}

ValueFormat speed_format(Speed& speed) {
    const auto read = [&speed](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind == Node::Kind::string && node.text == "impacts")
            speed.around = SlowMotion{}, speed.intervals.clear();
        else
            r.ranged_value(node, key, sim::dimension::kNone, kSpeedRange, speed.factor);
    };
    const auto write = [&speed]() -> std::optional<Node> {
        return speed.around || !speed.intervals.empty() ? std::nullopt : std::optional(number_node(speed.factor));
    };
    return {
        "factor, \"impacts\" or object",
        R"({"anyOf": [{"const": "impacts"}, {"type": "number", "minimum": 1e-06, "maximum": 1000}, {"$ref": "#/$defs/percentage"}]})",
        read, write};
}

// ---- places of the mechanism -------------------------------------------------------------------

namespace {

constexpr std::pair<render::Anchor::Kind, const char*> kAnchors[] = {{render::Anchor::Kind::all, "all"},
                                                                     {render::Anchor::Kind::tip, "tip"},
                                                                     {render::Anchor::Kind::contact, "contact"},
                                                                     {render::Anchor::Kind::cam, "cam"},
                                                                     {render::Anchor::Kind::hub, "hub"}};

std::optional<Node> written(const std::optional<render::Anchor>& anchor) {
    if (!anchor) return std::nullopt;
    for (const auto& [kind, name] : kAnchors)
        if (anchor->kind == kind) return text_node(name);
    return numbers_node({anchor->place.x, anchor->place.y});
}

}  // namespace

ValueFormat anchor_format(std::optional<render::Anchor>& anchor) {
    const auto read = [&anchor](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind == Node::Kind::array && node.items.size() == 2) {
            sim::Vec2 at;
            if (r.number_value(node.items[0], key + ".0", sim::dimension::kLength, at.x) &&
                r.number_value(node.items[1], key + ".1", sim::dimension::kLength, at.y))
                anchor = {render::Anchor::Kind::place, at};
            return;
        }
        std::vector<std::string> names;
        for (const auto& [kind, name] : kAnchors) {
            if (node.kind == Node::Kind::string && node.text == name) return void(anchor = {kind, {}});
            names.emplace_back(name);
        }
        r.fail(node, key,
               fmt::format("{} = {} is neither a place [x, y] nor a part of the mechanism{}", r.path(key),
                           as_written(node), suggestion_or_list(node.text, names)));
    };
    return {"\"all\", \"tip\", \"contact\", \"cam\", \"hub\" or [x, y]", R"({"$ref": "#/$defs/anchor"})", read,
            [&anchor] { return written(anchor); }};
}

ValueFormat anchor_format(render::Anchor& anchor) { return of_present(anchor, anchor_format); }

// ---- colours, parts of the picture -------------------------------------------------------------

static std::optional<std::uint32_t> color_of(std::string_view text) {
    if (text.size() != 7 || text.front() != '#') return std::nullopt;
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

ValueFormat color_format(std::optional<std::uint32_t>& color) {
    const auto read = [&color](ObjectReader& r, const Node& node, const std::string& key) {
        color = node.kind == Node::Kind::string ? color_of(node.text) : std::nullopt;
        if (!color)
            r.fail(
                node, key,
                fmt::format("{} = {} is not a colour; write for example \"#0072b2\"", r.path(key), as_written(node)));
    };
    const auto write = [&color]() -> std::optional<Node> {
        if (!color) return std::nullopt;
        return text_node(fmt::format("#{:06x}", *color));
    };
    return {"\"#rrggbb\"", R"({"type": "string", "pattern": "^#[0-9a-fA-F]{6}$"})", read, write};
}

bool set_background(std::string_view text, render::View& view) {
    view.transparent = text == "transparent";
    view.paper.reset();
    if (view.transparent || text == "paper") return true;
    view.paper = color_of(text);
    return view.paper.has_value();
}

ValueFormat background_format(render::View& view) {
    const auto read = [&view](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::string || !set_background(node.text, view))
            r.fail(node, key,
                   fmt::format("{} = {} is not a background; write \"paper\", \"transparent\" or a colour such as "
                               "\"#f4f1ea\"",
                               r.path(key), as_written(node)));
    };
    const auto write = [&view] {
        return text_node(view.paper ? fmt::format("#{:06x}", *view.paper) : view.transparent ? "transparent" : "paper");
    };
    return {"\"paper\", \"transparent\" or \"#rrggbb\"",
            R"({"anyOf": [{"enum": ["paper", "transparent"]}, {"type": "string", "pattern": "^#[0-9a-fA-F]{6}$"}]})",
            read, write};
}

std::optional<render::Shown> shown_preset(std::string_view name) {
    if (name == "all") return render::Shown{};
    if (name == "talk") return render::Shown{.parameters = false, .accuracy = false};
    if (name == "paper") return render::Shown{.title = false, .parameters = false, .accuracy = false};
    if (name == "clean") return render::Shown{false, false, false, false, false, false};
    return std::nullopt;
}

static render::Shown sized(render::Shown show, double size) {
    show.size = size;
    return show;
}

ValueFormat show_format(render::Shown& show) {
    const auto read = [&show](ObjectReader& r, const Node& node, const std::string& key) {
        const auto preset = node.kind == Node::Kind::string ? shown_preset(node.text) : std::nullopt;
        if (preset)
            show = sized(*preset, show.size);
        else
            r.fail(node, key,
                   fmt::format("{} = {} is not a preset{}", r.path(key), as_written(node),
                               suggestion_or_list(node.text, {std::begin(kPresets), std::end(kPresets)})));
    };
    const auto write = [&show]() -> std::optional<Node> {
        for (const char* name : kPresets)
            if (show == sized(*shown_preset(name), show.size)) return text_node(name);
        return std::nullopt;
    };
    return {"preset or object", fmt::format(R"({{"enum": ["{}"]}})", fmt::join(kPresets, "\", \"")), read, write};
}

// ---- channels ----------------------------------------------------------------------------------

std::vector<std::string> channel_names(const std::vector<sim::Channel>& channels) {
    std::vector<std::string> names;
    for (const sim::Channel& channel : channels) names.push_back(name(channel));
    return names;
}

void read_channels(ObjectReader& r, const Node& node, const std::string& key, const std::vector<sim::Channel>& allowed,
                   std::vector<sim::Channel>& out) {
    if (node.kind != Node::Kind::array || node.items.empty())
        return r.fail(node, key,
                      fmt::format("{} must be an array of names such as [\"theta\", \"gap\"], not {}", r.path(key),
                                  as_written(node)));
    const std::vector<std::string> names = channel_names(allowed);
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const Node& item = node.items[i];
        const std::string at = fmt::format("{}.{}", key, i);
        const auto fail = [&](const std::string& problem) {
            r.fail(item, at, fmt::format("{} = {} {}", r.path(at), as_written(item), problem));
        };
        const auto found = std::ranges::find(names, item.text);
        if (item.kind != Node::Kind::string)
            r.fail(item, at,
                   fmt::format("{} must be the name of a channel in quotes, not {}", r.path(at), as_written(item)));
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
    const auto write = [&channels]() -> std::optional<Node> {
        if (channels.empty()) return std::nullopt;
        Node names = array_node();
        for (std::string& name : channel_names(channels)) names.items.push_back(text_node(std::move(name)));
        return names;
    };
    return {"[channel, …]",
            R"({"type": "array", "minItems": 1, "uniqueItems": true, "items": {"$ref": "#/$defs/channel"}})", read,
            write};
}

std::vector<SeriesPanel> panels_by_unit(const std::vector<sim::Channel>& channels, const sim::Problem& problem) {
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
    format.write = [] { return std::nullopt; };  // the key "panels" is written instead
    return format;
}

ValueFormat abscissa_format(std::string& against) {
    const auto read = [&against](ObjectReader& r, const Node& node, const std::string& key) {
        std::vector<std::string> known = channel_names(all_channels(r.context().scene.problem));
        known.insert(known.begin(), {"turns", "phase", "frequency"});
        if (node.kind != Node::Kind::string || std::ranges::find(known, node.text) == known.end())
            return r.fail(node, key,
                          fmt::format("{} = {} is neither \"turns\", \"phase\", \"frequency\" nor a channel{}",
                                      r.path(key), as_written(node), suggestion_or_list(node.text, known)));
        against = node.text;
    };
    return {"channel, \"turns\", \"phase\" or \"frequency\"",
            R"({"anyOf": [{"enum": ["turns", "phase", "frequency"]}, {"$ref": "#/$defs/channel"}]})", read,
            [&against] { return text_node(against); }};
}

}  // namespace beamcam::scenes
