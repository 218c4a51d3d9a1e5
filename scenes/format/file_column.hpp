// A column of a .csv or .npz file in place of a list of numbers: "@rig.csv:angle".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/problem/dimension.hpp"

namespace beamcam::scenes {

// The file and the column; nothing if the text does not begin with @ or has no colon.
std::optional<std::pair<std::string, std::string>> file_column_in(std::string_view text);

// The numbers of a column, none of them empty, or the reason why there are none.
struct FileColumn {
    std::vector<double> values;
    std::string problem;
};
// The values are in SI units if `unit`, or else the file, states a unit of this dimension.
FileColumn read_file_column(const std::filesystem::path& file, const std::string& column,
                            const sim::Dimension& dimension, const std::string& unit);

}  // namespace beamcam::scenes
