// A column of a .csv or .npz file in place of a list of numbers: "@rig.csv:angle".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/data/tables.hpp"
#include "sim/cam/motion_law.hpp"
#include "sim/problem/dimension.hpp"

namespace beamcam::scenes {

// The file and the column, which is empty if the text has no colon; nothing if the text does not begin with @.
std::optional<std::pair<std::string, std::string>> file_column_in(std::string_view text);

// The numbers of a column, or the reason why there are none. They are in SI units if `unit`, or else the file, states a
// unit that fits to `si`.
struct FileColumn {
    std::vector<double> values = {};
    std::string problem = {};
    bool wrong_unit = false;  // `unit` is the problem; without a problem that of the file, which is ignored
};
// `file`: its name in messages.
FileColumn column_in_si(const output::ColumnTable& table, const std::string& file, const std::string& column,
                        const std::string& unit, const std::string& si);
// None of the numbers is empty.
FileColumn read_file_column(const std::filesystem::path& file, const std::string& column,
                            const sim::Dimension& dimension, const std::string& unit);

// ---- angles that begin again after a turn, as those of absolute encoders

using sim::kFullTurn;

struct AngleJump {
    std::size_t row = 0;
    double angle = 0;  // from the row before [rad]
};
// Adds whole turns so that no row is farther than half a turn from the row before, unless the values span more than a
// turn and so do not wrap. Returns the first jump; nothing: there is none. NaN: no value.
std::optional<AngleJump> joined_turns(std::vector<double>& angles);

}  // namespace beamcam::scenes
