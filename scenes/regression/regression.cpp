#include "scenes/regression/regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>

#include "output/data/manifest.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/interrupt.hpp"
#include "output/files/standard_output.hpp"
#include "render/base/error.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/fingerprint.hpp"
#include "scenes/outputs/capture.hpp"
#include "scenes/outputs/run_context.hpp"
#include "scenes/regression/entry_pictures.hpp"
#include "scenes/regression/motion_record.hpp"
#include "scenes/regression/references.hpp"
#include "scenes/scene/exit_code.hpp"
#include "sim/base/clock.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// SSIM of pictures of one scene: other versions of the same fonts and libraries leave it above 0.9.
constexpr double kAlike = 0.8;

enum class Drawn { flat, lit, figure, elsewhere };

Drawn drawn(const Baseline& entry) {
    const auto by_style = [](const render::View& view) {
        return view.style == render::Style::flat ? Drawn::flat : Drawn::lit;
    };
    if (!entry.file.empty()) return Drawn::elsewhere;
    if (const auto* still = std::get_if<StillOutput>(&entry.output())) return by_style(still->view);
    if (const auto* frames = std::get_if<FramesOutput>(&entry.output())) return by_style(frames->view);
    return std::holds_alternative<FigureOutput>(entry.output()) ? Drawn::figure : Drawn::flat;
}

Fingerprint fingerprint_of(Drawn how) {
    switch (how) {
        case Drawn::flat:
            return flat_fingerprint();
        case Drawn::lit:
            return lit_fingerprint();
        case Drawn::figure:
            return figure_fingerprint();
        case Drawn::elsewhere:
            return {{{"pictures", "of another tool"}}};
    }
    throw std::logic_error("a way of drawing that has no fingerprint");
}

std::string describe(const sim::SolverError& error) {
    return fmt::format("the solver failed at {:.6g} s: {}", error.last_time, error.what());
}

// ---- one entry ---------------------------------------------------------------------------------------

class EntryTest {
  public:
    // `update`: null when references stay as they are.
    EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options, EntryResult& result,
              output::Manifest& report_files, ReferenceUpdate* update)
        : entry_(entry),
          options_(options),
          result_(result),
          update_(update),
          tolerance_(entry.tolerance.overridden_by(options.tolerance)),
          references_(baselines.references / entry.name),
          pictures_(entry, tolerance_, references_, options.report, report_files, result) {
        if (entry.has_pictures()) result_.picture = Verdict::identical;
        if (entry.has_motion()) result_.motion = Verdict::identical;
        // Pictures that are held to a file of the user's are never replaced.
        if (update_ && (entry.expected.empty() || entry.has_motion())) references_.fresh = update_->begin(entry.name);
    }

    const Baseline& entry() const { return entry_; }
    bool asks_for_motion() const { return result_.motion.has_value(); }
    void ask_for_no_motion() { result_.motion.reset(); }
    bool is_updated() const { return references_.fresh.has_value(); }
    EntryResult& result() { return result_; }

    void judge_motion(const sim::Table& all, const std::vector<sim::Impact>& impacts, double until,
                      std::optional<double> reproducible_until) {
        const sim::Table table = without_residuals(all);
        if (references_.fresh) {
            write_record(fresh_files(), RecordNames(0), table, impacts, until);
            horizon_ = std::min(until, reproducible_until.value_or(until));
        }
        judge_record(RecordNames(0), "", record_of(table, impacts, until), entry_.reproducible_until.value_or(until));
        report_record(RecordNames(0), table, impacts, until);
    }

    // Another processor would draw other pixels of a motion whose last digits have grown.
    void require_reproducible(const sim::Result& motion, double until) const {
        const std::vector<sim::Interval>& lost = motion.not_reproducible;
        if (!is_updated() || !result_.picture || lost.empty() || lost.front().from >= until) return;
        throw render::PictureError(fmt::format(
            "not accepted: it shows the motion until {:.6g} s, and {}; look no further than that, or guard a "
            "trajectory",
            until, motion.reproducibility));
    }

    // What is recorded of a motion that the picture compares: as far as it was reproducible when it was accepted.
    sim::TableRequest motion_compared(std::size_t index, const sim::Problem& problem, double until) const {
        sim::TableRequest request = motion_behind_picture(problem, until);
        if (is_updated()) return request;
        if (const auto expected = read_record(references_.folder, RecordNames(index + 1)))
            if (const std::vector<double>* t = expected->table.find("t")) request.times = *t;
        return request;
    }
    void judge_compared(std::size_t index, const std::string& label, sim::Table table,
                        const std::vector<sim::Impact>& impacts, std::optional<double> reproducible_until) {
        const RecordNames names(index + 1);
        if (references_.fresh) {
            if (reproducible_until) cut(table, *reproducible_until);
            write_record(fresh_files(), names, table, impacts, table.values.front().back());
        }
        const double until = table.values.front().back();
        judge_record(names, label + ": ", record_of(table, impacts, until), until);
        report_record(names, table, impacts, until);
    }

    // From any thread.
    void judge_picture(long frame, const render::Image& image) { pictures_.judge(frame, image); }
    void judge_file() {
        output::PictureSource source(entry_.file);
        output::Raster picture;
        std::string name;
        for (long frame = 0; source.next(picture, name); ++frame) {
            stop_if_interrupted();
            pictures_.judge(frame, picture);
        }
    }
    void finish() {
        if (result_.picture) pictures_.conclude();
    }

    // There is nothing to judge. `exit_code`: what the program is to end with.
    void make_impossible(const std::string& why, Verdict verdict = Verdict::different, int exit_code = kDiffers) {
        if (result_.picture) result_.picture = verdict;
        if (result_.motion) result_.motion = verdict;
        (result_.motion ? result_.motion_lines : result_.picture_lines) = {why};
        result_.exit_code = exit_code;
        if (references_.fresh) update_->drop(entry_.name);
        references_.fresh.reset();
    }

    // Does some work; what fails costs this entry alone. False: it has failed.
    bool attempt(const std::function<void()>& work) {
        try {
            work();
            return true;
        } catch (const sim::SolverError& error) {  // such as one of a variant that a figure compares the scene with
            make_impossible(describe(error));
        } catch (const render::PictureError& error) {  // such as an impact that there is no more
            make_impossible(error.what());
        } catch (const output::IoError& error) {  // such as a damaged reference
            make_impossible(error.what(), Verdict::missing, kInputOutput);
        } catch (const fs::filesystem_error& error) {
            make_impossible(output::io_error(error).what(), Verdict::missing, kInputOutput);
        }
        return false;
    }

    // Is nothing accepted yet of the renderer that drew the pictures, and nothing else wrong with the entry? Then the
    // verdict is its own where they look alike.
    void judge_renderer(const std::string& renderer) {
        const auto is_fine = [](const auto& each) { return each.second.reference_accepted; };
        is_of_new_renderer_ =
            result_.picture == Verdict::different && result_.exit_code == 0 &&
            result_.motion.value_or(Verdict::identical) <= Verdict::equivalent &&
            std::ranges::all_of(result_.frames, is_fine) && !entry_.accepted.empty() &&
            entry_.accepted.front().sha256.size() == result_.frames.size() &&
            std::ranges::none_of(entry_.accepted, [&](const Accepted& a) { return a.renderer == renderer; });
        if (!is_of_new_renderer_) return;
        const auto is_alike = [](const auto& each) {
            const FrameResult& found = each.second;
            return found.verdict == Verdict::identical ||
                   (found.compared && found.comparison.same_size() && found.comparison.difference.ssim > kAlike);
        };
        if (std::ranges::all_of(result_.frames, is_alike)) result_.picture = Verdict::new_renderer;
        if (options_.add_digest) return;
        result_.picture_lines.push_back(fmt::format(
            "nothing is accepted yet of this renderer, {} (beamcam doctor); look at the picture, and --add-digest",
            renderer));
    }

    // What the baselines file is to say, when this entry changes it.
    std::optional<BaselineEdit> edit(const std::string& renderer) {
        BaselineEdit change{entry_.name, entry_.accepted, entry_.reproducible_until};
        if (references_.fresh) {
            change.accepted.clear();
            if (result_.picture && entry_.expected.empty()) change.accepted.push_back(digests(renderer));
            if (result_.motion) change.reproducible_until = horizon_;
            result_.updated = true;
            return change;
        }
        if (!entry_.expected.empty()) return std::nullopt;
        const bool added = options_.add_digest ? is_of_new_renderer_ || result_.picture == Verdict::equivalent
                                               : result_.picture == Verdict::new_renderer &&
                                                     options_.rule.new_renderer == NewRenderer::accept;
        if (!added) return std::nullopt;
        change.accepted.push_back(digests(renderer));
        result_.digest_added = true;
        return change;
    }

    // Digests of the new reference pictures by file name.
    std::map<std::string, std::string> new_pictures() const {
        std::map<std::string, std::string> all;
        for (const auto& [frame, found] : result_.frames) all[picture_name(frame)] = found.sha256;
        return all;
    }

  private:
    // A table of all channels holds an error of the solver, which no two solvers share.
    sim::Table without_residuals(const sim::Table& table) const {
        const auto* asked = std::get_if<TrajectoryOutput>(&entry_.output());
        if (!asked || !asked->channels.empty()) return table;
        sim::Table kept;
        for (std::size_t i = 0; i < table.channels.size(); ++i)
            if (table.channels[i].kind != sim::ChannelKind::energy_residual) {
                kept.channels.push_back(table.channels[i]);
                kept.values.push_back(table.values[i]);
            }
        return kept;
    }

    std::function<output::Target(const std::string& name)> fresh_files() const {
        return [this](const std::string& name) { return *references_.fresh / name; };
    }

    // What moved is in the report, for `beamcam accept`.
    void report_record(const RecordNames& names, const sim::Table& table, const std::vector<sim::Impact>& impacts,
                       double until) {
        if (!options_.report || *result_.motion <= Verdict::equivalent) return;
        write_record([&](const std::string& name) { return pictures_.report_file(name); }, names, table, impacts,
                     until);
    }

    // The rows up to `until`; the first one stays.
    static void cut(sim::Table& table, double until) {
        const std::vector<double>& t = table.values.front();
        const auto kept = std::max<std::ptrdiff_t>(1, std::upper_bound(t.begin(), t.end(), until) - t.begin());
        for (std::vector<double>& column : table.values) column.resize(static_cast<std::size_t>(kept));
    }

    void judge_record(const RecordNames& names, const std::string& label, const MotionRecord& actual, double horizon) {
        std::vector<std::string>& lines = result_.motion_lines;
        std::optional<MotionRecord> expected;
        references_.read([&] { expected = read_record(references_.folder, names); });
        if (!expected) {
            result_.motion = Verdict::missing;
            lines.push_back(fmt::format("{}no motion is kept in {}", label, references_.folder.string()));
            return;
        }
        if (const auto* asked = std::get_if<TrajectoryOutput>(&entry_.output()); asked && asked->channels.empty())
            remove_column(expected->table, "energy_residual");
        const MotionVerdict found = compare(*expected, actual, tolerance_, horizon);
        result_.motion = worse(*result_.motion, found.verdict);
        for (const std::string& line : found.lines) lines.push_back(label + line);
        for (const std::string& name : {names.table, names.impacts})
            if (!references_.is_as_marked(name)) {
                result_.motion = worse(*result_.motion, Verdict::different);
                lines.push_back(fmt::format("{} is not what --update put there", (references_.folder / name).string()));
            }
    }

    static void remove_column(output::NamedTable& table, std::string_view name) {
        const auto at = std::find(table.names.begin(), table.names.end(), name);
        if (at == table.names.end()) return;
        table.columns.erase(table.columns.begin() + (at - table.names.begin()));
        table.names.erase(at);
    }

    Accepted digests(const std::string& renderer) const {
        Accepted own{renderer, {}};
        for (const auto& [frame, found] : result_.frames) own.sha256.push_back(found.sha256);
        return own;
    }

    const Baseline& entry_;
    const RegressionOptions& options_;
    EntryResult& result_;
    ReferenceUpdate* update_;
    const Tolerance tolerance_;
    EntryReferences references_;
    EntryPictures pictures_;
    double horizon_ = 0;
    bool is_of_new_renderer_ = false;
};

// ---- entries that share one motion ----------------------------------------------------------------------

// Each entry has a plan of its own, so that its pictures do not depend on what else is tested; one integration answers
// the requests of all.
class Group {
  public:
    void add(EntryTest& test) { jobs_.push_back({&test, {}, 0, 0}); }

    void run(const RegressionOptions& options, RegressionResult& all) {
        std::erase_if(jobs_, [](Job& job) { return !job.test->attempt([&] { prepare(job); }); });
        if (jobs_.empty()) return;
        std::vector<sim::Request> requests;
        for (const Job& job : jobs_)
            for (sim::Request& request : requests_of(job.plan)) requests.push_back(std::move(request));
        std::vector<sim::Result> results;
        try {
            results = sim::simulate(problem(), requests, [](double) { return !output::interrupted(); });
        } catch (const sim::SolverError& error) {
            if (jobs_.size() == 1) return jobs_.front().test->make_impossible(describe(error));
            for (const Job& job : jobs_) {  // one that looks less far may come to its end
                Group alone;
                alone.add(*job.test);
                alone.run(options, all);
            }
            return;
        }
        ++all.simulations;
        auto next = results.begin();
        for (Job& job : jobs_) {
            const auto last = next + static_cast<std::ptrdiff_t>(requests_of(job.plan).size());
            const auto started = Clock::now();
            job.test->attempt([&] {
                judge(job, {std::make_move_iterator(next), std::make_move_iterator(last)}, options);
            });
            next = last;
            job.test->result().seconds = seconds_since(started);
            all.pictures += job.test->result().frames.size();
        }
    }

  private:
    struct Job {
        EntryTest* test = nullptr;
        Plan plan;
        std::size_t motion = 0;  // the table of the plan's request that is recorded
        double until = 0;        // the last instant that the entry looks at [s]
    };

    const sim::Problem& problem() const { return jobs_.front().test->entry().scene.problem; }

    static void prepare(Job& job) {
        const Scene& scene = job.test->entry().scene;
        job.plan = plan(scene);
        settle(job.plan, scene, [](const sim::Problem& some, const sim::Request& events) {
            return sim::simulate(some, events, [](double) { return !output::interrupted(); });
        });
        // A picture that compares other motions than the scene's own has no simulation of it, nor has a figure of
        // statics, behind which there is no motion at all.
        if (!job.plan.simulation) {
            job.plan.simulation.emplace();
            double& until = job.plan.simulation->request.end_time;
            for (const Pictures& p : job.plan.pictures) until = std::max(until, p.end_time);
            for (const Variant& v : job.plan.variants) until = std::max(until, v.simulation.request.end_time);
            if (job.plan.pictures.empty() && job.plan.variants.empty() && !job.plan.figures.empty())
                job.test->ask_for_no_motion();
        }
        sim::Request& request = job.plan.simulation->request;
        job.until = request.end_time;
        if (job.test->is_updated()) request.horizon = true;  // some figures ask for it anyway
        job.motion = request.tables.size();
        const auto table = std::ranges::find_if(job.plan.data, [](const DataFile& d) { return d.table.has_value(); });
        if (table != job.plan.data.end())
            job.motion = *table->table;
        else if (job.test->asks_for_motion())
            request.tables.push_back(motion_behind_picture(scene.problem, job.until));
        if (!job.test->asks_for_motion()) return;
        for (Pictures& p : job.plan.pictures)
            for (std::size_t i = 0; i < p.compared.size(); ++i) {
                ComparedMotion& other = p.compared[i];
                other.request.tables.push_back(job.test->motion_compared(i, other.problem, p.end_time));
                if (job.test->is_updated()) other.request.horizon = true;
            }
    }

    static void judge(Job& job, std::vector<sim::Result> results, const RegressionOptions& options) {
        const sim::Result& run = results.front();
        job.test->require_reproducible(run, job.until);
        if (job.test->asks_for_motion())
            job.test->judge_motion(run.tables[job.motion], run.impacts, job.until, run.reproducible_until);
        Capture capture{
            std::move(results),
            [&](const Pictures&, long frame, const render::Image& image) { job.test->judge_picture(frame, image); },
            [&](const render::Image& image) { job.test->judge_picture(0, image); },
            {}};
        if (job.test->asks_for_motion())
            capture.compared = [&](std::size_t picture, std::size_t index, const sim::Result& result) {
                const Pictures& shown = job.plan.pictures[picture];
                job.test->require_reproducible(result, shown.end_time);
                job.test->judge_compared(index, shown.compared[index].label, result.tables.back(), result.impacts,
                                         result.reproducible_until);
            };
        RunOptions run_options = options.run;
        run_options.no_cache = true;  // what is tested is what this program does now
        scenes::draw(job.plan, job.test->entry().scene, capture, run_options);
        job.test->finish();
    }

    std::vector<Job> jobs_;
};

// ---- all entries -----------------------------------------------------------------------------------------

class Regression {
  public:
    Regression(const std::string& path, const RegressionOptions& options)
        : path_(path), options_(options), baselines_(read_baselines(path)), report_files_(options.run.force) {
        if (path_ == "-") return;
        const std::string told = ReferenceUpdate::recover(baselines_.references);
        if (told.empty()) return;
        output::tell("{}: {}\n", path_, told);
        baselines_ = read_baselines(path);
    }

    RegressionResult go() {
        const auto started = Clock::now();
        result_.baselines = path_;
        if (path_ == "-" &&
            (!options_.update.empty() || options_.add_digest || options_.rule.new_renderer == NewRenderer::accept))
            throw UsageError("baselines from standard input cannot be changed; name the file");
        choose();
        run_groups();
        write_changes();
        report_files_.save();
        result_.seconds = seconds_since(started);
        return std::move(result_);
    }

  private:
    void choose() {
        const std::vector<const Baseline*> chosen =
            chosen_entries(baselines_, path_, options_.update.empty() ? options_.only : options_.update);
        result_.entries.resize(chosen.size());
        if (!options_.update.empty())
            update_ = std::make_unique<ReferenceUpdate>(path_, baselines_.references, options_.run.force);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            EntryResult& result = result_.entries[i];
            result.name = chosen[i]->name;
            if (!chosen[i]->problem.empty()) {
                refuse(result, chosen[i]->problem, kBadScene);
                continue;
            }
            try {
                tests_.push_back(std::make_unique<EntryTest>(baselines_, *chosen[i], options_, result, report_files_,
                                                             update_.get()));
            } catch (const output::IoError& error) {  // a damaged marker
                if (update_) throw;
                refuse(result, fmt::format("{}\n", error.what()), kInputOutput);
            }
        }
    }

    // There is no test for an entry that cannot be read.
    static void refuse(EntryResult& result, const std::string& problem, int exit_code) {
        output::tell("{}", problem);
        result.picture = Verdict::missing;
        result.picture_lines = {problem.substr(0, problem.find('\n'))};
        result.exit_code = exit_code;
    }

    // Side by side: as many threads as there are groups for, and those that are left draw.
    void run_groups() {
        std::vector<Group> all = groups();
        const auto count = static_cast<long>(all.size());
        const int threads = thread_count(options_.run.threads);
        RegressionOptions each = options_;
        each.run.threads = std::max(1, threads / static_cast<int>(std::max(1L, count)));
        std::mutex mutex;
        Gate gate;
        fan_out(
            count, threads,
            [&] {
                return [&](long k) {
                    RegressionResult counts;
                    all[static_cast<std::size_t>(k)].run(each, counts);
                    const std::lock_guard lock(mutex);
                    result_.simulations += counts.simulations;
                    result_.pictures += counts.pictures;
                };
            },
            gate);
        for (const auto& test : tests_)
            if (!test->entry().file.empty()) judge_file(*test);
    }

    void judge_file(EntryTest& test) {
        const auto started = Clock::now();
        test.attempt([&] {
            test.judge_file();
            test.finish();
        });
        test.result().seconds = seconds_since(started);
        result_.pictures += test.result().frames.size();
    }

    std::vector<Group> groups() {
        std::map<std::string, std::size_t> index;
        std::vector<Group> all;
        for (const auto& test : tests_) {
            if (!test->entry().file.empty()) continue;
            Scene physics = test->entry().scene;  // all that the motion depends on
            physics.outputs.clear();
            physics.title.clear();
            physics.end_time = 1;
            const auto [found, added] = index.emplace(to_json(physics), all.size());
            if (added) all.emplace_back();
            all[found->second].add(*test);
        }
        return all;
    }

    void write_changes() {
        std::vector<BaselineEdit> edits;
        std::map<std::string, RendererParts>& renderers = result_.renderers;
        std::map<Drawn, Fingerprint> known;
        for (const auto& test : tests_) {
            std::string id;
            const bool differs = test->result().picture > Verdict::identical && test->result().exit_code == 0;
            if (test->entry().has_pictures() && (test->is_updated() || differs)) {
                const Drawn how = drawn(test->entry());
                if (!known.contains(how)) known[how] = fingerprint_of(how);
                id = known[how].id();
                renderers[id] = known[how].parts;
            }
            test->result().renderer = id;
            test->judge_renderer(id);
            if (auto change = test->edit(id)) edits.push_back(std::move(*change));
        }
        if (edits.empty()) return;
        const std::string text = edited(baselines_, edits, renderers);
        if (update_)
            update_->commit(baselines_.source.text, text, new_pictures());
        else
            output::write_file(path_, text);
        result_.changed = true;
    }

    // Of each entry that is updated.
    std::map<std::string, std::map<std::string, std::string>> new_pictures() const {
        std::map<std::string, std::map<std::string, std::string>> all;
        for (const auto& test : tests_)
            if (test->is_updated()) all[test->entry().name] = test->new_pictures();
        return all;
    }

    std::string path_;
    const RegressionOptions& options_;
    Baselines baselines_;
    std::unique_ptr<ReferenceUpdate> update_;
    output::Manifest report_files_;
    RegressionResult result_;
    std::vector<std::unique_ptr<EntryTest>> tests_;
};

}  // namespace

double FrameResult::weight() const {
    if (verdict == Verdict::identical) return -1;
    if (!compared || !comparison.same_size()) return 1e300;
    return static_cast<double>(comparison.difference.changed) + comparison.difference.largest / 256.0;
}

bool PassRule::passes(Verdict verdict) const {
    switch (verdict) {
        case Verdict::identical:
            return true;
        case Verdict::equivalent:
            return !strict;
        case Verdict::new_renderer:
            return new_renderer != NewRenderer::fail;
        case Verdict::different:
        case Verdict::missing:
            break;
    }
    return false;
}

bool PassRule::passes(const EntryResult& entry) const {
    return passes(entry.picture.value_or(Verdict::identical)) && passes(entry.motion.value_or(Verdict::identical));
}

Verdict EntryResult::verdict() const {
    return worse(picture.value_or(Verdict::identical), motion.value_or(Verdict::identical));
}

const std::pair<const long, FrameResult>* EntryResult::worst() const {
    const std::pair<const long, FrameResult>* worst = nullptr;
    for (const auto& frame : frames)
        if (frame.second.verdict != Verdict::identical && (!worst || frame.second.weight() > worst->second.weight()))
            worst = &frame;
    return worst;
}

std::size_t EntryResult::frames_with(Verdict verdict) const {
    return static_cast<std::size_t>(
        std::count_if(frames.begin(), frames.end(), [verdict](const auto& f) { return f.second.verdict == verdict; }));
}

RegressionResult test_regression(const std::string& path, const RegressionOptions& options) {
    return Regression(path, options).go();
}

}  // namespace beamcam::scenes
