// The record of an entry's sweep: the samples of all its points as `beamcam sweep -o FILE.csv` writes them. It is
// compared point by point.
#pragma once

#include "output/data/tables.hpp"
#include "scenes/regression/motion_record.hpp"

namespace beamcam::scenes {

inline constexpr const char* kSweepRecord = "sweep.csv";

// Points must have the same class, where all motions without period are one; those at rest, following the cam, or
// periodic also the same period and impacts, and each sample of their orbit must have a sample of the other sweep
// within the tolerance `motion`, a share of the largest value of the column in the sweep, wherever in its period either
// begins. Of points at rest only the angle is compared: their rates are errors of the solver. Unsettled points are not
// compared.
MotionVerdict compare_sweeps(const output::ColumnTable& expected, const output::ColumnTable& actual,
                             const Tolerance& tolerance);

}  // namespace beamcam::scenes
