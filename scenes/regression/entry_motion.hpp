// Judges the motion of one entry, the motions that its picture compares, or its sweep, by comparison with the records
// among its references.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/motions/progress.hpp"
#include "scenes/regression/entry_context.hpp"
#include "scenes/regression/motion_record.hpp"

namespace beamcam::scenes {

// A motion by its number (RecordNames). `until`: the last instant that the entry shows [s]. `label` begins the
// messages.
void judge_motion(EntryContext& test, std::size_t number, const std::string& label, const sim::Table& table,
                  const std::vector<sim::Impact>& impacts, double until, std::optional<double> reproducible_until);

// Computes the points of the sweep. Throws sim::Interrupted, SceneError if the sweep is impossible.
void judge_sweep(EntryContext& test, int threads, Progress& progress);

}  // namespace beamcam::scenes
