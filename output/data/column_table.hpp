// A table of numbers whose columns have a unit and a meaning.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace beamcam::output {

struct TableColumn {
    std::string name, unit, meaning;
    std::vector<double> values = {};  // of equal length in all columns; NaN: no value
};

struct ColumnTable {
    std::vector<TableColumn> columns;
    std::vector<std::pair<std::string, std::string>> attributes = {};  // of a NetCDF file

    std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
};

}  // namespace beamcam::output
