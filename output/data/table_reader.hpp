// Tables of numbers from files: CSV with a header line, and NPZ with one array a column, of beamcam, numpy or others.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "output/files/errors.hpp"

namespace beamcam::output {

struct NamedTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;  // as many as names, all of one length; NaN: an empty cell
    std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
    const std::vector<double>* find(std::string_view name) const;
};

// Classes of motion, which tables of sweeps give by name in .csv, are numbered as in .npz. By the name's ending, .csv
// or .npz. Throws IoError with the line and column of what is wrong (CSV), or the name of the array (NPZ).
NamedTable read_table(const std::filesystem::path& file);

// Texts of numbers.cpp's kind, of spreadsheets (a byte order mark, "\r\n") and of numpy.savetxt with a header.
NamedTable parse_csv(std::string_view text, const std::string& file_name);
NamedTable parse_npz(std::string_view bytes, const std::string& file_name);

}  // namespace beamcam::output
