// The record of an entry's motion: a small table up to the last instant that the entry shows, and the impacts until
// then. It is stored beside the reference pictures and compared impact by impact.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/data/tables.hpp"
#include "output/files/target.hpp"
#include "scenes/regression/baselines.hpp"
#include "scenes/regression/comparison.hpp"

namespace beamcam::scenes {

using ImpactFields = std::vector<std::pair<std::string, std::optional<double>>>;  // in the order of the file

struct MotionRecord {
    output::ColumnTable table;
    std::vector<ImpactFields> impacts;
};

// The table that is recorded of the motion in a picture: angle and deflection, in 200 steps up to the last instant.
sim::TableRequest motion_behind_picture(const sim::Problem& problem, double until);

// The part of the run up to `until`. An impact that lasts longer is recorded with its values at the touch.
MotionRecord record_of(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until);

// Names of the two files of a motion: 0 is the motion of the scene; the motions that its picture compares follow.
struct RecordNames {
    explicit RecordNames(std::size_t motion);
    std::string table, impacts;  // motion.csv, impacts.json; motion-1.csv, impacts-1.json
};
// `target`: the place of a file of this name.
void write_record(const std::function<output::Target(const std::string& name)>& target, const RecordNames& names,
                  const sim::Table& table, const std::vector<sim::Impact>& impacts, double until);
// Nothing if the folder has no record. Throws IoError if the record is damaged.
std::optional<MotionRecord> read_record(const std::filesystem::path& folder, const RecordNames& names);

struct MotionVerdict {
    Verdict verdict = Verdict::identical;
    std::vector<std::string> lines;  // the differences, the largest first; empty if identical
};

// Up to `horizon`, differences within the tolerance are equivalent; after it the motions are not comparable, and any
// difference is equivalent.
MotionVerdict compare(const MotionRecord& expected, const MotionRecord& actual, const Tolerance& tolerance,
                      double horizon);

}  // namespace beamcam::scenes
