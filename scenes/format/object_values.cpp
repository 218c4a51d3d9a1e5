// The kinds of values that ObjectReader reads.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/format/absent.hpp"
#include "scenes/format/file_column.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

std::string as_written(const Node& node) {
    switch (node.kind) {
        case Node::Kind::null:
            return "null";
        case Node::Kind::boolean:
            return node.boolean ? "true" : "false";
        case Node::Kind::number:
            return shortened(node.text);
        case Node::Kind::string:
            return in_quotes(node.text);
        case Node::Kind::array:
            return node.items.empty() ? "an empty array" : "an array of " + counted(std::ssize(node.items), "value");
        case Node::Kind::object:
            return "an object";
    }
    return "?";
}

std::optional<double> ObjectReader::number_value(const Node& node, std::string_view key,
                                                 const sim::Dimension& dimension) {
    if (node.kind == Node::Kind::number) return node.number;
    const std::string unit = si_unit(dimension);
    if (node.kind != Node::Kind::string) {
        expect(node, key, "a number{}", unit == "1" ? "" : fmt::format(" [{}] or a text with a unit", unit));
        return std::nullopt;
    }
    const QuantityText read = parse_quantity(node.text, &dimension);
    if (!read.quantity)
        reject_value(node, key, ": {}{}", read.problem,
                     unit == "1"                   ? "; write a number"
                     : read.problem.ends_with('?') ? ""
                                                   : fmt::format("; write for example \"1.5 {}\"", unit));
    else if (same(read.quantity->dimension, dimension))
        return read.quantity->value;
    else
        fail(node, key, wrong_dimension(node, key, unit, read.quantity->dimension));
    return std::nullopt;
}

std::optional<double> ObjectReader::ranged_value(const Node& node, std::string_view key, const sim::Unit& unit,
                                                 const sim::Range& range) {
    const auto value = number_value(node, key, unit.resolved());
    if (!value || !check_ranges_ || range.contains(*value)) return value;
    reject_value(node, key, " {}",
                 range.message ? range.message : fmt::format("is outside {:g} … {:g}", range.min, range.max));
    return std::nullopt;
}

std::optional<int> ObjectReader::integer_value(const Node& node, std::string_view key, int min, int max) {
    if (node.kind != Node::Kind::number || node.number != std::round(node.number))
        expect(node, key, "a whole number");
    else if (node.number < min || node.number > max)
        reject_value(node, key, " is outside {} … {}", min, max);
    else
        return static_cast<int>(node.number);
    return std::nullopt;
}

std::optional<std::size_t> ObjectReader::keyword_value(const Node& node, std::string_view key,
                                                       const std::vector<std::string>& words) {
    if (node.kind != Node::Kind::string) {
        expect(node, key, "one of {}", fmt::join(words, ", "));
        return std::nullopt;
    }
    const auto found = std::ranges::find(words, node.text);
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    const std::string remedy = absent(fmt::format("{}={}", key.substr(key.rfind('.') + 1), node.text));
    reject_value(node, key, " is unknown{}", remedy.empty() ? suggestion_or_list(node.text, words) : remedy);
    return std::nullopt;
}

std::optional<std::vector<double>> ObjectReader::numbers_value(const Node& node, std::string_view key,
                                                               const sim::Dimension& dimension) {
    if (node.kind != Node::Kind::array) {
        expect(node, key, "an array [ … ]");
        return std::nullopt;
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < node.items.size(); ++i)
        if (const Node& item = node.items[i]; item.kind == Node::Kind::number)
            values.push_back(item.number);
        else if (const auto value = number_value(item, fmt::format("{}.{}", key, i), dimension))
            values.push_back(*value);
    return values.size() == node.items.size() ? std::optional(values) : std::nullopt;
}

std::optional<std::vector<double>> ObjectReader::column_value(const Node& node, std::string_view key,
                                                              const std::pair<std::string, std::string>& column,
                                                              const sim::Unit& unit, const sim::Range& range) {
    const std::filesystem::path folder =
        context_ ? std::filesystem::path(context_->source.name).parent_path() : std::filesystem::path();
    std::string own_unit;
    for (const auto& [name, stated] : columns_.value_or(ColumnsFile{}).units)
        if (name == column.second) own_unit = stated;
    FileColumn read = read_file_column(folder / column.first, column.second, unit.resolved(), own_unit);
    const bool joined = same(unit.resolved(), dimension::kAngle) && joined_turns(read.values);
    if (joined && !columns_)  // the angles of an outline go round once, and may begin anywhere
        warn(key,
             ": the column {} jumps by more than half a turn; it is read as an angle that begins again after 360 deg",
             in_quotes(column.second));
    const auto outside = std::ranges::find_if(read.values, [&](double value) { return !range.contains(value); });
    if (check_ranges_ && outside != read.values.end())
        read.problem =
            fmt::format("{:.10g} {}", *outside,
                        range.message ? range.message : fmt::format("is outside {:g} … {:g}", range.min, range.max));
    if (read.problem.empty()) return std::move(read.values);
    reject_value(node, key, ": {}", read.problem);
    return std::nullopt;
}

// The message about a quantity of the dimension `given` in place of `unit`.
std::string ObjectReader::wrong_dimension(const Node& node, std::string_view key, const std::string& unit,
                                          const sim::Dimension& given) const {
    if (same(given, dimension::kNone)) {
        return unit == "1" ? fmt::format("{} = {} must be a number without quotes", path(key), in_quotes(node.text))
                           : fmt::format("{} = {} has no unit; add one, or remove the quotes if the value is in {}",
                                         path(key), in_quotes(node.text), unit);
    }
    if (unit == "1")
        return fmt::format("{} = {} has a unit, but the key has none; write a number", path(key), in_quotes(node.text));
    const char* remedy = unit == "rad/s" && same(given, dimension::kFrequency) ? ": write rpm, rad/s or deg/s"
                         : unit == "rad" && same(given, dimension::kLength) ? ": divide by the distance from the pivot"
                                                                            : "";
    return fmt::format("{} = {} has the wrong dimension ({}); it is measured in {}{}", path(key), in_quotes(node.text),
                       si_unit(given), unit, remedy);
}

}  // namespace beamcam::scenes
