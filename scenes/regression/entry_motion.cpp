#include "scenes/regression/entry_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "output/data/table_reader.hpp"
#include "scenes/regression/sweep_record.hpp"
#include "scenes/scene/exit_code.hpp"
#include "scenes/sweep/sweep_run.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
bool records_all_channels(const Baseline& entry) {
    const auto* table = std::get_if<TrajectoryOutput>(&entry.output());
    return table && table->channels.empty();
}

void EntryMotion::judge(std::size_t number, const std::string& label, const sim::Table& table,
                        const std::vector<sim::Impact>& impacts, double until,
                        std::optional<double> reproducible_until) {
    const RecordNames names(number);
    test_.update.keep(names.table), test_.update.keep(names.impacts);
    Verdict verdict = Verdict::missing;
    read(
        [&] {
            const std::optional<MotionRecord> expected = read_record(test_.references, names);
            if (!expected) return add_missing(label);
            const MotionVerdict found = compare(*expected, record_of(table, impacts, until), test_.tolerance);
            verdict = found.verdict;
            add(found, label);
        },
        label);
    if (!test_.references.is_updated() || verdict == Verdict::identical) return;
    put_record(test_.update, names, table, impacts, until, reproducible_until);
    if (reproducible_until && *reproducible_until < until)
        test_.result.motion_lines.push_back(
            fmt::format("{}compared until {:.6g} s of {:.6g} s: after that it is not reproducible on other processors; "
                        "a sweep guards its attractor",
                        label, *reproducible_until, until));
}

void EntryMotion::judge_sweep(int threads, Progress& progress) {
    SweepRun sweep(test_.entry.scene);
    sweep.make(threads, progress);
    const output::ColumnTable samples = output::table_of(sweep.data());
    test_.update.keep(kSweepRecord);
    Verdict verdict = Verdict::missing;
    read(
        [&] {
            if (!test_.references.has(kSweepRecord)) return add_missing("");
            const MotionVerdict found =
                compare_sweeps(output::read_table(test_.references.file(kSweepRecord)), samples, test_.tolerance);
            verdict = found.verdict;
            add(found, "");
        },
        "");
    if (!test_.references.is_updated() || verdict == Verdict::identical) return;
    require_settled(sweep);
    std::ostringstream csv;
    output::write_sweep_csv(csv, sweep.data());
    test_.update.put(kSweepRecord, csv.str());
}

void EntryMotion::require_settled(const SweepRun& sweep) {
    const std::uint64_t points = sweep.grid().points();
    std::uint64_t unsettled = 0;
    for (std::uint64_t k = 0; k < points; ++k)
        if (sweep.read(k).kind == static_cast<int>(sim::AttractorClass::unsettled)) ++unsettled;
    if (unsettled == 0) return;
    test_.result.motion_lines.push_back(
        fmt::format("{} of {} points are not compared: they have not settled", unsettled, points));
    if (unsettled == points) throw SceneError("not accepted: " + test_.result.motion_lines.back());
}

void EntryMotion::read(const std::function<void()>& work, const std::string& label) {
    try {
        work();
    } catch (const output::IoError&) {
        if (!test_.references.is_updated()) throw;
        add_missing(label);
    }
}

void EntryMotion::add(const MotionVerdict& verdict, const std::string& label) {
    test_.result.motion = std::max(*test_.result.motion, verdict.verdict);
    for (const std::string& line : verdict.lines) test_.result.motion_lines.push_back(label + line);
}

void EntryMotion::add_missing(const std::string& label) {
    test_.result.motion = Verdict::missing;
    test_.result.motion_lines.push_back(
        fmt::format("{}there is no motion in {}", label, test_.references.folder().string()));
}

}  // namespace beamcam::scenes
