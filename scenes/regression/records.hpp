// The records of an entry, and their comparison with those among its references. Of a motion: a small table up to the
// last instant that the entry shows, the impacts until then, and the time up to which the motion is reproducible. Of a
// sweep: the samples of all its points as `beamcam sweep -o FILE.csv` writes them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/data/tables.hpp"
#include "output/json/tree.hpp"
#include "scenes/regression/baselines.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/regression/references.hpp"
#include "sim/run/simulate.hpp"

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

// ---- sweeps ------------------------------------------------------------------------------------

inline constexpr const char* kSweepRecord = "sweep.csv";

// Points must have the same class, where all motions without period are one; those at rest, following the cam, or
// periodic also the same period and impacts, and each sample of their orbit must have a sample of the other sweep
// within the tolerance `motion`, a share of the largest value of the column in the sweep, wherever in its period either
// begins. Of points at rest only the angle is compared: their rates are errors of the solver. Unsettled points are not
// compared.
MotionVerdict compare_sweeps(const output::ColumnTable& expected, const output::ColumnTable& actual,
                             const Tolerance& tolerance);

}  // namespace beamcam::scenes
