#include "scenes/format/value_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "output/files/numbers.hpp"
#include "output/film/video.hpp"
#include "output/image/raster.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/file_column.hpp"
#include "scenes/format/object_reader.hpp"

namespace beamcam::scenes {
namespace {

using output::kLargestSide, output::kSmallestSide, output::number_in;

// ---- size and frame rate -----------------------------------------------------------------------

std::optional<Size> parse_size(std::string_view text) {
    const std::size_t x = text.find('x');
    if (x == std::string_view::npos) return std::nullopt;
    const auto width = number_in<int>(text.substr(0, x)), height = number_in<int>(text.substr(x + 1));
    const bool fits =
        width && height && std::min(*width, *height) >= kSmallestSide && std::max(*width, *height) <= kLargestSide;
    return fits ? std::optional(Size{*width, *height}) : std::nullopt;
}

std::optional<Size> read_size(ObjectReader& r, const Node& node, const std::string& key) {
    if (const auto parsed = parse_size(word_in(node))) return parsed;
    if (node.kind != Node::Kind::array || node.items.size() != 2) {
        r.expect(node, key, "[width, height] or \"WIDTHxHEIGHT\" in pixels, {} to {} each", kSmallestSide,
                 kLargestSide);
        return std::nullopt;
    }
    const auto width = r.integer_value(node.items[0], key + ".0", kSmallestSide, kLargestSide),
               height = r.integer_value(node.items[1], key + ".1", kSmallestSide, kLargestSide);
    return width && height ? std::optional(Size{*width, *height}) : std::nullopt;
}

std::optional<FrameRate> parse_frame_rate(std::string_view text) {
    FrameRate rate;
    if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
        const auto over = number_in<int>(text.substr(0, slash)), under = number_in<int>(text.substr(slash + 1));
        if (!over || !under) return std::nullopt;
        rate = {*over, *under};
    } else {
        const auto value = number_in<double>(text);
        if (!value || !(*value >= output::kSlowestRate && *value <= output::kFastestRate)) return std::nullopt;
        rate = output::frame_rate(*value);  // 29.97 means 30000/1001
    }
    if (rate.numerator <= 0 || rate.denominator <= 0 || rate.value() < output::kSlowestRate ||
        rate.value() > output::kFastestRate)
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
                       output::kSlowestRate, output::kFastestRate);
    return rate;
}

}  // namespace

// ---- quantities --------------------------------------------------------------------------------

static constexpr const char* kQuantitySchema = R"({"anyOf": [{"type": "number"}, {"type": "string"}]})";

template <class Number>  // double, or optional<double>
static ValueFormat format_of_quantity(Number& value, DimensionOf dimension) {
    const auto read = [&value, dimension = std::move(dimension)](ObjectReader& r, const Node& node,
                                                                 const std::string& key) {
        const auto expected = dimension(r);
        if (const auto given = expected ? r.number_value(node, key, *expected) : std::nullopt) value = *given;
    };
    return {"number, or text with a unit", kQuantitySchema, read, [&value] { return Node(value); }};
}
ValueFormat quantity_format(double& value, DimensionOf dimension) {
    return format_of_quantity(value, std::move(dimension));
}
ValueFormat quantity_format(std::optional<double>& value, DimensionOf dimension) {
    return format_of_quantity(value, std::move(dimension));
}

ValueFormat quantities_format(std::vector<double>& values, DimensionOf dimension, int fewest) {
    const auto read = [&values, dimension = std::move(dimension), fewest](ObjectReader& r, const Node& node,
                                                                          const std::string& key) {
        const auto column = file_column_in(word_in(node));
        if (!column && (node.kind != Node::Kind::array || std::ssize(node.items) < fewest))
            return r.expect(node, key, "a list of numbers, or \"@FILE.csv:COLUMN\"");
        const auto expected = dimension(r);
        const auto given = !expected ? std::nullopt
                           : column  ? r.column_value(node, key, *column, *expected, sim::kAny)
                                     : r.numbers_value(node, key, *expected);
        if (given) values = *given;
    };
    return {
        "numbers, or texts with a unit; or @FILE.csv:COLUMN",
        fmt::format(R"({{"anyOf": [{{"type": "array", {}"items": {}}}, {{"type": "string", "pattern": "^@.+:.+$"}}]}})",
                    fewest > 0 ? fmt::format("\"minItems\": {}, ", fewest) : "", kQuantitySchema),
        read, [&values] { return values.empty() ? Node() : Node(values); }};
}

ValueFormat unit_format(AxisUnit& unit, DimensionOf dimension) {
    const auto read = [&unit, dimension = std::move(dimension)](ObjectReader& r, const Node& node,
                                                                const std::string& key) {
        const auto expected = dimension(r);
        if (!expected) return;
        const QuantityText one = parse_quantity("1 " + word_in(node), &*expected);
        const std::string si = si_unit(*expected);
        if (!one.quantity || !same(one.quantity->dimension, *expected))
            return r.reject_value(node, key, " is not a unit of this axis, which shows {}{}",
                                  si == "1" ? "plain numbers" : si, one.quantity ? "" : ": " + one.problem);
        unit = {node.text, one.quantity->value};
    };
    return {"unit, such as \"kN\"", R"({"type": "string"})", read,
            [&unit] { return unit.name.empty() ? Node() : Node(unit.name); }};
}

ValueFormat texts_format(std::vector<std::string>& texts) {
    const auto read = [&texts](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::array) return r.expect(node, key, "{}", "an array of strings");
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            const Node& each = node.items[i];
            if (each.kind == Node::Kind::string)
                texts.push_back(each.text);
            else
                r.expect(each, fmt::format("{}.{}", key, i), "{}", "a string");
        }
    };
    return {"list of texts", R"({"type": "array", "items": {"type": "string"}})", read,
            [&texts] { return Node(texts); }};
}

ValueFormat size_format(Size& size) {
    const auto write = [](const Size& one) { return array_node({one.width, one.height}); };
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
        return one.denominator == 1 ? Node(one.numerator) : Node(fmt::format("{}/{}", one.numerator, one.denominator));
    };
    return format_of(
        rate, "number or \"30000/1001\"",
        fmt::format(R"({{"oneOf": [{{"type": "number", "minimum": {}, "maximum": {}}}, {{"type": "string", )"
                    R"("pattern": "^(?!0+(\\.0*)?(/|$))[0-9]+(\\.[0-9]+|/[0-9]*[1-9][0-9]*)?$"}}]}})",
                    output::kSlowestRate, output::kFastestRate),
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
    const std::string text = word_in(node);
    const auto begins = [&](const EventWord& event) { return text.starts_with(event.word); };
    if (text.starts_with("last") || text.find(':') != text.npos || std::ranges::any_of(kEventWords, begins)) {
        const auto event = parse_event(text);
        if (!event)
            r.reject_value(node, key, " is no event; they are counted from 1, for example peak:1: {}",
                           event_notations());
        return event;
    }
    const auto t = r.ranged_value(node, key, sim::dimension::kTime, kFromStart);
    if (!t) return std::nullopt;
    if (*t > kLatestEnd) {
        r.reject(key, " = {:g} s is later than {:g} s; write the number of seconds", *t, kLatestEnd);
        return std::nullopt;
    }
    return Instant{.t = *t};
}

Node written(const Instant& at) {
    if (at.kind == Instant::Kind::time) return at.t;
    for (const EventWord& event : kEventWords)
        if (event.kind == at.kind) return fmt::format("{}:{}", event.word, at.number);
    return "last";
}

template <class Value>
ValueFormat format_of_instant(Value& at) {
    static const std::string type = fmt::format("time, \"last\", or an event: {}", event_notations());
    return format_of(at, type.c_str(), R"({"$ref": "#/$defs/instant"})", read_instant, written);
}

template <class Time>  // double, or std::optional<double>
ValueFormat format_of_bound(Time& time, std::optional<Instant>& event, bool* last = nullptr) {
    static std::optional<Instant> none;
    ValueFormat out = format_of_instant(none);
    out.read = [&time, &event, last](ObjectReader& r, const Node& node, const std::string& key) {
        const auto at = read_instant(r, node, key);
        if (!at) return;
        if (last) *last = at->kind == Instant::Kind::last;
        event = at->is_event() ? at : std::nullopt;
        if (at->kind == Instant::Kind::time)
            time = at->t;
        else if constexpr (requires { time.reset(); })
            time.reset();
        else if (at->kind == Instant::Kind::last)
            time = r.context().scene.end_time;
    };
    out.write = [&time, &event, last] { return event ? written(*event) : last && *last ? Node("last") : Node(time); };
    return out;
}

}  // namespace

ValueFormat instant_format(Instant& at) { return format_of_instant(at); }
ValueFormat instant_format(std::optional<Instant>& at) { return format_of_instant(at); }
ValueFormat bound_format(double& time, std::optional<Instant>& event) { return format_of_bound(time, event); }
ValueFormat bound_format(std::optional<double>& time, std::optional<Instant>& event, bool* last) {
    return format_of_bound(time, event, last);
}

ValueFormat speed_format(Speed& speed) {
    const auto read = [&speed](ObjectReader& r, const Node& node, const std::string& key) {
        if (word_in(node) == "impacts")
            speed.around = SlowMotion{}, speed.intervals.clear();
        else if (const auto factor = r.ranged_value(node, key, sim::dimension::kNone, kSpeedRange))
            speed.factor = *factor;
    };
    const auto write = [&speed] { return speed.around || !speed.intervals.empty() ? Node() : Node(speed.factor); };
    return {
        "factor, \"impacts\" or object",
        R"({"anyOf": [{"const": "impacts"}, {"type": "number", "minimum": 1e-06, "maximum": 1000}, {"$ref": "#/$defs/percentage"}]})",
        read, write};
}

}  // namespace beamcam::scenes
