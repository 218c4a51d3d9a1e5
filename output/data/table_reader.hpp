// Reading of tables of numbers: CSV with a header line, and NPZ with an array for each column, from beamcam, numpy or
// other programs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "output/files/errors.hpp"

namespace beamcam::output {

struct NamedTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;  // one for each name, of equal length; NaN: an empty cell
    std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
    const std::vector<double>* find(std::string_view name) const;
};

// The ending decides: .csv or .npz. The names of classes of motion in the .csv tables of sweeps become numbers as in
// .npz. Throws IoError with the line and column of the error (CSV), or the name of the array (NPZ).
NamedTable read_table(const std::filesystem::path& file);

// Also CSV of spreadsheets (byte order mark, "\r\n") and of numpy.savetxt with a header.
NamedTable parse_csv(std::string_view text, const std::string& file_name);
NamedTable parse_npz(std::string_view bytes, const std::string& file_name);

}  // namespace beamcam::output
