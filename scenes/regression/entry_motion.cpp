#include "scenes/regression/entry_motion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"
#include "scenes/regression/computed_sweep.hpp"
#include "scenes/regression/sweep_record.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Keeps the rows up to `until`, at least the first.
void cut(sim::Table& table, double until) {
    const std::vector<double>& t = table.values.front();
    const auto kept = std::max<std::ptrdiff_t>(1, std::upper_bound(t.begin(), t.end(), until) - t.begin());
    for (std::vector<double>& column : table.values) column.resize(static_cast<std::size_t>(kept));
}

void remove_column(output::NamedTable& table, std::string_view name) {
    const auto at = std::ranges::find(table.names, name);
    if (at == table.names.end()) return;
    table.columns.erase(table.columns.begin() + (at - table.names.begin()));
    table.names.erase(at);
}

}  // namespace

bool records_all_channels(const Baseline& entry) {
    const auto* table = std::get_if<TrajectoryOutput>(&entry.output());
    return table && table->channels.empty();
}

void EntryMotion::judge(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until,
                        std::optional<double> reproducible_until) {
    if (references_.is_replaced() || reproducible_until)
        result_.reproducible_until = std::min(until, reproducible_until.value_or(until));
    judge_record(RecordNames(0), "", table, impacts, until, entry_.reproducible_until.value_or(until));
    if (references_.is_replaced() && result_.reproducible_until < until)
        result_.motion_lines.push_back(
            fmt::format("compared until {:.6g} s of {:.6g} s: after that it is not reproducible on other processors; a "
                        "sweep guards its statistics",
                        *result_.reproducible_until, until));
}

sim::TableRequest EntryMotion::compared_table(std::size_t index, const sim::Problem& problem, double until) const {
    sim::TableRequest request = motion_behind_picture(problem, until);
    if (references_.is_replaced()) return request;
    if (const auto expected = read_record(references_.folder, RecordNames(index + 1)))
        if (const std::vector<double>* t = expected->table.find("t")) request.times = *t;
    return request;
}

void EntryMotion::judge_compared(std::size_t index, const std::string& label, sim::Table table,
                                 const std::vector<sim::Impact>& impacts, std::optional<double> reproducible_until) {
    if (references_.is_replaced() && reproducible_until) cut(table, *reproducible_until);
    const double until = table.values.front().back();
    judge_record(RecordNames(index + 1), label + ": ", table, impacts, until, until);
}

void EntryMotion::judge_sweep(int threads, Progress& progress) {
    const ComputedSweep sweep(entry_.scene, threads, progress);
    references_.read([&] {
        const fs::path record = references_.folder / kSweepRecord;
        if (!output::path_exists(record)) return add_missing("");
        add(compare_sweeps(output::read_table(record), sweep.table(), tolerance_), "", {kSweepRecord});
    });
    if (!references_.is_replaced() && !is_reported()) return;
    const std::vector<bool> uncertain = sweep.uncertain(tolerance_, threads, progress);
    const auto count = std::ranges::count(uncertain, true);
    if (count > 0)
        result_.motion_lines.push_back(
            fmt::format("{} of {} points are not compared: they have not settled, or may settle to something else on "
                        "another processor",
                        count, sweep.points()));
    if (static_cast<std::uint64_t>(count) == sweep.points())
        throw SceneError("not accepted: " + result_.motion_lines.back());
    store({kSweepRecord}, [&](const Files& file) { sweep.write(file(kSweepRecord), uncertain); });
}

// Writes files among the new references, and into the report if the motion differs, for `beamcam accept`.
void EntryMotion::store(const std::vector<std::string>& names, const std::function<void(const Files&)>& write) {
    if (references_.is_replaced()) write([&](const std::string& name) { return references_.new_folder() / name; });
    if (!is_reported()) return;
    write([&](const std::string& name) { return report_.file(name); });
    for (const std::string& name : names)
        result_.motion_files[name] = output::sha256_of_file(*report_.folder / entry_.name / name);
}

void EntryMotion::judge_record(const RecordNames& names, const std::string& label, const sim::Table& table,
                               const std::vector<sim::Impact>& impacts, double until, double horizon) {
    std::optional<MotionRecord> expected;
    references_.read([&] { expected = read_record(references_.folder, names); });
    if (!expected) {
        add_missing(label);
    } else {
        if (records_all_channels(entry_)) remove_column(expected->table, "energy_residual");  // of older records
        add(compare(*expected, record_of(table, impacts, until), tolerance_, horizon), label,
            {names.table, names.impacts});
    }
    store({names.table, names.impacts}, [&](const Files& files) { write_record(files, names, table, impacts, until); });
}

void EntryMotion::add(const MotionVerdict& verdict, const std::string& label, const std::vector<std::string>& names) {
    result_.motion = worse(*result_.motion, verdict.verdict);
    for (const std::string& line : verdict.lines) result_.motion_lines.push_back(label + line);
    for (const std::string& name : names)
        if (!references_.is_as_marked(name)) {
            result_.motion = worse(*result_.motion, Verdict::different);
            result_.motion_lines.push_back(
                fmt::format("{} was changed after beamcam made it", (references_.folder / name).string()));
        }
}

void EntryMotion::add_missing(const std::string& label) {
    result_.motion = Verdict::missing;
    result_.motion_lines.push_back(fmt::format("{}there is no motion in {}", label, references_.folder.string()));
}

}  // namespace beamcam::scenes
