#include "scenes/regression/entry_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "output/data/table_reader.hpp"
#include "scenes/regression/sweep_record.hpp"
#include "scenes/scene/exit_code.hpp"
#include "scenes/sweep/sweep_run.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

// The verdict that `compare` finds with the references; nothing if there are none. An update replaces damaged ones,
// which are no error then.
Verdict judge(EntryContext& test, const std::string& label,
              const std::function<std::optional<MotionVerdict>()>& compare) {
    std::optional<MotionVerdict> found;
    try {
        found = compare();
    } catch (const output::IoError&) {
        if (!test.references.is_updated()) throw;
    }
    if (!found)
        found = {Verdict::missing, {fmt::format("there is no motion in {}", test.references.folder().string())}};
    test.result.motion = std::max(*test.result.motion, found->verdict);
    for (const std::string& line : found->lines) test.result.motion_lines.push_back(label + line);
    return found->verdict;
}

// Adds a message on unsettled points. Throws SceneError if there are no others.
void require_settled(EntryContext& test, const SweepRun& sweep) {
    const std::uint64_t points = sweep.grid().points();
    std::uint64_t unsettled = 0;
    for (std::uint64_t k = 0; k < points; ++k)
        if (sweep.read(k).kind == static_cast<int>(sim::AttractorClass::unsettled)) ++unsettled;
    if (unsettled == 0) return;
    test.result.motion_lines.push_back(
        fmt::format("{} of {} points are not compared: they have not settled", unsettled, points));
    if (unsettled == points) throw SceneError("not accepted: " + test.result.motion_lines.back());
}

}  // namespace

void judge_motion(EntryContext& test, std::size_t number, const std::string& label, const sim::Table& table,
                  const std::vector<sim::Impact>& impacts, double until, std::optional<double> reproducible_until) {
    const RecordNames names(number);
    test.update.keep(names.table), test.update.keep(names.impacts);
    const Verdict verdict = judge(test, label, [&]() -> std::optional<MotionVerdict> {
        const std::optional<MotionRecord> expected = read_record(test.references, names);
        if (!expected) return std::nullopt;
        return compare(*expected, record_of(table, impacts, until), test.tolerance);
    });
    if (!test.references.is_updated() || verdict == Verdict::identical) return;
    put_record(test.update, names, table, impacts, until, reproducible_until);
    if (reproducible_until && *reproducible_until < until)
        test.result.motion_lines.push_back(
            fmt::format("{}compared until {:.6g} s of {:.6g} s: after that it is not reproducible on other processors; "
                        "a sweep guards its attractor",
                        label, *reproducible_until, until));
}

void judge_sweep(EntryContext& test, int threads, Progress& progress) {
    SweepRun sweep(test.entry.scene);
    sweep.make(threads, progress);
    const output::ColumnTable samples = output::table_of(sweep.data());
    test.update.keep(kSweepRecord);
    const Verdict verdict = judge(test, "", [&]() -> std::optional<MotionVerdict> {
        if (!test.references.has(kSweepRecord)) return std::nullopt;
        return compare_sweeps(output::read_table(test.references.file(kSweepRecord)), samples, test.tolerance);
    });
    if (!test.references.is_updated() || verdict == Verdict::identical) return;
    require_settled(test, sweep);
    std::ostringstream csv;
    output::write_sweep_csv(csv, sweep.data());
    test.update.put(kSweepRecord, csv.str());
}

}  // namespace beamcam::scenes
