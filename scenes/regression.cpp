#include "scenes/regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <system_error>

#include "output/atomic_file.hpp"
#include "output/interrupt.hpp"
#include "output/manifest.hpp"
#include "output/png.hpp"
#include "output/png_reader.hpp"
#include "render/error.hpp"
#include "scenes/capture.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/fingerprint.hpp"
#include "scenes/motion_record.hpp"
#include "scenes/suggest.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

std::string picture_name(long frame) { return fmt::format("{:04}.png", frame); }

enum class Drawn { flat, lit, figure };

Drawn drawn(const Baseline& entry) {
    const auto by_style = [](const render::View& view) {
        return view.style == render::Style::flat ? Drawn::flat : Drawn::lit;
    };
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
    }
    throw std::logic_error("a way of drawing that has no fingerprint");
}

// ---- references ------------------------------------------------------------------------------------

// The new references of one entry: written beside the old ones, which they replace as a whole or not at all.
class NewReferences {
  public:
    explicit NewReferences(const fs::path& folder)
        : folder_(folder), fresh_(folder.string() + ".new"), old_(folder.string() + ".old") {
        std::error_code ignored;
        fs::remove_all(fresh_, ignored);
        output::ensure_directory(fresh_);
    }
    // Until `keep` everything can be taken back.
    ~NewReferences() {
        std::error_code ignored;
        fs::remove_all(fresh_, ignored);
        if (!swapped_ || kept_) return;
        fs::remove_all(folder_, ignored);
        if (fs::exists(old_, ignored)) fs::rename(old_, folder_, ignored);
    }
    NewReferences(const NewReferences&) = delete;
    NewReferences& operator=(const NewReferences&) = delete;

    const fs::path& folder() const { return fresh_; }

    void swap() {
        std::error_code error;
        fs::remove_all(old_, error);
        if (fs::exists(folder_, error)) fs::rename(folder_, old_, error);
        if (!error) fs::rename(fresh_, folder_, error);
        if (error) throw output::write_error(folder_, error.value());
        swapped_ = true;
    }
    void keep() {
        std::error_code ignored;
        fs::remove_all(old_, ignored);
        kept_ = true;
    }

  private:
    fs::path folder_, fresh_, old_;
    bool swapped_ = false, kept_ = false;
};

// ---- one entry ---------------------------------------------------------------------------------------

class EntryTest {
  public:
    EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options, EntryResult& result,
              output::Manifest& report_files)
        : entry_(entry),
          options_(options),
          result_(result),
          report_files_(report_files),
          tolerance_(entry.tolerance.overridden_by(options.tolerance)),
          folder_(baselines.references / entry.name) {
        result_.name = entry.name;
        if (entry.has_pictures()) result_.picture = Verdict::identical;
        if (entry.physics || !entry.has_pictures()) result_.motion = Verdict::identical;
        if (is_updated()) fresh_ = std::make_unique<NewReferences>(folder_);
    }

    const Baseline& entry() const { return entry_; }
    bool asks_for_motion() const { return result_.motion.has_value(); }
    void ask_for_no_motion() { result_.motion.reset(); }
    bool is_updated() const {
        return std::find(options_.update.begin(), options_.update.end(), entry_.name) != options_.update.end();
    }
    NewReferences* fresh() { return fresh_.get(); }
    EntryResult& result() { return result_; }

    void judge_motion(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until,
                      std::optional<double> reproducible_until) {
        if (fresh_) {
            write_record(fresh_->folder(), table, impacts, until);
            horizon_ = std::min(until, reproducible_until.value_or(until));
        }
        const auto expected = read_record(folder_);
        if (!expected) {
            result_.motion = Verdict::missing;
            result_.motion_lines = {fmt::format("no motion is kept in {}", folder_.string())};
            return;
        }
        const MotionVerdict found =
            compare(*expected, record_of(table, impacts, until), tolerance_, entry_.reproducible_until.value_or(until));
        result_.motion = found.verdict;
        result_.motion_lines = found.lines;
    }

    // From any thread.
    void judge_picture(long frame, const render::Image& image) {
        thread_local output::Raster raster;
        output::to_raster(image, raster);
        FrameResult found;
        found.sha256 = output::digest(raster);
        if (!is_accepted(frame, found.sha256)) compare_with_reference(frame, raster, found);
        if (fresh_) output::write_png(fresh_->folder() / picture_name(frame), image, {}, output::Durability::buffered);
        const std::lock_guard lock(mutex_);
        result_.frames[frame] = std::move(found);
    }

    void finish() {
        if (result_.picture) conclude_pictures();
    }

    void make_impossible(const std::string& why) {
        if (result_.picture) result_.picture = Verdict::different;
        if (result_.motion) result_.motion = Verdict::different;
        (result_.motion ? result_.motion_lines : result_.picture_lines) = {why};
        fresh_.reset();
    }

    // What the baselines file is to say, when this entry changes it.
    std::optional<BaselineEdit> edit(const std::string& renderer) {
        BaselineEdit change{entry_.name, entry_.accepted, entry_.reproducible_until};
        if (fresh_) {
            change.accepted.clear();
            if (result_.picture) change.accepted.push_back(digests(renderer));
            if (result_.motion) change.reproducible_until = horizon_;
            result_.updated = true;
            return change;
        }
        if (!options_.add_digest || result_.picture != Verdict::equivalent) return std::nullopt;
        change.accepted.push_back(digests(renderer));
        result_.digest_added = true;
        return change;
    }

  private:
    bool is_accepted(long frame, const std::string& digest) const {
        return std::any_of(entry_.accepted.begin(), entry_.accepted.end(), [&](const Accepted& accepted) {
            const auto at = static_cast<std::size_t>(frame);
            return at < accepted.sha256.size() && accepted.sha256[at] == digest;
        });
    }

    void compare_with_reference(long frame, const output::Raster& actual, FrameResult& found) {
        found.verdict = entry_.accepted.empty() ? Verdict::missing : Verdict::different;
        const fs::path reference = folder_ / picture_name(frame);
        std::error_code error;
        if (fs::exists(reference, error)) {
            const output::Raster expected = output::read_png(reference);
            found.expected = reference;
            found.compared = true;
            found.comparison = compare(expected, actual, tolerance_.channel.value_or(0));
            if (found.comparison.same_size() && !entry_.accepted.empty())
                found.verdict = found.comparison.difference.share() <= tolerance_.share.value_or(0)
                                    ? Verdict::equivalent
                                    : Verdict::different;
            write_difference(frame, expected, actual, found);
        } else {
            write_actual(frame, actual, found);
        }
    }

    void write_actual(long frame, const output::Raster& actual, FrameResult& found) {
        if (!options_.report) return;
        found.actual = put(frame, "actual", actual);
    }
    void write_difference(long frame, const output::Raster& expected, const output::Raster& actual,
                          FrameResult& found) {
        if (!options_.report) return;
        found.actual = put(frame, "actual", actual);
        if (!found.comparison.same_size()) return;
        const int threshold = found.comparison.difference.changed > 0 ? tolerance_.channel.value_or(0) : 0;
        found.difference = put(frame, "difference", output::difference_picture(expected, actual, threshold));
    }
    fs::path put(long frame, const char* what, const output::Raster& picture) {
        fs::path file = *options_.report / entry_.name / fmt::format("{:04}-{}.png", frame, what);
        const std::string bytes = output::encode_png(output::to_image(picture));
        output::require_within(file, *options_.report);
        output::ensure_directory(file.parent_path());
        output::Target target = report_files_.target(file);
        target.within = *options_.report;
        output::write_file(target, bytes, output::Durability::buffered);
        return file;
    }

    void conclude_pictures() {
        Verdict verdict = Verdict::identical;
        for (const auto& [frame, found] : result_.frames) verdict = worse(verdict, found.verdict);
        if (entry_.accepted.empty()) {
            result_.picture_lines = {
                fmt::format("no digest is accepted yet; look at the picture and --update {}", entry_.name)};
            verdict = Verdict::missing;
        } else if (const std::size_t count = entry_.accepted.front().sha256.size(); count != result_.frames.size()) {
            result_.picture_lines = {
                fmt::format("{} pictures were expected, {} were drawn", count, result_.frames.size())};
            verdict = Verdict::different;
        } else if (const auto* worst = result_.worst()) {
            result_.picture_lines = {in_words(*worst)};
        }
        result_.picture = verdict;
        for (const auto& [frame, found] : result_.frames) {
            if (found.verdict == Verdict::identical) continue;
            result_.new_digest = found.sha256;
            const auto at = static_cast<std::size_t>(frame);
            if (!entry_.accepted.empty() && at < entry_.accepted.front().sha256.size())
                result_.old_digest = entry_.accepted.front().sha256[at];
            break;
        }
    }

    std::string in_words(const std::pair<const long, FrameResult>& worst) const {
        const std::size_t changed = result_.frames.size() - result_.frames_with(Verdict::identical);
        const std::string which = result_.frames.size() > 1
                                      ? fmt::format("{} of {} pictures changed, most number {}: ", changed,
                                                    result_.frames.size(), worst.first)
                                      : "";
        if (!worst.second.compared)
            return which + fmt::format("the reference {} is not there", (folder_ / picture_name(worst.first)).string());
        if (worst.second.comparison.same_size() && worst.second.comparison.difference.identical())
            return which + "the reference picture has these pixels, but their digest is not among the accepted";
        return which + scenes::in_words(worst.second.comparison);
    }

    Accepted digests(const std::string& renderer) const {
        Accepted own{renderer, {}};
        for (const auto& [frame, found] : result_.frames) own.sha256.push_back(found.sha256);
        return own;
    }

    const Baseline& entry_;
    const RegressionOptions& options_;
    EntryResult& result_;
    output::Manifest& report_files_;
    Tolerance tolerance_;
    fs::path folder_;
    std::unique_ptr<NewReferences> fresh_;
    double horizon_ = 0;
    std::mutex mutex_;  // of result_.frames
};

// ---- entries that share one motion ----------------------------------------------------------------------

// Each entry has a plan of its own, so that its pictures do not depend on what else is tested; one integration answers
// the requests of all.
class Group {
  public:
    void add(EntryTest& test) { jobs_.push_back({&test, {}, 0, 0}); }

    void run(const RegressionOptions& options, RegressionResult& all) {
        std::vector<sim::Result> results;
        try {
            std::vector<sim::Request> requests;
            for (Job& job : jobs_) {
                prepare(job);
                for (sim::Request& request : requests_of(job.plan)) requests.push_back(std::move(request));
            }
            results = sim::simulate(problem(), requests, [](double) { return !output::interrupted(); });
        } catch (const sim::SolverError& error) {
            return fail(fmt::format("the solver failed at {:.6g} s: {}", error.last_time, error.what()));
        } catch (const render::PictureError& error) {  // such as an impact that there is no more
            return fail(error.what());
        }
        ++all.simulations;
        auto next = results.begin();
        for (Job& job : jobs_) {
            const auto last = next + static_cast<std::ptrdiff_t>(requests_of(job.plan).size());
            judge(job, {std::make_move_iterator(next), std::make_move_iterator(last)}, options);
            next = last;
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

    void fail(const std::string& why) {
        for (Job& job : jobs_) job.test->make_impossible(why);
    }

    const sim::Problem& problem() const { return jobs_.front().test->entry().scene.problem; }

    static void prepare(Job& job) {
        const Scene& scene = job.test->entry().scene;
        job.plan = plan(scene);
        settle(job.plan, scene, [](const sim::Problem& some, double until) {
            sim::Request only_impacts;
            only_impacts.end_time = until;
            return sim::simulate(some, only_impacts, [](double) { return !output::interrupted(); });
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
        if (!job.plan.tables.empty())
            job.motion = job.plan.tables.front().table;
        else if (job.test->asks_for_motion())
            request.tables.push_back(motion_behind_picture(scene.problem, job.until));
    }

    static void judge(Job& job, std::vector<sim::Result> results, const RegressionOptions& options) {
        const sim::Result& run = results.front();
        if (job.test->asks_for_motion())
            job.test->judge_motion(run.tables[job.motion], run.impacts, job.until, run.reproducible_until);
        Capture capture{
            std::move(results),
            [&](const Pictures&, long frame, const render::Image& image) { job.test->judge_picture(frame, image); },
            [&](const render::Image& image) { job.test->judge_picture(0, image); },
            {}};
        RunOptions run_options = options.run;
        run_options.no_cache = true;  // what is tested is what this program does now
        try {
            scenes::draw(job.plan, job.test->entry().scene, capture, run_options);
        } catch (const sim::SolverError& error) {  // of a variant of the scene that a figure compares it with
            return job.test->make_impossible(
                fmt::format("the solver failed at {:.6g} s: {}", error.last_time, error.what()));
        } catch (const render::PictureError& error) {  // such as a figure of an impact that there is no more
            return job.test->make_impossible(error.what());
        }
        job.test->finish();
    }

    std::vector<Job> jobs_;
};

// ---- all entries -----------------------------------------------------------------------------------------

class Regression {
  public:
    Regression(const std::string& path, const RegressionOptions& options)
        : path_(path), options_(options), baselines_(read_baselines(path)), report_files_(options.run.force) {}

    RegressionResult go() {
        const auto started = std::chrono::steady_clock::now();
        if (path_ == "-" && (!options_.update.empty() || options_.add_digest))
            throw UsageError("baselines from standard input cannot be changed; name the file");
        choose();
        for (Group& group : groups()) group.run(options_, result_);
        write_changes();
        report_files_.save();
        result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
        return std::move(result_);
    }

  private:
    void choose() {
        std::vector<std::string> known;
        for (const Baseline& entry : baselines_.entries) known.push_back(entry.name);
        const std::vector<std::string>& names = options_.update.empty() ? options_.only : options_.update;
        for (const std::string& name : names)
            if (std::find(known.begin(), known.end(), name) == known.end())
                throw UsageError(
                    fmt::format("{} has no entry {}{}", path_, in_quotes(name), suggestion_or_list(name, known)));
        std::vector<const Baseline*> chosen;
        for (const Baseline& entry : baselines_.entries)
            if (names.empty() || std::find(names.begin(), names.end(), entry.name) != names.end())
                chosen.push_back(&entry);
        result_.entries.resize(chosen.size());
        for (std::size_t i = 0; i < chosen.size(); ++i)
            tests_.push_back(
                std::make_unique<EntryTest>(baselines_, *chosen[i], options_, result_.entries[i], report_files_));
    }

    std::vector<Group> groups() {
        std::map<std::string, std::size_t> index;
        std::vector<Group> all;
        for (const auto& test : tests_) {
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
        std::map<std::string, RendererParts> renderers;
        std::map<Drawn, Fingerprint> known;
        for (const auto& test : tests_) {
            std::string id;
            if (test->entry().has_pictures() && (test->fresh() || options_.add_digest)) {
                const Drawn how = drawn(test->entry());
                if (!known.contains(how)) known[how] = fingerprint_of(how);
                id = known[how].id();
                renderers[id] = known[how].parts;
            }
            if (auto change = test->edit(id)) edits.push_back(std::move(*change));
        }
        if (edits.empty()) return;
        // All or nothing: the folders go back to what they were if the file cannot be written.
        const std::string text = edited(baselines_, edits, renderers);
        for (const auto& test : tests_)
            if (test->fresh()) test->fresh()->swap();
        output::write_file(path_, text);
        for (const auto& test : tests_)
            if (test->fresh()) test->fresh()->keep();
        result_.changed = true;
    }

    std::string path_;
    const RegressionOptions& options_;
    Baselines baselines_;
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
