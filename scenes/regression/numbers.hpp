// The numbers of an entry, and their comparison with those among the references: a table, column by column, and JSON,
// number by number.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/data/tables.hpp"
#include "output/json/tree.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/regression/tolerance.hpp"

namespace beamcam::scenes {

struct Numbers {
    output::ColumnTable table = {};                 // with a column "t" if rows depend on time; may be empty
    Node json = {};                                 // null: there is only a table
    std::optional<double> reproducible_until = {};  // [s], of the motion behind them; absent: to the end
};

struct MotionVerdict {
    Verdict verdict = Verdict::identical;
    std::vector<std::string> lines;  // the differences, the largest first; empty if identical
};

// Numbers of the table may differ by the tolerance `motion`, those of the JSON by `impacts`. Rows, impacts and
// collisions after the reproducible time of the expected numbers are not comparable, and any difference of these is
// equivalent. Members about the work of the solver, such as its steps and its errors, are not compared.
MotionVerdict compare(const Numbers& expected, const Numbers& actual, const Tolerance& tolerance);

}  // namespace beamcam::scenes
