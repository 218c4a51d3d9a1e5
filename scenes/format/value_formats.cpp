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

constexpr sim::Range kFromStart{0, sim::Range::kInfinity, false, false, "is negative; times begin at 0"};
// Below 16 px nothing can be drawn; 16384 px is OpenGL's largest viewport.
constexpr int kSmallestSide = 16, kLargestSide = 16384;
constexpr double kSlowestFrameRate = 0.1, kFastestFrameRate = 1000;  // [Hz]; players fail long before

// The format of `value`, which is a T or a std::optional<T>. `read` returns the T, or reports why there is none.
template <class Value, class Read, class Write>
ValueFormat format_of(Value& value, const char* type, std::string schema, Read read, Write write) {
    const auto write_present = [&value, write]() -> std::optional<Node> {
        if constexpr (requires { value.has_value(); })
            return value ? write(*value) : std::nullopt;
        else
            return write(value);
    };
    const auto read_into = [&value, read](ObjectReader& r, const Node& node, const std::string& key) {
        if (const auto given = read(r, node, key)) value = *given;
    };
    return {type, std::move(schema), read_into, write_present};
}

std::string text_of(const Node& node) { return node.kind == Node::Kind::string ? node.text : ""; }

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

}  // namespace

ValueFormat file_format(std::string& file, std::initializer_list<const char*> allowed, bool numbered) {
    const std::vector<const char*> endings(allowed);
    const auto read = [&file, endings, numbered](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::string) return r.expect(node, key, "a file name in quotes");
        if (std::string problem = problem_with_name(node.text, endings, numbered); !problem.empty())
            return r.reject_value(node, key, ": {}", problem);
        file = node.text;
    };
    const auto write = [&file]() -> std::optional<Node> {
        return file.empty() ? std::nullopt : std::optional<Node>(file);
    };
    return {"file name", schema_of_file(endings, numbered), read, write};
}

void visit_file(SceneVisitor& v, std::string& file, std::initializer_list<const char*> endings, const char* ending,
                const char* meaning, const char* note) {
    const std::string text =
        fmt::format("{}; by default NAME{}, where NAME is the name of the scene.{}", meaning, ending, note);
    v.value("file", file_format(file, endings, is_numbered(ending)), text.c_str());
    v.check([&file, ending](ObjectReader& r) {
        if (file.empty()) file = r.context().scene.name + ending;
    });
}

void visit_rows(SceneVisitor& v, double& rate, std::vector<double>& times) {
    v.number(sim::written_if(times.empty(), "rate"), rate, sim::dimension::kFrequency, sim::kPositive,
             "Rows at the times k/rate, and at the end.");
    v.numbers("times", times, sim::dimension::kTime, kFromStart, {1}, "Rows at exactly these times, in this order.");
    v.exclusive("rate", "times");
}

void visit_exaggeration(SceneVisitor& v, std::optional<double>& factor, const char* meaning) {
    v.number(sim::written_if(factor.has_value(), "exaggeration"), factor, sim::kPlainNumber,
             sim::between(1, 1e6, "is outside 1 (true shape) … 1e6"), meaning, "auto");
}

// ---- size and frame rate -----------------------------------------------------------------------

namespace {

std::optional<Size> parse_size(std::string_view text) {
    const std::size_t x = text.find('x');
    if (x == std::string_view::npos) return std::nullopt;
    const auto width = number_in<int>(text.substr(0, x)), height = number_in<int>(text.substr(x + 1));
    const bool fits =
        width && height && std::min(*width, *height) >= kSmallestSide && std::max(*width, *height) <= kLargestSide;
    return fits ? std::optional(Size{*width, *height}) : std::nullopt;
}

std::optional<Size> read_size(ObjectReader& r, const Node& node, const std::string& key) {
    if (const auto parsed = parse_size(text_of(node))) return parsed;
    Size given;
    if (node.kind != Node::Kind::array || node.items.size() != 2) {
        r.expect(node, key, "[width, height] or \"WIDTHxHEIGHT\" in pixels, {} to {} each", kSmallestSide,
                 kLargestSide);
        return std::nullopt;
    }
    const bool fine = r.integer_value(node.items[0], key + ".0", kSmallestSide, kLargestSide, given.width) &
                      r.integer_value(node.items[1], key + ".1", kSmallestSide, kLargestSide, given.height);
    return fine ? std::optional(given) : std::nullopt;
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

std::optional<FrameRate> read_frame_rate(ObjectReader& r, const Node& node, const std::string& key) {
    const bool readable = node.kind == Node::Kind::number || node.kind == Node::Kind::string;
    const auto rate = readable ? parse_frame_rate(node.text) : std::nullopt;
    if (!rate)
        r.reject_value(node, key,
                       " is not a frame rate; write {} … {} frames a second, or a fraction such as \"30000/1001\"",
                       kSlowestFrameRate, kFastestFrameRate);
    return rate;
}

}  // namespace

ValueFormat size_format(Size& size) {
    const auto write = [](const Size& one) { return std::optional(array_node({one.width, one.height})); };
    return format_of(
        size, "[width, height] or \"1280x720\"",
        fmt::format(
            R"-({{"anyOf": [{{"type": "array", "items": {{"type": "integer", "minimum": {}, "maximum": {}}}, )-"
            R"-("minItems": 2, "maxItems": 2}}, {{"type": "string", "pattern": "^[0-9]{{2,5}}x[0-9]{{2,5}}$"}}]}})-",
            kSmallestSide, kLargestSide),
        read_size, write);
}

ValueFormat frame_rate_format(FrameRate& rate) {
    const auto write = [](const FrameRate& one) {
        return std::optional(one.denominator == 1 ? Node(one.numerator)
                                                  : Node(fmt::format("{}/{}", one.numerator, one.denominator)));
    };
    return format_of(
        rate, "number or \"30000/1001\"",
        fmt::format(R"({{"oneOf": [{{"type": "number", "minimum": {}, "maximum": {}}}, {{"type": "string", )"
                    R"("pattern": "^(?!0+(\\.0*)?(/|$))[0-9]+(\\.[0-9]+|/[0-9]*[1-9][0-9]*)?$"}}]}})",
                    kSlowestFrameRate, kFastestFrameRate),
        read_frame_rate, write);
}

// ---- instants and speed ------------------------------------------------------------------------

namespace {

std::optional<Instant> parse_event(std::string_view text) {
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

std::optional<Instant> read_instant(ObjectReader& r, const Node& node, const std::string& key) {
    const std::string text = text_of(node);
    const auto begins = [&](const EventWord& event) { return text.starts_with(event.word); };
    if (text.starts_with("last") || std::ranges::any_of(kEventWords, begins)) {
        const auto event = parse_event(text);
        if (!event)
            r.reject_value(node, key, ": events are counted from 1: impact:1, collision:2, apex:1, release:3, touch");
        return event;
    }
    double t = 0;
    const bool fine = r.ranged_value(node, key, sim::dimension::kTime, kFromStart, t);
    return fine ? std::optional(Instant{.t = t}) : std::nullopt;
}

std::optional<Node> written(const Instant& at) {
    if (at.kind == Instant::Kind::time) return at.t;
    for (const EventWord& event : kEventWords)
        if (event.kind == at.kind) return fmt::format("{}:{}", event.word, at.number);
    return "last";
}

template <class Value>
ValueFormat format_of_instant(Value& at) {
    return format_of(at, "time, \"impact:N\", \"collision:N\", \"apex:N\", \"touch\", \"release\" or \"last\"",
                     R"({"$ref": "#/$defs/instant"})", read_instant, written);
}

template <class Time>  // double, or std::optional<double>
ValueFormat format_of_bound(Time& time, std::optional<Instant>& event) {
    static std::optional<Instant> none;
    ValueFormat out = format_of_instant(none);
    out.read = [&](ObjectReader& r, const Node& node, const std::string& key) {
        const auto at = read_instant(r, node, key);
        if (!at) return;
        event = at->is_event() ? at : std::nullopt;
        if (at->kind == Instant::Kind::time)
            time = at->t;
        else if constexpr (requires { time.reset(); })
            time.reset();
    };
    out.write = [&]() -> std::optional<Node> {
        const std::optional<double> t = time;
        return event ? written(*event) : t ? std::optional<Node>(*t) : std::nullopt;
    };
    return out;
}

}  // namespace

ValueFormat instant_format(Instant& at) { return format_of_instant(at); }
ValueFormat instant_format(std::optional<Instant>& at) { return format_of_instant(at); }
ValueFormat bound_format(double& time, std::optional<Instant>& event) { return format_of_bound(time, event); }
ValueFormat bound_format(std::optional<double>& time, std::optional<Instant>& event) {
    return format_of_bound(time, event);
}

ValueFormat speed_format(Speed& speed) {
    const auto read = [&speed](ObjectReader& r, const Node& node, const std::string& key) {
        if (text_of(node) == "impacts")
            speed.around = SlowMotion{}, speed.intervals.clear();
        else
            r.ranged_value(node, key, sim::dimension::kNone, kSpeedRange, speed.factor);
    };
    const auto write = [&speed]() -> std::optional<Node> {
        return speed.around || !speed.intervals.empty() ? std::nullopt : std::optional<Node>(speed.factor);
    };
    return {
        "factor, \"impacts\" or object",
        R"({"anyOf": [{"const": "impacts"}, {"type": "number", "minimum": 1e-06, "maximum": 1000}, {"$ref": "#/$defs/percentage"}]})",
        read, write};
}

// ---- places of the mechanism -------------------------------------------------------------------

namespace {

constexpr sim::Named<render::Anchor::Kind> kAnchors[] = {{render::Anchor::Kind::all, "all"},
                                                         {render::Anchor::Kind::tip, "tip"},
                                                         {render::Anchor::Kind::contact, "contact"},
                                                         {render::Anchor::Kind::cam, "cam"},
                                                         {render::Anchor::Kind::hub, "hub"}};

std::optional<render::Anchor> read_anchor(ObjectReader& r, const Node& node, const std::string& key) {
    if (node.kind == Node::Kind::array && node.items.size() == 2) {
        sim::Vec2 at;
        const bool fine = r.number_value(node.items[0], key + ".0", sim::dimension::kLength, at.x) &&
                          r.number_value(node.items[1], key + ".1", sim::dimension::kLength, at.y);
        return fine ? std::optional(render::Anchor{render::Anchor::Kind::place, at}) : std::nullopt;
    }
    std::vector<std::string> names;
    for (const auto& [kind, name] : kAnchors) {
        if (text_of(node) == name) return render::Anchor{kind, {}};
        names.emplace_back(name);
    }
    r.reject_value(node, key, " is neither a place [x, y] nor a part of the mechanism{}",
                   suggestion_or_list(node.text, names));
    return std::nullopt;
}

template <class Value>
ValueFormat format_of_anchor(Value& anchor) {
    const auto write = [](const render::Anchor& one) -> std::optional<Node> {
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

ValueFormat color_format(std::optional<std::uint32_t>& color) {
    const auto read = [](ObjectReader& r, const Node& node, const std::string& key) {
        const auto given = parse_color(text_of(node));
        if (!given) r.reject_value(node, key, " is not a colour; write for example \"#0072b2\"");
        return given;
    };
    return format_of(color, "\"#rrggbb\"", R"({"type": "string", "pattern": "^#[0-9a-fA-F]{6}$"})", read,
                     [](std::uint32_t one) { return std::optional(color_node(one)); });
}

ValueFormat background_format(render::View& view) {
    const auto read = [&view](ObjectReader& r, const Node& node, const std::string& key) {
        const std::string text = text_of(node);
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

ValueFormat show_format(render::Shown& show) {
    static const std::pair<std::string, render::Shown> kPresets[] = {
        {"all", {}},
        {"talk", {.parameters = false, .accuracy = false}},
        {"paper", {.title = false, .parameters = false, .accuracy = false}},
        {"clean", {false, false, false, false, false, false}}};
    static const std::vector<std::string> kNames{"all", "talk", "paper", "clean"};
    // Presets do not change the size of the text.
    const auto sized = [](render::Shown preset, double size) {
        preset.size = size;
        return preset;
    };
    const auto read = [&show, sized](ObjectReader& r, const Node& node, const std::string& key) {
        for (const auto& [name, preset] : kPresets)
            if (text_of(node) == name) return void(show = sized(preset, show.size));
        r.reject_value(node, key, " is not a preset{}", suggestion_or_list(node.text, kNames));
    };
    const auto write = [&show, sized]() -> std::optional<Node> {
        for (const auto& [name, preset] : kPresets)
            if (show == sized(preset, show.size)) return name;
        return std::nullopt;
    };
    return {"preset or object", one_line(object_node({{"enum", kNames}})), read, write};
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
    const auto write = [&channels]() -> std::optional<Node> {
        if (channels.empty()) return std::nullopt;
        return channel_names(channels);
    };
    return {"[channel, …]",
            R"({"type": "array", "minItems": 1, "uniqueItems": true, "items": {"$ref": "#/$defs/channel"}})", read,
            write};
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
    format.write = [] { return std::nullopt; };  // the key "panels" is written instead
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
            [&against] { return against; }};
}

}  // namespace beamcam::scenes
