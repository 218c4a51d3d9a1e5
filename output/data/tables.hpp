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

struct TableColumn {
    std::string name, unit = {}, meaning = {};  // unit and meaning may be unknown
    std::vector<double> values = {};            // of equal length in all columns; NaN: no value, or a text
    std::vector<std::string> texts = {};        // by row, up to the last text; empty where there is none
    std::string_view text(std::size_t row) const { return row < texts.size() ? texts[row] : std::string_view(); }
};
struct ColumnTable {
    std::vector<TableColumn> columns;
    std::vector<std::pair<std::string, std::string>> attributes = {};  // of a NetCDF file

    std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
    std::vector<std::string> names() const;
    const std::vector<double>* find(std::string_view name) const;
};

// ---- reading -------------------------------------------------------------------------------------

enum class Texts { rejected, kept };  // cells of .csv files that are not numbers

// The ending decides: .csv, .npz or .nc (a table or sweep of beamcam). A sweep gives the same rows from each; the names
// of its classes of motion in .csv become numbers as in .npz. Throws IoError with the line and column of the error
// (CSV), or the name of the array (NPZ); render::MissingPart without the NetCDF library.
ColumnTable read_table(const std::filesystem::path& file, Texts texts = Texts::rejected);

// Also CSV of spreadsheets (byte order mark, "\r\n") and of numpy.savetxt with a header.
ColumnTable parse_csv(std::string_view text, const std::string& file_name, Texts texts = Texts::rejected);
ColumnTable parse_npz(std::string_view bytes, const std::string& file_name);

// ---- writing -------------------------------------------------------------------------------------

// One header line, commas, 17 significant digits, "\n"; an undefined value is an empty cell. Throws IoError.
void write_csv(std::ostream& out, const sim::Table& table);
// Passes pieces of CSV text on to a stream. Throws IoError if it fails.
std::function<void(const std::string&)> to_stream(std::ostream& out);

// The ending decides: .csv or .npz; numpy.load(file)["theta"] gives one array of float64 per channel, NaN where
// undefined. Throws UnsupportedOption for other endings, and for .npz above 4 GiB.
void write_table(const Target& file, const sim::Table& table);

// The ending decides: .csv, .npz or .nc. Throws UnsupportedOption for others, IoError.
void write_table(const Target& file, const ColumnTable& table);

}  // namespace beamcam::output
