// Computes the points of a sweep on several threads and stores them in a file that survives an interruption.
#pragma once

#include <optional>
#include <vector>

#include "output/data/point_store.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/sweep/sweep_grid.hpp"
#include "sim/dynamics/initial.hpp"

namespace beamcam::scenes {

// True for the points of a part: its tasks are those whose number, modulo the number of parts, is its own.
std::vector<bool> points_of(const SweepGrid& grid, const Shard& shard);

// Computes the points that the store lacks. The bits of a point are independent of threads and parts. Throws
// Interrupted, IoError.
void make_points(const SweepGrid& grid, const Shard& shard, int threads, Progress& progress, output::PointStore& store);

// The end state of the point's motion; nullopt if the beam went over the top, the motion failed, or the numbers are no
// state of a beam.
std::optional<sim::InitialState> end_of(const output::StoredPoint& point);

// The part that all points of a sweep share.
output::PointShape shape_of(const SweepGrid& grid);

// The head of a file with the points of a part; its description is JSON: "part" ("2/3"), "program", "sweep" (the digest
// of the grid) and "scene", whose text is that of a scene.
output::PointHead head_of(const SweepGrid& grid, const Shard& shard);

// The content of a sweep's files, without its points; and with those of a store.
output::SweepData data_of(const SweepGrid& grid, const Shard& shard);
output::SweepData data_of(const SweepGrid& grid, const output::PointStore& store, const Shard& shard);

}  // namespace beamcam::scenes
