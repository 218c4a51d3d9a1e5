#include "scenes/regression/entry_motion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"
#include "scenes/regression/sweep_record.hpp"
#include "scenes/scene/exit_code.hpp"
#include "scenes/sweep/sweep_run.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Keeps the rows up to `until`, at least the first.
void cut(sim::Table& table, double until) {
    const std::vector<double>& t = table.values.front();
    const auto kept = std::max<std::ptrdiff_t>(1, std::upper_bound(t.begin(), t.end(), until) - t.begin());
    for (std::vector<double>& column : table.values) column.resize(static_cast<std::size_t>(kept));
}

// ---- sweeps ----------------------------------------------------------------------------------------

// Far above rounding errors, far below the differences between settled motions.
constexpr double kPerturbation = 1e-12;
constexpr int kRepetitions = 3;  // find a point that changes in every third run with a probability of 70 %
constexpr int kUnsettled = static_cast<int>(sim::AttractorClass::unsettled);

// At most two of these keys are swept; the third changes.
Scene perturbed(Scene scene, int times) {
    const double factor = 1 + times * kPerturbation;
    scene.problem.gravity *= factor;
    if (scene.problem.cam) scene.problem.cam->speed *= factor, scene.problem.cam->eccentricity *= factor;
    return scene;
}

// Points that may differ on another processor: unsettled points, and points that change if the sweep is repeated with
// slightly more gravity, speed and eccentricity of the cam.
std::vector<bool> uncertain_points(const SweepRun& sweep, const Tolerance& tolerance, int threads, Progress& progress) {
    const output::ColumnTable own = table_of(sweep.data());
    std::vector<bool> uncertain(sweep.grid().points());
    for (std::uint64_t k = 0; k < uncertain.size(); ++k) uncertain[k] = sweep.read(k).kind == kUnsettled;
    for (int repetition = 1; repetition <= kRepetitions; ++repetition) {
        SweepRun other(perturbed(sweep.grid().scene(), repetition));
        other.make(threads, progress);
        const auto& problem = sweep.grid().scene().problem;
        for (const std::size_t k : points_that_differ(own, table_of(other.data()), tolerance, problem))
            uncertain[k] = true;
    }
    return uncertain;
}

// The sweep with these points unsettled and without samples. Valid during the lifetime of both.
output::SweepData without_points(output::SweepData data, const std::vector<bool>& uncertain) {
    data.rows = [&uncertain, rows = data.rows](std::uint64_t k) { return uncertain[k] ? 0 : rows(k); };
    data.read = [&uncertain, read = data.read](std::uint64_t k) {
        if (!uncertain[k]) return read(k);
        output::StoredPoint none;
        none.point = k;
        none.kind = kUnsettled;
        return none;
    };
    return data;
}

}  // namespace

bool records_all_channels(const Baseline& entry) {
    const auto* table = std::get_if<TrajectoryOutput>(&entry.output());
    return table && table->channels.empty();
}

void EntryMotion::judge(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until,
                        std::optional<double> reproducible_until) {
    if (test_.references.are_replaced || reproducible_until)
        test_.result.reproducible_until = std::min(until, reproducible_until.value_or(until));
    judge_record(RecordNames(0), "", table, impacts, until, test_.entry.reproducible_until.value_or(until));
    if (test_.references.are_replaced && test_.result.reproducible_until < until)
        test_.result.motion_lines.push_back(
            fmt::format("compared until {:.6g} s of {:.6g} s: after that it is not reproducible on other processors; a "
                        "sweep guards its statistics",
                        *test_.result.reproducible_until, until));
}

sim::TableRequest EntryMotion::compared_table(std::size_t index, const sim::Problem& problem, double until) const {
    sim::TableRequest request = motion_behind_picture(problem, until);
    if (test_.references.are_replaced) return request;
    if (const auto expected = read_record(test_.references.folder, RecordNames(index + 1)))
        if (const std::vector<double>* t = expected->table.find("t")) request.times = *t;
    return request;
}

void EntryMotion::judge_compared(std::size_t index, const std::string& label, sim::Table table,
                                 const std::vector<sim::Impact>& impacts, std::optional<double> reproducible_until) {
    if (test_.references.are_replaced && reproducible_until) cut(table, *reproducible_until);
    const double until = table.values.front().back();
    judge_record(RecordNames(index + 1), label + ": ", table, impacts, until, until);
}

void EntryMotion::judge_sweep(int threads, Progress& progress) {
    SweepRun sweep(test_.entry.scene);
    sweep.make(threads, progress);
    test_.references.read([&] {
        const fs::path record = test_.references.folder / kSweepRecord;
        if (!output::path_exists(record)) return add_missing("");
        add(compare_sweeps(output::read_table(record), table_of(sweep.data()), test_.tolerance,
                           test_.entry.scene.problem),
            "", {kSweepRecord});
    });
    if (!is_stored()) return;
    const std::vector<bool> uncertain = uncertain_points(sweep, test_.tolerance, threads, progress);
    const auto count = std::ranges::count(uncertain, true);
    if (count > 0)
        test_.result.motion_lines.push_back(
            fmt::format("{} of {} points are not compared: they have not settled, or may settle to something else on "
                        "another processor",
                        count, sweep.grid().points()));
    if (static_cast<std::uint64_t>(count) == sweep.grid().points())
        throw SceneError("not accepted: " + test_.result.motion_lines.back());
    store({kSweepRecord},
          [&](const Files& file) { output::write_sweep(file(kSweepRecord), without_points(sweep.data(), uncertain)); });
}

void EntryMotion::store(const std::vector<std::string>& names, const std::function<void(const Files&)>& write) {
    if (!is_stored()) return;
    write([&](const std::string& name) { return test_.tested.file(name); });
    for (const std::string& name : names)
        test_.result.motion_files[name] = output::sha256_of_file(*test_.tested.folder / test_.entry.name / name);
}

void EntryMotion::judge_record(const RecordNames& names, const std::string& label, const sim::Table& table,
                               const std::vector<sim::Impact>& impacts, double until, double horizon) {
    std::optional<MotionRecord> expected;
    test_.references.read([&] { expected = read_record(test_.references.folder, names); });
    if (!expected) {
        add_missing(label);
    } else {
        if (records_all_channels(test_.entry))
            std::erase_if(expected->table.columns, [](const output::TableColumn& column) {
                return column.name == "energy_residual";  // of older records
            });
        add(compare(*expected, record_of(table, impacts, until), test_.tolerance, horizon), label,
            {names.table, names.impacts});
    }
    store({names.table, names.impacts}, [&](const Files& files) { write_record(files, names, table, impacts, until); });
}

void EntryMotion::add(const MotionVerdict& verdict, const std::string& label, const std::vector<std::string>& names) {
    test_.result.motion = std::max(*test_.result.motion, verdict.verdict);
    for (const std::string& line : verdict.lines) test_.result.motion_lines.push_back(label + line);
    for (const std::string& name : names)
        if (!test_.references.is_as_marked(name)) {
            test_.result.motion = std::max(*test_.result.motion, Verdict::different);
            test_.result.motion_lines.push_back(
                fmt::format("{} was changed after beamcam made it", (test_.references.folder / name).string()));
        }
}

void EntryMotion::add_missing(const std::string& label) {
    test_.result.motion = Verdict::missing;
    test_.result.motion_lines.push_back(
        fmt::format("{}there is no motion in {}", label, test_.references.folder.string()));
}

}  // namespace beamcam::scenes
