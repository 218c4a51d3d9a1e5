#include "scenes/regression/entry_motion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/files/atomic_file.hpp"
#include "output/files/sha256.hpp"
#include "scenes/regression/made_sweep.hpp"
#include "scenes/regression/sweep_record.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// The rows up to `until`; the first one stays.
void cut(sim::Table& table, double until) {
    const std::vector<double>& t = table.values.front();
    const auto kept = std::max<std::ptrdiff_t>(1, std::upper_bound(t.begin(), t.end(), until) - t.begin());
    for (std::vector<double>& column : table.values) column.resize(static_cast<std::size_t>(kept));
}

void remove_column(output::NamedTable& table, std::string_view name) {
    const auto at = std::find(table.names.begin(), table.names.end(), name);
    if (at == table.names.end()) return;
    table.columns.erase(table.columns.begin() + (at - table.names.begin()));
    table.names.erase(at);
}

}  // namespace

bool asks_for_all_channels(const Baseline& entry) {
    const auto* asked = std::get_if<TrajectoryOutput>(&entry.output());
    return asked && asked->channels.empty();
}

void EntryMotion::judge(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until,
                        std::optional<double> reproducible_until) {
    const RecordNames names(0);
    if (references_.fresh || reproducible_until)
        result_.reproducible_until = std::min(until, reproducible_until.value_or(until));
    if (references_.fresh) write_record(fresh_files(), names, table, impacts, until);
    judge_record(names, "", record_of(table, impacts, until), entry_.reproducible_until.value_or(until));
    report({names.table, names.impacts},
           [&](const Files& files) { write_record(files, names, table, impacts, until); });
    if (references_.fresh && result_.reproducible_until < until)
        result_.motion_lines.push_back(
            fmt::format("judged until {:.6g} s of {:.6g} s: no further is it the same on other processors; a sweep "
                        "guards its statistics",
                        *result_.reproducible_until, until));
}

sim::TableRequest EntryMotion::request_of_compared(std::size_t index, const sim::Problem& problem, double until) const {
    sim::TableRequest request = motion_behind_picture(problem, until);
    if (references_.fresh) return request;
    if (const auto expected = read_record(references_.folder, RecordNames(index + 1)))
        if (const std::vector<double>* t = expected->table.find("t")) request.times = *t;
    return request;
}

void EntryMotion::judge_compared(std::size_t index, const std::string& label, sim::Table table,
                                 const std::vector<sim::Impact>& impacts, std::optional<double> reproducible_until) {
    const RecordNames names(index + 1);
    if (references_.fresh && reproducible_until) cut(table, *reproducible_until);
    const double until = table.values.front().back();
    if (references_.fresh) write_record(fresh_files(), names, table, impacts, until);
    judge_record(names, label + ": ", record_of(table, impacts, until), until);
    report({names.table, names.impacts},
           [&](const Files& files) { write_record(files, names, table, impacts, until); });
}

void EntryMotion::judge_sweep(int threads, Progress& progress) {
    const MadeSweep made(entry_.scene, threads, progress);
    references_.read([&] {
        const fs::path kept = references_.folder / kSweepRecord;
        if (!output::path_exists(kept)) return miss("");
        take(compare_sweeps(output::read_table(kept), made.table(), tolerance_), "", {kSweepRecord});
    });
    const bool is_reported = report_.folder && result_.motion > Verdict::equivalent;
    if (!references_.fresh && !is_reported) return;
    const std::vector<bool> unsure = made.unsure(tolerance_, threads, progress);
    const auto count = std::ranges::count(unsure, true);
    if (count > 0)
        result_.motion_lines.push_back(
            fmt::format("{} of {} points are not judged: they have not settled, or may be others on another processor",
                        count, made.points()));
    if (static_cast<std::uint64_t>(count) == made.points())
        throw SceneError("not accepted: " + result_.motion_lines.back());
    if (references_.fresh) made.write(fresh_files()(kSweepRecord), unsure);
    report({kSweepRecord}, [&](const Files& files) { made.write(files(kSweepRecord), unsure); });
}

EntryMotion::Files EntryMotion::fresh_files() const {
    return [this](const std::string& name) { return *references_.fresh / name; };
}

// What moved is in the report, for `beamcam accept`.
void EntryMotion::report(const std::vector<std::string>& names, const std::function<void(const Files&)>& write) {
    if (!report_.folder || *result_.motion <= Verdict::equivalent) return;
    write([&](const std::string& name) { return report_.file(name); });
    for (const std::string& name : names)
        result_.motion_files[name] = output::sha256_of_file(*report_.folder / entry_.name / name);
}

void EntryMotion::miss(const std::string& label) {
    result_.motion = Verdict::missing;
    result_.motion_lines.push_back(fmt::format("{}no motion is kept in {}", label, references_.folder.string()));
}

void EntryMotion::judge_record(const RecordNames& names, const std::string& label, const MotionRecord& actual,
                               double horizon) {
    std::optional<MotionRecord> expected;
    references_.read([&] { expected = read_record(references_.folder, names); });
    if (!expected) return miss(label);
    if (asks_for_all_channels(entry_)) remove_column(expected->table, "energy_residual");  // of records that had it
    take(compare(*expected, actual, tolerance_, horizon), label, {names.table, names.impacts});
}

void EntryMotion::take(const MotionVerdict& found, const std::string& label, const std::vector<std::string>& names) {
    result_.motion = worse(*result_.motion, found.verdict);
    for (const std::string& line : found.lines) result_.motion_lines.push_back(label + line);
    for (const std::string& name : names)
        if (!references_.is_as_marked(name)) {
            result_.motion = worse(*result_.motion, Verdict::different);
            result_.motion_lines.push_back(
                fmt::format("{} is not what --update put there", (references_.folder / name).string()));
        }
}

}  // namespace beamcam::scenes
