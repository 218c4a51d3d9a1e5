// The record of an entry's sweep: the samples of all its points as `beamcam sweep -o FILE.npz` writes them. It is
// compared point by point: settled motions by their numbers, others by their statistics.
#pragma once

#include "output/data/tables.hpp"
#include "scenes/regression/motion_record.hpp"

namespace beamcam::scenes {

inline constexpr const char* kSweepRecord = "sweep.npz";

// Points at rest, following the cam, or periodic: each sample must have a sample of the other sweep within the
// tolerance of motions, a share of the column's range in the sweep, wherever in its period either begins. A range
// counts as at least one hundredth of the column's natural size in `problem` (1 rad, the length of the beam, the rates
// of the cam and of a pendulum): what settled motions differ by may be no more than errors of the solver.
//
// Points without period: the number of samples, and the mean and the variance of each column, are estimated in ten
// equal blocks of the time. They and the largest exponent must agree within kSureErrors of their combined standard
// errors. This is the method of batch means, which is valid for correlated samples: Law & Kelton, Simulation Modeling
// and Analysis, 1991, 9.5.3.
//
// Points that go over the top are compared by their class only, unsettled points not at all. Up to half as many points
// may change their class: where some points lie on a border between classes, others do.
MotionVerdict compare_sweeps(const output::ColumnTable& expected, const output::ColumnTable& actual,
                             const Tolerance& tolerance, const sim::Problem& problem);

// The numbers of the points that differ; of two sweeps over the same values.
std::vector<std::size_t> points_that_differ(const output::ColumnTable& expected, const output::ColumnTable& actual,
                                            const Tolerance& tolerance, const sim::Problem& problem);

}  // namespace beamcam::scenes
