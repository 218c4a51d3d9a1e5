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
    const std::size_t colon = text.rfind(':');
    if (!text.starts_with('@') || colon == text.npos || colon < 2 || colon + 1 == text.size()) return std::nullopt;
    return std::pair(std::string(text.substr(1, colon - 1)), std::string(text.substr(colon + 1)));
}

FileColumn read_file_column(const std::filesystem::path& file, const std::string& column,
                            const sim::Dimension& dimension, const std::string& unit) {
    FileColumn out;
    try {
        const output::ColumnTable table =
            output::read_columns(file, [&column](const std::string& name) { return name == column; });
        const std::vector<double>* found = table.find(column);
        if (!found)
            return {{},
                    fmt::format("{} has no column {}{}", file.string(), in_quotes(column),
                                suggestion_or_list(column, table.names()))};
        out.values = *found;
        const auto empty = std::ranges::find_if(out.values, [](double value) { return std::isnan(value); });
        if (empty != out.values.end())
            return {
                {},
                fmt::format("{}, {}: the cell of the column {} is empty", file.string(),
                            table.row_name(static_cast<std::size_t>(empty - out.values.begin())), in_quotes(column))};
        const std::string& stated = unit.empty() ? table.column(column)->unit : unit;
        if (const auto factor = stated.empty() ? std::nullopt : factor_between(stated, si_unit(dimension)))
            for (double& value : out.values) value *= *factor;
        else if (!unit.empty())
            out.problem = fmt::format("{} is not a unit of the column {}, which is measured in {}", in_quotes(unit),
                                      in_quotes(column), si_unit(dimension));
    } catch (const output::IoError& error) {
        return {{}, error.what()};
    }
    if (out.values.empty()) out.problem = fmt::format("the column {} of {} is empty", in_quotes(column), file.string());
    return out;
}

}  // namespace beamcam::scenes
