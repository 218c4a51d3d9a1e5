// Tables of numbers: reading of CSV with a header line, and of NPZ with an array for each column, from beamcam, numpy
// or other programs; writing of CSV for people and spreadsheets, NPZ for numpy, NetCDF-4 with units and meanings.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/files/errors.hpp"
#include "output/files/target.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::output {

struct NamedTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;  // one for each name, of equal length; NaN: an empty cell
    std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
    const std::vector<double>* find(std::string_view name) const;
};

// A table whose columns have a unit and a meaning.
struct TableColumn {
    std::string name, unit, meaning;
    std::vector<double> values = {};  // of equal length in all columns; NaN: no value
};
struct ColumnTable {
    std::vector<TableColumn> columns;
    std::vector<std::pair<std::string, std::string>> attributes = {};  // of a NetCDF file

    std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
};

// ---- reading -------------------------------------------------------------------------------------

// The ending decides: .csv or .npz. The names of classes of motion in the .csv tables of sweeps become numbers as in
// .npz. Throws IoError with the line and column of the error (CSV), or the name of the array (NPZ).
NamedTable read_table(const std::filesystem::path& file);

// Also CSV of spreadsheets (byte order mark, "\r\n") and of numpy.savetxt with a header.
NamedTable parse_csv(std::string_view text, const std::string& file_name);
NamedTable parse_npz(std::string_view bytes, const std::string& file_name);

// ---- writing -------------------------------------------------------------------------------------

// One header line, commas, 17 significant digits, "\n"; an undefined value is an empty cell. Throws IoError.
void write_csv(std::ostream& out, const sim::Table& table);
// Passes pieces of CSV text on to a stream. Throws IoError if it fails.
std::function<void(const std::string&)> to_stream(std::ostream& out);

// The ending decides: .csv or .npz; numpy.load(file)["theta"] gives one array of float64 per channel, NaN where
// undefined. Throws UnsupportedOption for other endings, and for .npz above 4 GiB.
void write_table(const Target& file, const sim::Table& table);
void write_table(const Target& file, const NamedTable& table);

// The ending decides: .csv, .npz or .nc. Throws UnsupportedOption for others, IoError.
void write_table(const Target& file, const ColumnTable& table);

}  // namespace beamcam::output
