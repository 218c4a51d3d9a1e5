// Tables of numbers, and their writing: CSV for people and spreadsheets, NPZ for numpy. table_reader.hpp reads them.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/files/errors.hpp"
#include "output/files/target.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::output {

struct TableColumn {
    std::string name, unit = {}, meaning = {};  // unit and meaning may be unknown
    std::vector<double> values = {};            // of equal length in all columns; NaN: no value, or a text
    std::vector<std::string> texts = {};        // by row, up to the last text; empty where there is none
    std::string problem = {};                   // why it is no column of numbers, with the place; empty: it is one
    std::string_view text(std::size_t row) const { return row < texts.size() ? texts[row] : std::string_view(); }
};
struct ColumnTable {
    std::vector<TableColumn> columns;
    std::vector<std::size_t> lines = {};  // of the rows in a CSV file that was read

    std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
    std::vector<std::string> names() const;
    // nullptr: there is none. "X" is also the only column "X [mm]".
    const TableColumn* column(std::string_view name) const;
    // The numbers of a column, nullptr if there is none. Throws IoError if it has a `problem`.
    const std::vector<double>* find(std::string_view name) const;
    std::string row_name(std::size_t row) const;  // "line 17" of CSV, else "row 15"
};

// ---- writing -------------------------------------------------------------------------------------

// Receives the pieces of a text, such as print_data.
using TextSink = std::function<void(const std::string&)>;
// One header line, commas, 17 significant digits, "\n"; an undefined value is an empty cell.
void write_csv(const TextSink& write, const sim::Table& table);

// The ending decides: .csv or .npz; numpy.load(file)["theta"] gives one array of float64 per channel, NaN where
// undefined. Throws UnsupportedOption for other endings, and for .npz above 4 GiB; IoError.
void write_table(const FileTarget& file, const sim::Table& table);
void write_table(const FileTarget& file, const ColumnTable& table);

}  // namespace beamcam::output
