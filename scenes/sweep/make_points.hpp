// Makes the points of a sweep, on several threads, into a store that survives the program.
#pragma once

#include <optional>
#include <vector>

#include "output/data/point_store.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/sweep/sweep_grid.hpp"
#include "sim/dynamics/initial.hpp"

namespace beamcam::scenes {

// The part of the tasks that this program makes: those whose number is `part` modulo `parts`.
struct SweepPart {
    std::uint64_t part = 0, parts = 1;
    bool has_task(std::uint64_t task) const { return task % parts == part; }
    bool whole() const { return parts == 1; }
};
std::vector<bool> points_of(const SweepGrid& grid, const SweepPart& part);  // by point

// Those that the store has not. The bits of a point depend on neither the threads nor the parts. Throws Interrupted,
// IoError.
void make_points(const SweepGrid& grid, const SweepPart& part, int threads, Progress& progress,
                 output::PointStore& store);

// The state at the end of the point's motion; nothing where that left the cam or failed, and where the point was read
// from a NetCDF file.
std::optional<sim::InitialState> end_of(const output::StoredPoint& point);

// What one point takes, by a few short motions; for plans.
struct SweepCost {
    double seconds = 0;  // of one thread, for all points
    double rows = 0;     // samples of all points
};
SweepCost cost_of(const SweepGrid& grid);

// What a sweep's files are made from.
output::SweepData data_of(const SweepGrid& grid, const output::PointStore& store, const SweepPart& part);

}  // namespace beamcam::scenes
