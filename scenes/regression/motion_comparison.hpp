// The record of a motion, a table and its impacts, and its comparison with the one among the references.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/data/tables.hpp"
#include "output/json/tree.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/regression/tolerance.hpp"

namespace beamcam::scenes {

struct MotionRecord {
    output::ColumnTable table = {};                 // with a column "t"
    Node impacts = {};                              // as output::impacts_json writes them
    std::optional<double> reproducible_until = {};  // [s]; absent: to the end
};

struct MotionVerdict {
    Verdict verdict = Verdict::identical;
    std::vector<std::string> lines;  // the differences, the largest first; empty if identical
};

// Numbers of the table may differ by the tolerance `motion`, those of the impacts by `impacts`. Rows and impacts after
// the reproducible time of the expected motion are not comparable, and any difference of these is equivalent.
MotionVerdict compare(const MotionRecord& expected, const MotionRecord& actual, const Tolerance& tolerance);

}  // namespace beamcam::scenes
