// The numbers of an output that is no picture and no table of the motion, such as a summary: the file that the output
// writes, kept among the references and compared number by number.
#pragma once

#include <filesystem>
#include <optional>

#include "scenes/regression/motion_record.hpp"

namespace beamcam::scenes {

// `expected` and `actual` are files that end in .csv, with a column "t" if rows depend on time, or in .json. Numbers of
// tables may differ by the tolerance `motion`, those of JSON by `impacts`. After `horizon`, where the motion is not
// reproducible, rows and impacts are not compared. What tells of the work of the solver, such as its steps and its
// errors, is not compared. Throws IoError if `expected` is damaged.
MotionVerdict compare_numbers(const std::filesystem::path& expected, const std::filesystem::path& actual,
                              const Tolerance& tolerance, std::optional<double> horizon);

}  // namespace beamcam::scenes
