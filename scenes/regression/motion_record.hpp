// The record of an entry's motion: a small table up to the last instant that the entry shows, the impacts until then,
// and the time up to which the motion is reproducible.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/regression/motion_comparison.hpp"
#include "scenes/regression/references.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

// The table that is recorded of the motion in a picture: angle and deflection, in 200 steps up to the last instant.
sim::TableRequest motion_behind_picture(const sim::Problem& problem, double until);

// The part of the run up to `until`. An impact that lasts longer is recorded with its values at the touch.
MotionRecord record_of(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until);

// Names of the two files of a motion: 0 is the motion of the scene; the motions that its picture compares follow.
struct RecordNames {
    explicit RecordNames(std::size_t motion);
    std::string table, impacts;  // motion.csv, impacts.json; motion-1.csv, impacts-1.json
};
void put_record(ReferenceUpdate& update, const RecordNames& names, const sim::Table& table,
                const std::vector<sim::Impact>& impacts, double until, std::optional<double> reproducible_until);
// Nothing if the folder has no record. Throws IoError if the record is damaged.
std::optional<MotionRecord> read_record(const References& references, const RecordNames& names);

}  // namespace beamcam::scenes
