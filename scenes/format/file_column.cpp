#include "scenes/format/file_column.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/data/table_reader.hpp"
#include "output/json/source.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/units.hpp"

namespace beamcam::scenes {

std::optional<std::pair<std::string, std::string>> file_column_in(std::string_view text) {
    if (!text.starts_with('@')) return std::nullopt;
    const std::size_t colon = text.rfind(':');
    return std::pair(std::string(text.substr(1, colon - 1)),
                     std::string(colon == text.npos ? "" : text.substr(colon + 1)));
}

FileColumn column_in_si(const output::ColumnTable& table, const std::string& file, const std::string& column,
                        const std::string& unit, const std::string& si) {
    FileColumn out;
    try {
        if (const std::vector<double>* found = table.find(column)) out.values = *found;
    } catch (const output::IoError& error) {
        return {.problem = error.what()};
    }
    const output::TableColumn* found = table.column(column);
    if (!found)
        return {.problem = fmt::format("{} has no column {}{}", file, in_quotes(column),
                                       suggestion_or_list(column, table.names()))};
    const std::string& stated = unit.empty() ? found->unit : unit;
    const auto factor = stated.empty() ? std::optional(1.0) : factor_between(stated, si);
    for (double& value : out.values) value *= factor.value_or(1);
    out.wrong_unit = !factor;
    if (!factor && !unit.empty())
        out.problem = fmt::format("{} is not a unit of the column {}, which is measured in {}", in_quotes(unit),
                                  in_quotes(column), si);
    return out;
}

FileColumn read_file_column(const std::filesystem::path& file, const std::string& column,
                            const sim::Dimension& dimension, const std::string& unit) {
    try {
        const output::ColumnTable table =
            output::read_columns(file, [&column](const std::string& name) { return name == column; });
        FileColumn out = column_in_si(table, file.string(), column, unit, si_unit(dimension));
        if (!out.problem.empty()) return out;
        const auto empty = std::ranges::find_if(out.values, [](double value) { return std::isnan(value); });
        if (empty != out.values.end())
            return {.problem = fmt::format("{}, {}: the cell of the column {} is empty", file.string(),
                                           table.row_name(static_cast<std::size_t>(empty - out.values.begin())),
                                           in_quotes(column))};
        if (out.values.empty())
            out.problem = fmt::format("the column {} of {} is empty", in_quotes(column), file.string());
        return out;
    } catch (const output::IoError& error) {
        return {.problem = error.what()};
    }
}

std::optional<AngleJump> joined_turns(std::vector<double>& angles) {
    constexpr double kRounding = 1e-3;  // of a turn: encoders print few digits
    std::optional<AngleJump> first;
    std::vector<double> joined = angles;
    double least = INFINITY, most = -INFINITY, before = NAN, turns = 0;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (!std::isfinite(angles[i])) continue;
        least = std::min(least, angles[i]), most = std::max(most, angles[i]);
        const double jump = std::isfinite(before) ? angles[i] - before : 0;
        if (!first && std::abs(jump) > 0.5 * kFullTurn) first = {i, jump};
        turns -= std::round(jump / kFullTurn);
        joined[i] += turns * kFullTurn;
        before = angles[i];
    }
    if (most - least > (1 + kRounding) * kFullTurn) first.reset();
    if (first) angles = std::move(joined);
    return first;
}

}  // namespace beamcam::scenes
