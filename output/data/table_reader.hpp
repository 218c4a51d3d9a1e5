// Reading of tables: CSV as machines, spreadsheets, numpy and beamcam write it, and NPZ with an array for each column.
// A column that nobody asks for does not matter: it may hold texts, or be an array of another length or shape.
//
// CSV. The separator (comma, semicolon, tab, spaces), the decimal sign and the encoding (UTF-8, UTF-16, Windows-1252)
// are recognized. Lines before the names are skipped if they begin with # or % or have fewer cells than the rows; the
// names may stand in the last of such comments, as numpy writes them. A line of units may follow the names. Blank lines
// are skipped. Empty cells, NA, N/A, NaN, NULL, None, - and ? hold no value.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "output/data/tables.hpp"

namespace beamcam::output {

// The columns of a measured file that a caller asks for. `wanted` chooses them by name: other arrays of an NPZ file are
// not expanded. The ending decides, in capitals, too: .npz, or .csv, .tsv, .txt and .dat. Throws IoError, with line and
// column for CSV; a wrong cell or array is reported by ColumnTable::find alone. A pipe or device is rejected unread.
ColumnTable read_columns(const std::filesystem::path& file, const std::function<bool(const std::string&)>& wanted);

// The whole table. Throws IoError also for an array that is no column of numbers, or of another length than the first.
ColumnTable read_table(const std::filesystem::path& file);

ColumnTable parse_csv(std::string_view bytes, const std::string& file_name);
ColumnTable parse_npz(std::string_view bytes, const std::string& file_name,
                      const std::function<bool(const std::string&)>& wanted);

}  // namespace beamcam::output
