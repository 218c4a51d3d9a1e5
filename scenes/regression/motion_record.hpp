// The motion behind a baseline: a small table up to the last instant that the entry looks at, and the impacts by then.
// Kept beside the reference pictures, compared impact by impact.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/data/table_reader.hpp"
#include "output/files/target.hpp"
#include "scenes/regression/baselines.hpp"
#include "scenes/regression/comparison.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

using ImpactFields = std::vector<std::pair<std::string, std::optional<double>>>;  // in the order of the file

struct MotionRecord {
    output::NamedTable table;
    std::vector<ImpactFields> impacts;
};

// The table that is recorded behind a picture: angle and deflection, in 200 steps up to the last instant it looks at.
sim::TableRequest motion_behind_picture(const sim::Problem& problem, double until);

// What of the run belongs to the entry. An impact that lasts beyond `until` counts with what is known at its touch.
MotionRecord record_of(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until);

// Names of the two files of a motion: 0 is the scene's own, the others are those that its picture compares, from 1.
struct RecordNames {
    explicit RecordNames(std::size_t motion);
    std::string table, impacts;  // motion.csv, impacts.json; motion-1.csv, impacts-1.json
};
// `target`: where a file of this name goes.
void write_record(const std::function<output::Target(const std::string& name)>& target, const RecordNames& names,
                  const sim::Table& table, const std::vector<sim::Impact>& impacts, double until);
// Nothing when the folder has none. Throws IoError when what it has is damaged.
std::optional<MotionRecord> read_record(const std::filesystem::path& folder, const RecordNames& names);

struct MotionVerdict {
    Verdict verdict = Verdict::identical;
    std::vector<std::string> lines;  // what moved, the worst first; empty when identical
};

// Up to `horizon` differences within the tolerance are equivalent; beyond it nothing is comparable, and all are.
MotionVerdict compare(const MotionRecord& expected, const MotionRecord& actual, const Tolerance& tolerance,
                      double horizon);

}  // namespace beamcam::scenes
