#include "scenes/outputs/run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "output/data/manifest.hpp"
#include "output/data/records.hpp"
#include "output/data/tables.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/interrupt.hpp"
#include "output/files/standard_output.hpp"
#include "output/files/work.hpp"
#include "output/film/palette.hpp"
#include "output/film/video.hpp"
#include "output/image/png.hpp"
#include "render/base/error.hpp"
#include "render/film/film.hpp"
#include "render/gl/gl_environment.hpp"
#include "scenes/figures/make.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/motions.hpp"
#include "scenes/motions/spooled.hpp"
#include "scenes/outputs/demand.hpp"
#include "scenes/plan/estimate.hpp"
#include "scenes/plan/survey.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

std::string counted(std::size_t n, std::string_view thing) {
    return fmt::format("{} {}{}", n, thing, n == 1 ? "" : "s");
}

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

bool is_stdout(const std::string& file) { return file == "-"; }

// One significant digit as people write it: 10⁻⁸, 2 × 10⁻⁹.
std::string power_of_ten(double value) {
    static constexpr std::string_view kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const std::string text = fmt::format("{:.0e}", value);  // "2e-09"
    const std::string mantissa = text.substr(0, text.find('e'));
    std::string out = mantissa == "1" ? "10" : mantissa + " × 10";
    const int exponent = std::stoi(text.substr(text.find('e') + 1));
    if (exponent < 0) out += "⁻";
    for (const char digit : std::to_string(std::abs(exponent))) out += kDigits[digit - '0'];
    return out;
}

// Where the time went, for -v.
struct Times {
    double simulate = 0, draw = 0, read_back = 0, convert = 0, encode = 0,
           write = 0;  // [s]; drawing summed over threads
    int threads = 0;   // that drew
};

void stop_if_interrupted() {
    if (output::interrupted()) throw Stopped();
}

// What the runners of one call share.
struct Shop {
    explicit Shop(const RunOptions& wanted)
        : options(wanted),
          progress(resolve(wanted.progress)),
          manifest(wanted.force),
          cache(open_cache(wanted.no_cache)),
          history(cache ? History(cache->directory()) : History()),
          motions(kept(), &history, progress, {thread_count(wanted.threads), wanted.quiet, wanted.verbose}) {}

    const Cache* kept() const { return cache ? &*cache : nullptr; }

    const RunOptions& options;
    Progress progress;
    output::Manifest manifest;
    std::optional<Cache> cache;
    History history;
    Motions motions;
    output::Work work;
    Times times;
    std::size_t refused = 0;  // outputs that cannot be made
    Clock::time_point started = Clock::now();
};

// Rows that a failed run never reached hold nothing, not even their time.
sim::Table reached_rows(const sim::Table& table) {
    sim::Table reached{table.channels, std::vector<std::vector<double>>(table.values.size())};
    for (std::size_t row = 0; row < table.rows(); ++row) {
        if (std::ranges::all_of(table.values, [&](const auto& column) { return std::isnan(column[row]); })) continue;
        for (std::size_t c = 0; c < table.values.size(); ++c) reached.values[c].push_back(table.values[c][row]);
    }
    return reached;
}

// Makes the outputs of one scene.
class Runner {
  public:
    Runner(const Scene& scene, Shop& shop)
        : scene_(scene),
          options_(shop.options),
          shop_(shop),
          found_(survey(scene, options_.ask, options_.directory, shop.manifest, shop.kept(), options_.force)),
          plan_(plan(scene, options_.ask, found_.known)),
          progress_(shop.progress),
          manifest_(shop.manifest),
          times_(shop.times),
          work_(shop.work) {}

    // Draws for a command that compares: the same pixels, but no files.
    Runner(Plan made, const Scene& scene, Capture& capture, Shop& shop)
        : scene_(scene),
          options_(shop.options),
          shop_(shop),
          capture_(&capture),
          plan_(std::move(made)),
          progress_(shop.progress),
          manifest_(shop.manifest),
          times_(shop.times),
          work_(shop.work) {}
    void hand_over() {
        ask_for_others();
        shop_.motions.make();
        take(plan_.simulation ? std::move(capture_->results) : std::vector<sim::Result>());
        for (std::size_t i = 0; i < plan_.pictures.size() && capture_->compared; ++i)
            for (std::size_t k = 0; k < compared_[i].size(); ++k) capture_->compared(i, k, compared_[i][k]);
        for (std::size_t i = 0; i < plan_.figures.size(); ++i)
            capture_->figure(figure_image(figure(i), figure_output(plan_.figures[i])));
        for (std::size_t i = 0; i < plan_.pictures.size(); ++i) draw(i);
    }

    // All that can be refused before any work.
    void prepare() {
        tell_left();
        recover();
        claim_files();
        require_encoder();
    }

    // Slow motion and pictures of impacts ask where the impacts are, before anything else can be asked. `far`: until
    // when the scene's motion is wanted.
    void find_impacts(double far) {
        if (!plan_.impacts_until) return;
        const auto start = Clock::now();
        settle(
            plan_, scene_,
            [&](const sim::Problem& problem, double until) {
                sim::Request request;
                request.end_time = until;
                request.turning_points = false;
                return shop_.motions.find(problem, request, &problem == &scene_.problem ? far : until);
            },
            [&](const Pictures& p, const std::string& why) { refuse(p.output, why); });
        times_.simulate += seconds_since(start);
        claim_files();  // now that the number of frames is known
    }

    const Plan& planned() const { return plan_; }
    const std::string& motion() const { return found_.motion; }

    // What this scene wants of its own motion and of others.
    void ask() {
        if (plan_.simulation) {
            std::vector<sim::Request> requests = requests_of(plan_);
            for (const Pictures& p : plan_.pictures)
                own_poses_.push_back(p.compared.empty() ? keep_apart(requests.front(), p.poses, p.survey) : Kept{});
            own_ = shop_.motions.want(scene_.problem, std::move(requests));
        }
        ask_for_others();
    }
    void take() { take(own_ ? shop_.motions.take(*own_) : std::vector<sim::Result>()); }

    // Every file; the summaries last, because they tell of the work.
    void deliver() {
        write_tables();
        write_impacts();
        write_figures();
        for (std::size_t i = 0; i < plan_.pictures.size(); ++i) attempt(plan_.pictures[i].output, [&] { draw(i); });
        write_summaries();
    }

    // A picture that cannot be drawn costs its own output alone.
    void attempt(std::size_t output, const std::function<void()>& work) {
        try {
            work();
        } catch (const render::PictureError& error) {
            refuse(output, error.what());
        }
    }
    void refuse(std::size_t output, const std::string& why) {
        progress_.end();
        const bool listed = output < scene_.output_places.size();
        output::tell("beamcam: {}: {}: {}\n", listed ? scene_.output_places[output] : scene_.name,
                     file_of(scene_.outputs[output]), why);
        ++shop_.refused;
    }

    // What a failed run reached is worth looking at, under a name that no script takes for the result.
    void keep_partial_tables() {
        if (!own_ || shop_.motions.reached(*own_).empty()) return;
        const sim::Result& partial = shop_.motions.reached(*own_).front();
        for (const TableFile& t : plan_.tables) {
            if (is_stdout(t.file) || t.table >= partial.tables.size() || partial.tables[t.table].rows() == 0) continue;
            fs::path file = path_of(t.file);
            file.replace_extension(".partial.csv");
            output::write_csv(target_of(file, {}), reached_rows(partial.tables[t.table]));
            wrote(file, "as far as the solver came");
        }
    }

    // Files that will be written. Of sequences, the frames that are missing.
    std::vector<fs::path> files() const {
        std::vector<fs::path> all;
        for (const Pictures& p : plan_.pictures)
            if (p.kind == Pictures::Kind::frames && !p.settled)
                all.push_back(path_of(numbered_file(p.file, 0)));  // at least one, also before it is known
            else if (p.kind == Pictures::Kind::frames)
                for (int k : p.draw) all.push_back(path_of(numbered_file(p.file, p.first_frame + k)));
            else
                for (fs::path& file : made_of(p)) all.push_back(std::move(file));
        for (const FigureFile& f : plan_.figures)
            for (const std::string& file : files_of(figure_output(f))) all.push_back(path_of(file));
        const auto add = [&](const auto& list) {
            for (const auto& each : list)
                if (!is_stdout(each.file)) all.push_back(path_of(each.file));
        };
        add(plan_.tables);
        add(plan_.impacts);
        add(plan_.summaries);
        return all;
    }

  private:
    // Variants of the scene that figures look at, and motions that pictures compare.
    void ask_for_others() {
        for (const FigureFile& f : plan_.figures)
            for (const Study& study : f.studies)
                if (!study.of_scene)
                    others_.push_back(shop_.motions.want(study.problem, {study.request}, f.file, study.may_fail));
        for (const Pictures& p : plan_.pictures) {
            compared_poses_.emplace_back();
            for (const ComparedMotion& each : p.compared) {
                sim::Request request = each.request;
                compared_poses_.back().push_back(keep_apart(request, 0, 1));
                others_.push_back(
                    shop_.motions.want(each.problem, {std::move(request)}, fmt::format("{}, {}", p.file, each.label)));
            }
        }
    }

    // Where the poses of a picture go, so that they are not held.
    struct Kept {
        std::shared_ptr<SpooledPoses> frames;
        std::shared_ptr<SurveyedPoses> survey;
    };
    static std::shared_ptr<SurveyedPoses> stored(const std::vector<sim::Pose>& held, const sim::PoseRequest& request) {
        auto poses = std::make_shared<SurveyedPoses>(request.times.size(), request.contacts, request.stations);
        for (std::size_t row = 0; row < held.size(); ++row) poses->put(row, held[row]);
        return poses;
    }
    static Kept keep_apart(sim::Request& request, std::size_t frames, std::size_t survey) {
        sim::PoseRequest &all = request.poses[frames], &some = request.poses[survey];
        Kept kept{std::make_shared<SpooledPoses>(all.times.size(), all.stations),
                  std::make_shared<SurveyedPoses>(some.times.size(), some.contacts, some.stations)};
        all.take = [to = kept.frames](std::size_t row, const sim::Pose& pose) { to->put(row, pose); };
        some.take = [to = kept.survey](std::size_t row, const sim::Pose& pose) { to->put(row, pose); };
        return kept;
    }

    // The results in the order of the requests.
    void take(std::vector<sim::Result> own) {
        auto next = own.begin();
        auto other = others_.begin();
        const auto take_other = [&] { return std::move(shop_.motions.take(*other++).front()); };
        if (plan_.simulation) {
            result_ = std::move(*next++);
            for (std::size_t i = 0; i < plan_.simulation->ends.size(); ++i) ends_.push_back(std::move(*next++));
        }
        for (const FigureFile& f : plan_.figures) {
            of_figures_.emplace_back();
            for (const Study& study : f.studies)
                of_figures_.back().push_back(study.of_scene ? std::move(*next++) : take_other());
        }
        for (const Pictures& p : plan_.pictures) {
            compared_.emplace_back();
            for (std::size_t i = 0; i < p.compared.size(); ++i) compared_.back().push_back(take_other());
        }
    }

    void tell_left() {
        for (std::size_t output : found_.known.finished) {
            const std::string& file = file_of(scene_.outputs[output]);
            ++work_.files_left;
            if (!options_.quiet)
                output::tell("left {} as it is: made from the same inputs (--force makes it anew)\n",
                             path_of(file).string());
        }
        for (const auto& [output, frames] : found_.known.frames) {
            work_.frames_left += static_cast<long>(frames.size());
            if (!options_.quiet)
                output::tell("left {} frames of {} as they are: made from the same inputs\n", frames.size(),
                             path_of(file_of(scene_.outputs[output])).string());
        }
    }

    // ---- files -----------------------------------------------------------------------------

    fs::path path_of(const std::string& file) const { return place_of(options_.directory, file); }

    // Refuses before any work what would be refused after it.
    void claim_files() {
        const std::vector<fs::path> claimed = files();
        for (const fs::path& file : claimed) {
            std::error_code ignored;
            if (fs::is_directory(file, ignored))
                throw output::IoError(
                    fmt::format("{} is a directory; choose another name for the output", file.string()));
            const fs::path folder = file.parent_path();
            if (options_.directory.empty() && !folder.empty() && !fs::is_directory(folder, ignored))
                throw output::IoError(
                    fmt::format("{}: there is no directory {}; make it first", file.string(), folder.string()));
            if (!options_.directory.empty()) output::require_within(file, options_.directory);
            manifest_.require_replaceable(file);
        }
        if (!options_.directory.empty())
            for (const fs::path& file : claimed) output::ensure_directory(file.parent_path());
    }

    // What runs that were killed have left where this scene's files are, finished or not.
    void recover() {
        std::set<fs::path> folders;
        for (const Output& output : scene_.outputs)
            if (!is_stdout(file_of(output))) folders.insert(path_of(file_of(output)).parent_path());
        for (const fs::path& folder : folders) manifest_.recover(folder);
    }

    output::Target target_of(const fs::path& file, const std::string& inputs) const {
        output::Target target = manifest_.target(file, origin(file, inputs));
        target.within = options_.directory;
        return target;
    }

    void wrote(const fs::path& file, const std::string& what) {
        note_written(file);
        progress_.end();
        if (!options_.quiet) output::tell("wrote {}{}\n", file.string(), what.empty() ? "" : " (" + what + ")");
    }

    void note_written(const fs::path& file) {
        std::error_code ignored;
        ++work_.files_written;
        work_.bytes_written += static_cast<long>(fs::file_size(file, ignored));
    }

    output::Origin origin(const fs::path& file, const std::string& inputs) const {
        // Most pictures and films carry their scene inside.
        static constexpr std::string_view kSilent[] = {".csv", ".npz", ".json", ".gif", ".apng", ".webp"};
        if (std::find(std::begin(kSilent), std::end(kSilent), file.extension().string()) == std::end(kSilent))
            return {inputs, {}, {}};
        return {inputs, std::string(kVersion), to_json(scene_)};
    }

    // What this took, for the plans of later runs.
    void note(const std::vector<std::string>& work, double units, Clock::time_point since,
              const std::vector<fs::path>& made) {
        double bytes = 0;
        for (const fs::path& file : made) {
            std::error_code gone;
            const std::uintmax_t size = fs::file_size(file, gone);
            if (!gone) bytes += static_cast<double>(size);
        }
        shop_.history.note(work, units, seconds_since(since), bytes);
    }
    std::vector<fs::path> made_of(const Pictures& p) const {
        std::vector<fs::path> all;
        if (p.kind != Pictures::Kind::frames) {
            all.push_back(path_of(p.file));
            if (!p.poster_file.empty() && (!p.settled || p.makes_poster())) all.push_back(path_of(p.poster_file));
            return all;
        }
        for (int k : p.draw) all.push_back(path_of(numbered_file(p.file, p.first_frame + k)));
        return all;
    }

    std::map<std::string, std::string> metadata(const Pictures& p) const {
        const std::string note = accuracy_note(p);
        std::map<std::string, std::string> all = {{"Software", fmt::format("beamcam {}", kVersion)},
                                                  {"beamcam-scene", to_json(scene_)},
                                                  {"beamcam-accuracy", note}};
        if (!scene_.title.empty()) all["Title"] = scene_.title;
        return all;
    }

    // What a film's players show, in the keys that MP4 knows.
    std::map<std::string, std::string> film_metadata(const Pictures& p) const {
        std::map<std::string, std::string> all = {{"comment", fmt::format("made by beamcam {}", kVersion)},
                                                  {"beamcam-scene", to_json(scene_)},
                                                  {"beamcam-version", std::string(kVersion)},
                                                  {"beamcam-accuracy", accuracy_note(p)}};
        if (!p.part.empty()) all["beamcam-frames"] = p.part;
        if (!scene_.title.empty()) all["title"] = scene_.title;
        return all;
    }

    // "rtol 10⁻⁸ · energy closes to 2 × 10⁻⁹ · bends beyond first-order"
    std::string accuracy_note(const Pictures& p) const { return accuracy_note(scene_.problem, seen_by(p)); }
    static std::string accuracy_note(const sim::Problem& problem, const sim::Result& result) {
        std::string note = fmt::format("rtol {}", power_of_ten(problem.solver.rtol));
        if (result.energy_scale > 0 && result.energy_residual_max > 0)
            note +=
                fmt::format(" · energy closes to {}", power_of_ten(result.energy_residual_max / result.energy_scale));
        if (result.beyond_model) note += fmt::format(" · bends beyond {}", sim::name(problem.beam.model));
        return note;
    }

    // The run as if it had ended with these pictures.
    const sim::Result& seen_by(const Pictures& p) const { return p.until ? ends_.at(*p.until) : result_; }

    // ---- stages ----------------------------------------------------------------------------

    output::VideoOptions video_options(const Pictures& p) const {
        output::VideoOptions video;
        video.width = p.picture.size.width;
        video.height = p.picture.size.height;
        video.fps = p.span.fps.value();
        video.codec = p.encoding.codec;
        video.transparent = p.picture.view.transparent;
        video.crf = p.encoding.crf;
        video.preset = p.encoding.preset;
        video.variable_rate = p.encoding.variable_rate && p.part.empty();
        if (video.codec == output::Codec::gif) video.palette = {0xffffffff};
        return video;
    }

    // A film of each codec is opened and dropped, so that a missing encoder is told before anything is computed.
    void require_encoder() {
        std::set<output::Codec> tried;
        for (const Pictures& p : plan_.pictures)
            if (p.kind == Pictures::Kind::video && tried.insert(p.encoding.codec).second) {
                const output::VideoWriter trial(target_of(path_of(p.file), {}), video_options(p));
                work_.encoder_modules = 1;
                ++work_.encoders;
            }
    }

    void write_tables() {
        for (const TableFile& t : plan_.tables) {
            stop_if_interrupted();
            const sim::Table& table = result_.tables[t.table];
            const auto start = Clock::now();
            if (is_stdout(t.file)) {
                output::write_csv(std::cout, table);
                output::flush_data();
            } else {
                output::write_table(target_of(path_of(t.file), inputs_of(t)), table);
                wrote(path_of(t.file), fmt::format("{} rows", table.rows()));
                note(table_work(t), static_cast<double>(table.rows() * table.channels.size()), start,
                     {path_of(t.file)});
            }
            times_.write += seconds_since(start);
        }
    }

    template <class File>
    const std::string& inputs_of(const File& file) const {
        return found_.inputs[file.output];
    }

    const FigureOutput& figure_output(const FigureFile& f) const {
        return std::get<FigureOutput>(scene_.outputs[f.output]);
    }

    render::figure::Figure figure(std::size_t i) {
        Results results;
        for (const sim::Result& result : of_figures_[i]) results.push_back(&result);
        return plan_.figures[i].make(results);
    }

    void write_figures() {
        for (std::size_t i = 0; i < plan_.figures.size(); ++i)
            attempt(plan_.figures[i].output, [&] { write_figure(i); });
    }

    void write_figure(std::size_t i) {
        stop_if_interrupted();
        const auto begun = Clock::now();
        const FigureFile& f = plan_.figures[i];
        const FigureOutput& how = figure_output(f);
        for (const auto& [file, bytes] : figure_files(figure(i), how, scene_of_figure(scene_, how))) {
            output::write_file(target_of(path_of(file), inputs_of(f)), bytes);
            wrote(path_of(file), file == how.file ? f.figure : "");
        }
        note(figure_work(f), 1, begun, {path_of(f.file)});
        ++work_.figures_drawn;
        ++work_.font_sets;
        times_.write += seconds_since(begun);
    }

    void write_impacts() {
        for (const ImpactsFile& i : plan_.impacts) {
            if (is_stdout(i.file)) {
                output::print_json(output::impacts_json(result_));
            } else {
                output::write_impacts(target_of(path_of(i.file), inputs_of(i)), result_);
                wrote(path_of(i.file), fmt::format("{} in {}", counted(result_.impacts.size(), "impact"),
                                                   counted(result_.collisions.size(), "collision")));
            }
        }
    }

    void write_summaries() {
        for (const SummaryFile& s : plan_.summaries) {
            const std::vector<sim::Channel>& extrema = plan_.simulation->request.extrema;
            if (is_stdout(s.file)) {
                output::print_json(output::summary_json(scene_.problem, result_, extrema, &work_));
            } else {
                output::write_summary(target_of(path_of(s.file), inputs_of(s)), scene_.problem, result_, extrema,
                                      &work_);
                wrote(path_of(s.file), result_.reproducibility);
            }
        }
    }

    render::Film film_of(std::size_t index) {
        const Pictures& p = plan_.pictures[index];
        render::FilmSetup setup;
        setup.title = scene_.title;
        setup.width = p.picture.size.width;
        setup.height = p.picture.size.height;
        setup.view = p.picture.view;
        setup.layout = p.picture.layout;
        setup.comparison = p.picture.comparison;
        if (p.kind != Pictures::Kind::still) setup.fps = p.span.fps.value();
        setup.speeds = p.speeds;
        setup.slow_motion = is_slow_motion(p);
        setup.callouts = p.callouts;
        if (p.compared.empty()) {
            static_cast<render::Motion&>(setup) = motion_of(scene_.problem, result_, p.poses, p.chart, p.trace);
            if (own_poses_.empty())
                setup.survey = stored(result_.poses[p.survey], plan_.simulation->request.poses[p.survey]);
            else
                setup.stored = own_poses_[index].frames, setup.survey = own_poses_[index].survey;
            setup.accuracy_note = accuracy_note(p);
            setup.impacts = seen_by(p).impacts;
        } else {
            add_compared(index, setup);
        }
        return render::Film(std::move(setup));
    }

    static render::Motion motion_of(const sim::Problem& problem, sim::Result& result, std::size_t poses,
                                    std::size_t chart, std::optional<std::size_t> trace) {
        render::Motion motion;
        motion.problem = problem;
        motion.poses = std::move(result.poses[poses]);
        motion.chart = std::move(result.tables[chart]);
        if (trace) motion.trace = std::move(result.tables[*trace]);
        motion.impacts = result.impacts;
        return motion;
    }

    // The least accurate motion speaks for the picture.
    void add_compared(std::size_t index, render::FilmSetup& setup) {
        const Pictures& p = plan_.pictures[index];
        double worst = -1;
        std::string beyond;
        for (std::size_t i = 0; i < p.compared.size(); ++i) {
            const ComparedMotion& each = p.compared[i];
            sim::Result& result = compared_[index][i];
            const double share = result.energy_scale > 0 ? result.energy_residual_max / result.energy_scale : 0;
            if (share > worst) worst = share, setup.accuracy_note = accuracy_note(each.problem, result);
            if (result.beyond_model) beyond = fmt::format(" · bends beyond {}", sim::name(each.problem.beam.model));
            render::Motion motion =
                motion_of(each.problem, result, 0, 0, each.problem.cam ? std::optional<std::size_t>(1) : std::nullopt);
            motion.label = each.label;
            motion.stored = compared_poses_[index][i].frames;
            motion.survey = compared_poses_[index][i].survey;
            if (i == 0)
                static_cast<render::Motion&>(setup) = std::move(motion);
            else
                setup.others.push_back(std::move(motion));
        }
        if (setup.accuracy_note.find(" · bends beyond ") == std::string::npos) setup.accuracy_note += beyond;
    }

    // A GIF's colours are those of a few of its frames.
    static std::vector<std::uint32_t> palette_of(render::Film& film) {
        constexpr int kSamples = 9;
        output::PaletteMaker maker;
        render::Image image;
        const int last = film.frames() - 1, samples = std::min(kSamples, film.frames());
        for (int i = 0; i < samples; ++i) {
            film.draw(samples == 1 ? 0 : i * last / (samples - 1), image);
            maker.add(image);
        }
        return maker.colors();
    }

    void draw(std::size_t index) {
        const Pictures& p = plan_.pictures[index];
        if (p.draw.empty()) return;  // a shard of fewer frames than there are shards
        stop_if_interrupted();
        if (!p.too_small.empty() && !capture_ && !options_.quiet)
            output::tell("warning: {} shows no {}: {}\n", p.file, p.too_small, no_room(p.picture.size));
        if (!p.unshown.empty() && !capture_ && !options_.quiet)
            output::tell("warning: {} does not show {}: not within the film\n", p.file, fmt::join(p.unshown, " or "));
        if (options_.verbose && !capture_ && !options_.quiet)
            if (const std::string what = unwritten(p, scene_); !what.empty())
                output::tell("warning: {} shows no {}: {}\n", p.file, what, no_room_to_write(p.picture.size));
        const auto begun = Clock::now();
        render::Film film = film_of(index);
        if (const auto wanted = p.picture.view.exaggeration; wanted && film.yields() && !capture_ && !options_.quiet)
            output::tell(
                "warning: {} shows deflection ×{:g} instead of ×{:g}, which would draw the beam into the cam or "
                "far from where it touches\n",
                p.file, film.exaggeration(), *wanted);
        std::unique_ptr<output::VideoWriter> video;
        if (p.kind == Pictures::Kind::video && !capture_) {
            output::VideoOptions options = video_options(p);
            if (options.codec == output::Codec::gif) options.palette = palette_of(film);
            options.metadata = film_metadata(p);
            video = std::make_unique<output::VideoWriter>(target_of(path_of(p.file), inputs_of(p)), options);
            ++work_.encoders;
        }
        const long count = static_cast<long>(p.draw.size());
        progress_.begin(p.kind == Pictures::Kind::video ? "film" : "draw", static_cast<double>(count), "frames");
        Gate gate;
        std::mutex mutex;  // of the times and the counts
        long done = 0;
        const bool poster = video && p.makes_poster();
        const std::map<std::string, std::string> meta =
            video && !poster ? std::map<std::string, std::string>() : metadata(p);

        auto put = [&](long k, const render::Image& image, const render::Tiles& changed, output::PngSequence& frames) {
            if (capture_) {
                capture_->picture(p, k, image);
                const std::lock_guard lock(mutex);
                return progress_.reach(static_cast<double>(++done));
            }
            const fs::path file =
                path_of(p.kind == Pictures::Kind::still
                            ? p.file
                            : numbered_file(p.file, p.first_frame + p.draw[static_cast<std::size_t>(k)]));
            const output::Target target = target_of(file, inputs_of(p));
            const auto start = Clock::now();
            if (p.kind == Pictures::Kind::still)
                output::write_png(target, image, {std::nullopt, meta});
            else
                output::write_file(target, frames.encode(image, changed), output::Durability::buffered);
            const std::lock_guard lock(mutex);
            times_.write += seconds_since(start);
            if (p.kind == Pictures::Kind::frames) note_written(file);
            progress_.reach(static_cast<double>(++done));
        };
        auto make_worker = [&]() -> Worker {
            auto own = std::make_shared<render::Film>(film.another());
            auto input = video ? std::make_shared<output::VideoInput>(*video) : nullptr;
            auto frames = std::make_shared<output::PngSequence>(
                output::PngOptions{std::nullopt, meta, output::PngCompression::quick});
            return [&, own, input, frames](long k) {
                stop_if_interrupted();
                if (video && repeats(p, k, *own)) {
                    gate.pass(k, [&] {
                        video->repeat();
                        ++work_.frames_repeated;
                        progress_.reach(written(*video));
                    });
                    return;
                }
                const auto start = Clock::now();
                const render::Image& image = own->draw(p.draw[static_cast<std::size_t>(k)]);
                const double spent = seconds_since(start);
                {
                    const std::lock_guard lock(mutex);
                    times_.draw += spent;
                    ++work_.frames_drawn;
                }
                if (!video) return put(k, image, own->changed(), *frames);
                if (poster && p.draw[static_cast<std::size_t>(k)] == *p.poster)
                    output::write_png(target_of(path_of(p.poster_file), inputs_of(p)), image, {std::nullopt, meta});
                input->convert(image, own->changed());
                gate.pass(k, [&] {
                    input->send();
                    progress_.reach(written(*video));
                });
            };
        };
        times_.threads = std::max(times_.threads, fan_out(count, crew(p, video.get()), make_worker, gate));
        const render::DrawingCounts& counts = film.counts();
        work_.font_sets += counts.font_sets;
        work_.gl_contexts += counts.gl_contexts;
        work_.mechanisms_lit += counts.mechanisms_lit;
        times_.read_back += counts.read_back;
        finish(p, video.get(), count);
        if (!capture_)
            note(picture_work(p, thread_count(options_.threads)), static_cast<double>(count), begun, made_of(p));
    }

    static double written(const output::VideoWriter& video) {
        const output::VideoStatistics now = video.statistics();
        return static_cast<double>(now.frames + now.held);
    }

    // An encoder has its own threads; few have to draw to keep it busy.
    Crew crew(const Pictures& p, const output::VideoWriter* video) const {
        const int most = thread_count(options_.threads);
        if (!video || p.picture.view.style == render::Style::solid) return {most, most};
        const int share = p.picture.view.style == render::Style::flat ? 4 : 2;
        return {std::max(1, most / share), most, [demand = std::make_shared<Demand>(*video)] { return (*demand)(); }};
    }

    // Equal to the picture that is written just before it, and not wanted beside the film.
    static bool repeats(const Pictures& p, long k, const render::Film& film) {
        if (k == 0) return false;
        const auto at = static_cast<std::size_t>(k);
        const int frame = p.draw[at];
        return frame == p.draw[at - 1] + 1 && film.repeats(frame) && !(p.makes_poster() && frame == *p.poster);
    }

    void finish(const Pictures& p, output::VideoWriter* video, long count) {
        stop_if_interrupted();
        if (capture_) return progress_.end();
        if (video) {
            video->finish();
            progress_.reach(static_cast<double>(count));
            const output::VideoStatistics spent = video->statistics();
            times_.convert += spent.convert_seconds;
            times_.encode += spent.encode_seconds;
            work_.frames_encoded += spent.frames;
        }
        if (p.kind != Pictures::Kind::frames) {
            wrote(path_of(p.file), video ? fmt::format("{} frames", count) : "");
            if (video && p.makes_poster()) wrote(path_of(p.poster_file), "poster");
            return;
        }
        progress_.end();
        if (!options_.quiet)
            output::tell("wrote {} … {} ({} frames)\n",
                         path_of(numbered_file(p.file, p.first_frame + p.draw.front())).string(),
                         numbered_file(p.file, p.first_frame + p.draw.back()), count);
    }

    const Scene& scene_;
    const RunOptions& options_;
    Shop& shop_;
    Capture* capture_ = nullptr;  // absent: pictures become files
    const Survey found_;
    Plan plan_;  // settled by find_impacts
    Progress& progress_;
    output::Manifest& manifest_;
    Times& times_;
    output::Work& work_;
    std::optional<std::size_t> own_;   // wish for the scene's own motion
    std::vector<std::size_t> others_;  // wishes for others
    sim::Result result_;
    std::vector<sim::Result> ends_;                     // as Simulation::ends
    std::vector<std::vector<sim::Result>> of_figures_;  // one for each study of each figure
    std::vector<std::vector<sim::Result>> compared_;    // one for each motion of each picture
    std::vector<Kept> own_poses_;                       // of each picture; none where results bring theirs
    std::vector<std::vector<Kept>> compared_poses_;     // as `compared_`
};

// ---- all together ------------------------------------------------------------------------------

void refuse_clashes(std::span<const Scene> scenes) {
    FileClaims claims;
    for (std::size_t i = 0; i < scenes.size(); ++i)
        for (const Output& output : scenes[i].outputs)
            for (const std::string& file : written_by(output)) claims.add(file, i);
    for (const auto& [later, earlier] : claims.clashes())
        throw NameClash(
            fmt::format("{} of the scene {} and {} of the scene {} are one file; give them different "
                        "names, or run the scenes one by one with -o",
                        later.file, scenes[later.owner].name, earlier.file, scenes[earlier.owner].name));
}

// Until when anybody wants the motion that this one wants.
double far(const Runner& one, const std::vector<std::unique_ptr<Runner>>& runners) {
    double until = 0;
    for (const auto& other : runners)
        if (other->planned().simulation && other->motion() == one.motion())
            until = std::max(until, other->planned().simulation->request.end_time);
    return until;
}

void tell_ignored_gl_settings(const RunOptions& options, const std::vector<std::unique_ptr<Runner>>& runners) {
    const std::vector<std::string>& ignored = render::ignored_gl_settings();
    const bool drawn = std::ranges::any_of(runners, [](const auto& runner) { return runner->planned().needs_gl(); });
    if (!options.quiet && drawn && !ignored.empty())
        output::tell("warning: these settings of OpenGL are ignored, lit and solid views have their own: {}\n",
                     fmt::join(ignored, ", "));
}

void make_motions(Shop& shop, const std::vector<std::unique_ptr<Runner>>& runners) {
    const auto start = Clock::now();
    for (const auto& runner : runners) runner->ask();
    try {
        shop.motions.make();
    } catch (const sim::SolverError&) {
        try {
            for (const auto& runner : runners) runner->keep_partial_tables();
        } catch (const output::IoError& also) {
            output::tell("beamcam: {}\n", also.what());  // the solver's failure is the one to report
        }
        throw;
    }
    for (const auto& runner : runners) runner->take();
    shop.times.simulate += seconds_since(start);
    const sim::Effort& effort = shop.motions.effort();
    shop.work.integrations = effort.integrations;
    shop.work.steps = effort.spent.steps;
    shop.work.rhs_evaluations = effort.spent.rhs_evaluations;
    shop.work.gap_evaluations = effort.spent.gap_evaluations;
    shop.work.trajectories_from_cache = shop.motions.from_cache();
    shop.work.trajectories_kept = shop.motions.kept();
}

void tell(const Shop& shop) {
    output::tell(
        "time: {:.2f} s in all; motion {:.2f} s, drawing {:.2f} s ({}; read back {:.2f} s), conversion "
        "{:.2f} s, "
        "encoding {:.2f} s, other files {:.2f} s\n",
        seconds_since(shop.started), shop.times.simulate, shop.times.draw,
        counted(static_cast<std::size_t>(shop.times.threads), "thread"), shop.times.read_back, shop.times.convert,
        shop.times.encode, shop.times.write);
    std::string text;
    for_each_count(shop.work, [&](const char* what, long count) { text += fmt::format(" {}={}", what, count); });
    output::tell("work:{}\n", text);
}

}  // namespace

void run(std::span<const Scene> scenes, const RunOptions& options) {
    refuse_clashes(scenes);
    std::size_t outputs = 0;
    for (const Scene& scene : scenes) outputs += scene.outputs.size();
    Shop shop(options);
    std::vector<std::unique_ptr<Runner>> runners;
    for (const Scene& scene : scenes) runners.push_back(std::make_unique<Runner>(scene, shop));
    for (const auto& runner : runners) runner->prepare();
    tell_ignored_gl_settings(options, runners);
    for (const auto& runner : runners) runner->find_impacts(far(*runner, runners));
    make_motions(shop, runners);
    for (const auto& runner : runners) runner->deliver();
    shop.manifest.save();
    shop.history.save();
    if (options.verbose) tell(shop);
    if (shop.refused > 0) throw Incomplete(fmt::format("{} of {} not made", shop.refused, counted(outputs, "output")));
}

void run(const Scene& scene, const RunOptions& options) { run({&scene, 1}, options); }

void draw(const Plan& plan, const Scene& scene, Capture& capture, const RunOptions& options) {
    Shop shop(options);
    Runner(plan, scene, capture, shop).hand_over();
}

Plan plan_for(const Scene& scene, const RunOptions& options) {
    const std::optional<Cache> cache = open_cache(options.no_cache);
    output::Manifest manifest(options.force);
    const Survey found =
        survey(scene, options.ask, options.directory, manifest, cache ? &*cache : nullptr, options.force);
    Plan made = plan(scene, options.ask, found.known);
    note_unwritten(made, scene);
    if (cache) estimate(made, scene, History(cache->directory()), thread_count(options.threads));
    return made;
}

}  // namespace beamcam::scenes
