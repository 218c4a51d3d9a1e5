#include "scenes/regression/entry_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/data/table_reader.hpp"
#include "output/files/errors.hpp"
#include "render/base/error.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/regression/records.hpp"
#include "scenes/sweep/sweep_run.hpp"
#include "sim/observe/recorder.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// The verdict that `compare` finds with the references; nothing if there are none. An update replaces damaged ones,
// which are no error then.
Verdict verdict_of(EntryContext& test, const std::string& label,
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

// A motion by its number (RecordNames). `until`: the last instant that the entry shows [s]. `label` begins the
// messages.
void judge_motion(EntryContext& test, std::size_t number, const std::string& label, const sim::Table& table,
                  const std::vector<sim::Impact>& impacts, double until, std::optional<double> reproducible_until) {
    const RecordNames names(number);
    test.update.keep(names.table), test.update.keep(names.impacts);
    const Verdict verdict = verdict_of(test, label, [&]() -> std::optional<MotionVerdict> {
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

}  // namespace

EntryTest::EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options,
                     const std::string& renderer, output::FileList& report_files, EntryResult& result)
    : baselines_(baselines),
      options_(options),
      test_{entry,
            result,
            renderer,
            entry.tolerance,
            References(baselines.references, entry.name, !options.update.empty()),
            {},
            options.report,
            report_files},
      pictures_(test_) {
    if (entry.has_pictures()) test_.result.picture = Verdict::identical;
    if (entry.has_motion()) test_.result.motion = Verdict::identical;
}

// ---- an entry with a motion ------------------------------------------------------------------------

void EntryTest::prepare() {
    const Scene& scene = test_.entry.scene;
    plan_ = plan(resolve(scene, [](const sim::Problem& problem, const sim::Request& events) {
        return sim::simulate(problem, events, until_interrupted);
    }));
    // A picture that compares other motions than the scene's own needs no simulation of the scene. A figure of statics
    // needs no motion at all.
    if (plan_.motions.empty() && !plan_.figures.empty()) test_.result.motion.reset();
    const std::string own = motion_key(scene.problem);
    until_ = 0;
    const bool has_own = std::ranges::count(plan_.motions, own, &MotionRequest::key) > 0;
    for (const MotionRequest& each : plan_.motions)
        if (!has_own || each.key == own) until_ = std::max(until_, end_of(each.request));
    if (!plan_.run) {
        plan_.run = plan_.motions.size();
        plan_.motions.push_back({scene.problem, own});
    }
    sim::Request& run = run_request();
    run.end_time = until_;
    if (test_.references.is_updated()) run.horizon = true;  // some figures request it anyway
    request_record();
    if (needs_motion()) request_compared_records();
}

void EntryTest::request(MotionPool& pool) {
    for (const MotionRequest& each : plan_.motions) requests_.push_back(pool.add(each));
}

// The table of the entry itself is recorded if it is one, else a small one.
void EntryTest::request_record() {
    std::vector<sim::TableRequest>& tables = run_request().tables;
    const bool is_table = std::holds_alternative<TrajectoryOutput>(test_.entry.output());
    recorded_ = is_table ? plan_.data.front().tables.front() : tables.size();
    if (!is_table && needs_motion()) tables.push_back(motion_behind_picture(test_.entry.scene.problem, until_));
    // The energy residual, an error of the solver, is not compared.
    if (is_table && std::get<TrajectoryOutput>(test_.entry.output()).channels.empty())
        std::erase_if(tables[recorded_].channels,
                      [](const sim::Channel& channel) { return channel.kind == sim::ChannelKind::energy_residual; });
}

void EntryTest::request_compared_records() {
    for (const PlannedPictures& p : plan_.pictures)
        for (std::size_t i = 0; i < p.compare.size(); ++i) {
            MotionRequest& other = plan_.motions[p.motions[i]];
            other.request.tables.push_back(motion_behind_picture(other.problem, p.end_time));
            if (test_.references.is_updated()) other.request.horizon = true;
        }
}

void EntryTest::judge(MotionPool& pool, const RunOptions& options) {
    std::vector<sim::Result> results;
    for (const std::size_t request : requests_) results.push_back(std::move(pool.result(request)));
    const sim::Result& run = results[*plan_.run];
    if (test_.result.picture) require_reproducible(run);
    if (needs_motion()) {
        judge_motion(test_, 0, "", run.tables[recorded_], run.impacts, until_, run.reproducible_until);
        for (const PlannedPictures& p : plan_.pictures)
            for (std::size_t i = 0; i < p.compare.size(); ++i) {
                const sim::Result& other = results[p.motions[i]];
                require_reproducible(other);
                judge_motion(test_, i + 1, p.compare[i].label + ": ", other.tables.back(), other.impacts, p.end_time,
                             other.reproducible_until);
            }
    }
    DrawCallbacks callbacks{
        [&](const PlannedPictures&, long frame, const render::Image& image) { pictures_.judge(frame, image); },
        [&](const render::Image& image) { pictures_.judge(0, image); }};
    scenes::draw(plan_, test_.entry.scene, std::move(results), callbacks, options);
    if (test_.result.picture) pictures_.conclude();
    update();
}

void EntryTest::judge_sweep(int threads, Progress& progress) {
    SweepRun sweep(test_.entry.scene);
    sweep.make(threads, progress);
    std::string csv;
    output::write_sweep_csv([&csv](const std::string& text) { csv += text; }, sweep.data());
    const output::ColumnTable samples = output::parse_csv(csv, kSweepRecord);
    test_.update.keep(kSweepRecord);
    const Verdict verdict = verdict_of(test_, "", [&]() -> std::optional<MotionVerdict> {
        if (!test_.references.has(kSweepRecord)) return std::nullopt;
        return compare_sweeps(output::read_table(test_.references.file(kSweepRecord)), samples, test_.tolerance);
    });
    if (test_.references.is_updated() && verdict != Verdict::identical) {
        require_settled(test_, sweep);
        test_.update.put(kSweepRecord, csv);
    }
    update();
}

void EntryTest::require_reproducible(const sim::Result& motion) const {
    const std::vector<sim::Interval>& lost = motion.not_reproducible;
    if (!test_.references.is_updated() || lost.empty() || lost.front().from >= last_shown()) return;
    throw render::PictureError(fmt::format(
        "not accepted: it shows the motion until {:.6g} s, which is {}; choose an earlier instant, or guard a "
        "trajectory or a sweep",
        last_shown(), motion.reproducibility));
}

double EntryTest::last_shown() const {
    if (plan_.pictures.empty()) return until_;
    const FilmTimes& times = plan_.pictures.front().times;
    return std::max(times.frames.back(), times.chart.back());
}

// ---- verdicts --------------------------------------------------------------------------------------

void EntryTest::update() {
    if (!test_.references.is_updated()) return;
    const bool has_pictures = test_.entry.has_pictures();
    if (has_pictures && pictures_.adds_digests() &&
        test_.result.motion.value_or(Verdict::identical) <= Verdict::equivalent)
        test_.update.only_digests();  // the records of the other renderer's machine stay
    if (!has_pictures && test_.references.has(kDigestsFile)) test_.update.keep(kDigestsFile);
    if (!has_pictures && !test_.references.has(kDigestsFile)) test_.update.put_digests({});
    const ReferenceUpdate::Changes changes =
        test_.update.carry_out(test_.references, baselines_.root, options_.run.force);
    for (const std::string& name : changes.written) test_.result.written.push_back(test_.references.file(name));
    for (const std::string& name : changes.removed) test_.result.removed.push_back(test_.references.file(name));
}

void EntryTest::fail(const std::string& reason, Verdict verdict, int exit_code) {
    if (test_.result.picture) test_.result.picture = verdict;
    if (test_.result.motion) test_.result.motion = verdict;
    (test_.result.motion ? test_.result.motion_lines : test_.result.picture_lines) = {reason};
    test_.result.exit_code = exit_code;
    test_.result.frames.clear();
}

bool EntryTest::attempt(const std::function<void()>& work) {
    try {
        work();
        return true;
    } catch (const sim::SolverError& error) {  // such as one of a variant that a figure compares with the scene
        fail(fmt::format("the solver failed at {:.6g} s: {}", error.last_time, error.what()));
    } catch (const render::PictureError& error) {  // such as an impact that does not occur any more
        const bool accepted = test_.references.has(kDigestsFile);
        fail(error.what(), accepted ? Verdict::different : Verdict::missing);
    } catch (const SceneError& error) {  // such as a value that a sweep cannot give to a key
        fail(error.what(), Verdict::not_run, kBadScene);
    } catch (const output::IoError& error) {  // such as a damaged reference
        fail(error.what(), Verdict::not_run, kInputOutput);
    } catch (const fs::filesystem_error& error) {
        fail(output::io_error(error).what(), Verdict::not_run, kInputOutput);
    }
    return false;
}

}  // namespace beamcam::scenes
