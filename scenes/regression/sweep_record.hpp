// The sweep behind a baseline: the samples of all its points as `beamcam sweep -o FILE.npz` writes them, compared point
// by point. What settles is compared in numbers, what does not in statistics.
#pragma once

#include "output/data/table_reader.hpp"
#include "scenes/regression/motion_record.hpp"

namespace beamcam::scenes {

inline constexpr const char* kSweepRecord = "sweep.npz";

// Points of rest, followed cams and periods: each sample has one of the other sweep that is as near as the tolerance of
// motions says, as a share of the column's range in the sweep, wherever in its period either begins.
//
// Points without period: the number of samples, and the mean and the variance of each column, over ten equal blocks of
// the time; the means over the blocks differ by no more than kSureErrors of their combined standard errors, nor does
// the largest exponent. The method of batch means, which holds for samples that depend on each other:
// Law & Kelton, Simulation Modeling and Analysis, 1991, 9.5.3.
//
// Points that go over the top are judged by their class alone, those that were unsettled not at all. Half as many
// points as these may change their class: where some lie on a border, others do.
MotionVerdict compare_sweeps(const output::NamedTable& expected, const output::NamedTable& actual,
                             const Tolerance& tolerance);

// The points, by their numbers, that are not judged alike; of two sweeps over the same values.
std::vector<std::size_t> points_that_differ(const output::NamedTable& expected, const output::NamedTable& actual,
                                            const Tolerance& tolerance);

}  // namespace beamcam::scenes
