#include "scenes/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "output/atomic_file.hpp"
#include "output/interrupt.hpp"
#include "output/manifest.hpp"
#include "output/palette.hpp"
#include "output/png.hpp"
#include "output/records.hpp"
#include "output/tables.hpp"
#include "output/video.hpp"
#include "render/film.hpp"
#include "scenes/fan_out.hpp"
#include "scenes/figures/make.hpp"
#include "scenes/files.hpp"
#include "scenes/version.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

bool is_stdout(const std::string& file) { return file == "-"; }

void print_data(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw output::IoError("cannot write to standard output; is the pipe closed or the disk full?");
}

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
    double simulate = 0, draw = 0, convert = 0, encode = 0, write = 0;  // [s]; drawing summed over threads
};

class Runner {
  public:
    Runner(const Plan& plan, const Scene& scene, const RunOptions& options)
        : plan_(plan),
          scene_(scene),
          options_(options),
          progress_(resolve(options.progress)),
          manifest_(options.force) {}

    void go() {
        started_ = Clock::now();
        if (options_.capture) return hand_over();
        require_room();
        make_directories();
        require_encoder();
        if (plan_.impacts_until) {
            find_impacts();
            require_room();  // now that the number of frames is known
            make_directories();
        }
        simulate();
        write_tables();
        write_records();
        write_figures();
        for (const Pictures& p : plan_.pictures) draw(p);
        manifest_.save();
        if (options_.verbose) tell_times();
    }

  private:
    // The run of a command that compares: the same pixels, but no files.
    void hand_over() {
        result_ = std::move(options_.capture->result);
        if (!plan_.figures.empty()) {
            const std::vector<sim::Result> others = results_of_studies();
            for (const FigureFile& f : plan_.figures)
                options_.capture->figure(figure_image(f.make(by_study(others)), figure_output(f)));
        }
        for (const Pictures& p : plan_.pictures) draw(p);
    }

    // ---- files -----------------------------------------------------------------------------

    fs::path path_of(const std::string& file) const {
        return options_.directory.empty() ? fs::path(file) : fs::path(options_.directory) / file;
    }

    // At least one, also before it is known.
    std::size_t frames_of(const Pictures& p) const { return std::max<std::size_t>(plan_.times(p).size(), 1); }

    // Every file that will be written.
    std::vector<fs::path> targets() const {
        std::vector<fs::path> files;
        auto add = [&](const std::string& file) {
            if (!is_stdout(file)) files.push_back(path_of(file));
        };
        for (const Pictures& p : plan_.pictures) {
            if (p.kind != Pictures::Kind::frames)
                add(p.file);
            else
                for (std::size_t k = 0; k < frames_of(p); ++k)
                    add(numbered_file(p.file, p.first_frame + static_cast<long>(k)));
        }
        for (const FigureFile& f : plan_.figures)
            for (const std::string& file : files_of(figure_output(f))) add(file);
        for (const TableFile& t : plan_.tables) add(t.file);
        for (const ImpactsFile& i : plan_.impacts) add(i.file);
        for (const SummaryFile& s : plan_.summaries) add(s.file);
        return files;
    }

    // Refuses before any work what would be refused after it.
    void require_room() {
        for (const fs::path& file : targets()) {
            std::error_code ignored;
            if (fs::is_directory(file, ignored))
                throw output::IoError(
                    fmt::format("{} is a directory; choose another name for the output", file.string()));
            const fs::path folder = file.parent_path();
            if (options_.directory.empty() && !folder.empty() && !fs::is_directory(folder, ignored))
                throw output::IoError(
                    fmt::format("{}: there is no directory {}; make it first", file.string(), folder.string()));
            manifest_.require_replaceable(file);
        }
    }

    void make_directories() {
        if (options_.directory.empty()) return;
        for (const fs::path& file : targets()) output::ensure_directory(file.parent_path());
    }

    void wrote(const fs::path& file, const std::string& what) {
        // Most pictures and films carry their scene inside.
        static constexpr std::string_view kSilent[] = {".csv", ".npz", ".json", ".gif", ".apng", ".webp"};
        if (std::find(std::begin(kSilent), std::end(kSilent), file.extension().string()) != std::end(kSilent))
            manifest_.record(file, std::string(kVersion), to_json(scene_));
        else
            manifest_.record(file);
        progress_.end();
        if (!options_.quiet) fmt::print(stderr, "wrote {}{}\n", file.string(), what.empty() ? "" : " (" + what + ")");
    }

    std::map<std::string, std::string> metadata() const {
        const std::string note = accuracy_note();
        std::map<std::string, std::string> all = {{"Software", fmt::format("beamcam {}", kVersion)},
                                                  {"beamcam-scene", to_json(scene_)},
                                                  {"beamcam-accuracy", note}};
        if (!scene_.title.empty()) all["Title"] = scene_.title;
        return all;
    }

    // What a film's players show, in the keys that MP4 knows.
    std::map<std::string, std::string> film_metadata() const {
        std::map<std::string, std::string> all = {{"comment", fmt::format("made by beamcam {}", kVersion)},
                                                  {"beamcam-scene", to_json(scene_)},
                                                  {"beamcam-version", std::string(kVersion)},
                                                  {"beamcam-accuracy", accuracy_note()}};
        if (!scene_.title.empty()) all["title"] = scene_.title;
        return all;
    }

    // "rtol 10⁻⁸ · energy closes to 2 × 10⁻⁹"
    std::string accuracy_note() const { return accuracy_note(scene_.problem, result_); }
    static std::string accuracy_note(const sim::Problem& problem, const sim::Result& result) {
        std::string note = fmt::format("rtol {}", power_of_ten(problem.solver.rtol));
        if (result.energy_scale > 0 && result.energy_residual_max > 0)
            note +=
                fmt::format(" · energy closes to {}", power_of_ten(result.energy_residual_max / result.energy_scale));
        return note;
    }

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
        if (video.codec == output::Codec::gif) video.palette = {0xffffffff};
        video.metadata = film_metadata();
        return video;
    }

    // A film of each codec is opened and dropped, so that a missing encoder is told before anything is computed.
    void require_encoder() const {
        std::set<output::Codec> tried;
        for (const Pictures& p : plan_.pictures)
            if (p.kind == Pictures::Kind::video && tried.insert(p.encoding.codec).second)
                output::VideoWriter(path_of(p.file), video_options(p));
    }

    // Slow motion and pictures of impacts ask where the impacts are, before anything else can be asked.
    void find_impacts() {
        settle(plan_, scene_, [&](const sim::Problem& problem, double until) {
            sim::Request request;
            request.end_time = until;
            return simulated("impacts", problem, request);
        });
    }

    sim::Result simulated(const char* stage, const sim::Problem& problem, const sim::Request& request) {
        progress_.begin(stage, request.end_time, "s");
        const auto start = Clock::now();
        sim::Result result = sim::simulate(problem, request, [&](double t) {
            progress_.reach(t);
            return !output::interrupted();
        });
        progress_.end();
        times_.simulate += seconds_since(start);
        return result;
    }

    void simulate() {
        if (!plan_.simulation) return;
        const sim::Request& request = plan_.simulation->request;
        progress_.begin("simulate", request.end_time, "s");
        const auto start = Clock::now();
        try {
            result_ = sim::simulate(scene_.problem, request, [&](double t) {
                progress_.reach(t);
                return !output::interrupted();
            });
        } catch (const sim::SolverError& error) {
            progress_.end();
            try {
                keep_partial_tables(error.partials.front());
            } catch (const output::IoError& also) {
                fmt::print(stderr, "beamcam: {}\n", also.what());  // the solver's failure is the one to report
            }
            throw;
        }
        progress_.end();
        times_.simulate = seconds_since(start);
        if (!options_.quiet)
            for (const std::string& warning : result_.warnings) fmt::print(stderr, "warning: {}\n", warning);
    }

    const FigureOutput& figure_output(const FigureFile& f) const {
        return std::get<FigureOutput>(scene_.outputs[f.output]);
    }

    // Variants of the scene are integrated side by side; each figure then reads what it asked for.
    std::vector<sim::Result> results_of_studies() {
        const auto start = Clock::now();
        std::vector<sim::Result> others =
            simulate_studies(plan_.studies, thread_count(), progress_, options_.quiet);
        times_.simulate += seconds_since(start);
        return others;
    }
    Results by_study(const std::vector<sim::Result>& others) const {
        Results results{&result_};
        for (const sim::Result& other : others) results.push_back(&other);
        return results;
    }

    void write_figures() {
        if (plan_.figures.empty()) return;
        const std::vector<sim::Result> others = results_of_studies();
        for (const FigureFile& f : plan_.figures) {
            stop_if_interrupted();
            const auto begun = Clock::now();
            const FigureOutput& how = figure_output(f);
            for (const auto& [file, bytes] : figure_files(f.make(by_study(others)), how, scene_of_figure(scene_, how))) {
                output::write_file(path_of(file), bytes);
                wrote(path_of(file), file == how.file ? f.figure : "");
            }
            times_.write += seconds_since(begun);
        }
    }

    // What a failed run reached is worth looking at, under a name that no script takes for the result.
    void keep_partial_tables(const sim::Result& partial) {
        for (const TableFile& t : plan_.tables) {
            if (is_stdout(t.file) || t.table >= partial.tables.size() || partial.tables[t.table].rows() == 0) continue;
            fs::path file = path_of(t.file);
            file.replace_extension(".partial.csv");
            manifest_.require_replaceable(file);
            output::write_csv(file, partial.tables[t.table]);
            wrote(file, "as far as the solver came");
        }
    }

    void write_tables() {
        for (const TableFile& t : plan_.tables) {
            stop_if_interrupted();
            const sim::Table& table = result_.tables[t.table];
            const auto start = Clock::now();
            if (is_stdout(t.file)) {
                output::write_csv(std::cout, table);
                std::cout.flush();
                if (!std::cout)
                    throw output::IoError("cannot write to standard output; is the pipe closed or the disk full?");
            } else {
                output::write_table(path_of(t.file), table);
                wrote(path_of(t.file), fmt::format("{} rows", table.rows()));
            }
            times_.write += seconds_since(start);
        }
    }

    void write_records() {
        for (const ImpactsFile& i : plan_.impacts) {
            if (is_stdout(i.file)) {
                print_data(output::impacts_json(result_));
            } else {
                output::write_impacts(path_of(i.file), result_);
                wrote(path_of(i.file),
                      fmt::format("{} impacts in {} collisions", result_.impacts.size(), result_.collisions.size()));
            }
        }
        for (const SummaryFile& s : plan_.summaries) {
            const std::vector<sim::Channel>& extrema = plan_.simulation->request.extrema;
            if (is_stdout(s.file)) {
                print_data(output::summary_json(scene_.problem, result_, extrema));
            } else {
                output::write_summary(path_of(s.file), scene_.problem, result_, extrema);
                wrote(path_of(s.file), "");
            }
        }
    }

    render::Film film_of(const Pictures& p) {
        render::FilmSetup setup;
        setup.title = scene_.title;
        setup.width = p.picture.size.width;
        setup.height = p.picture.size.height;
        setup.view = p.picture.view;
        setup.layout = p.picture.layout;
        setup.comparison = p.picture.comparison;
        setup.speeds = p.speeds;
        setup.callouts = p.callouts;
        if (p.compared.empty()) {
            static_cast<render::Motion&>(setup) = motion_of(scene_.problem, result_, p.poses, p.chart, p.trace);
            setup.accuracy_note = accuracy_note();
        } else {
            add_compared(p, setup);
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
    void add_compared(const Pictures& p, render::FilmSetup& setup) {
        double worst = -1;
        for (std::size_t i = 0; i < p.compared.size(); ++i) {
            const ComparedMotion& each = p.compared[i];
            sim::Result result = simulated("simulate", each.problem, each.request);
            stop_if_interrupted();
            const double share = result.energy_scale > 0 ? result.energy_residual_max / result.energy_scale : 0;
            if (share > worst) worst = share, setup.accuracy_note = accuracy_note(each.problem, result);
            const bool traced = result.tables.size() > 1;
            render::Motion motion =
                motion_of(each.problem, result, 0, 0, traced ? std::optional<std::size_t>(1) : std::nullopt);
            motion.label = each.label;
            if (i == 0)
                static_cast<render::Motion&>(setup) = std::move(motion);
            else
                setup.others.push_back(std::move(motion));
        }
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

    void draw(const Pictures& p) {
        stop_if_interrupted();
        render::Film film = film_of(p);
        std::unique_ptr<output::VideoWriter> video;
        if (p.kind == Pictures::Kind::video && !options_.capture) {
            output::VideoOptions options = video_options(p);
            if (options.codec == output::Codec::gif) options.palette = palette_of(film);
            video = std::make_unique<output::VideoWriter>(path_of(p.file), options);
        }
        const long count = film.frames();
        progress_.begin(p.kind == Pictures::Kind::video ? "film" : "draw", static_cast<double>(count), "frames");
        Gate gate;
        std::mutex mutex;  // of the manifest, the times and the count
        long done = 0;
        const std::map<std::string, std::string> meta = video ? std::map<std::string, std::string>() : metadata();

        auto put = [&](long k, const render::Image& image) {
            if (options_.capture) {
                options_.capture->picture(p, k, image);
                const std::lock_guard lock(mutex);
                return progress_.reach(static_cast<double>(++done));
            }
            if (video) {
                gate.pass(k, [&] {
                    video->write(image);
                    progress_.reach(static_cast<double>(video->statistics().frames));
                });
                return;
            }
            const fs::path file =
                path_of(p.kind == Pictures::Kind::still ? p.file : numbered_file(p.file, p.first_frame + k));
            const auto start = Clock::now();
            output::write_png(
                file, image, {std::nullopt, meta},
                p.kind == Pictures::Kind::still ? output::Durability::synced : output::Durability::buffered);
            const std::lock_guard lock(mutex);
            times_.write += seconds_since(start);
            if (p.kind == Pictures::Kind::frames) manifest_.record(file);
            progress_.reach(static_cast<double>(++done));
        };
        auto make_worker = [&]() -> Worker {
            auto own = std::make_shared<render::Film>(film.another());
            auto image = std::make_shared<render::Image>();
            return [&, own, image](long k) {
                stop_if_interrupted();
                const auto start = Clock::now();
                own->draw(static_cast<int>(k), *image);
                const double spent = seconds_since(start);
                {
                    const std::lock_guard lock(mutex);
                    times_.draw += spent;
                }
                put(k, *image);
            };
        };
        fan_out(count, thread_count(), make_worker, gate);
        finish(p, video.get(), count);
    }

    void finish(const Pictures& p, output::VideoWriter* video, long count) {
        stop_if_interrupted();
        if (options_.capture) return progress_.end();
        if (video) {
            video->finish();
            progress_.reach(static_cast<double>(count));
            const output::VideoStatistics spent = video->statistics();
            times_.convert += spent.convert_seconds;
            times_.encode += spent.encode_seconds;
        }
        if (p.kind != Pictures::Kind::frames)
            return wrote(path_of(p.file), video ? fmt::format("{} frames", count) : "");
        progress_.end();
        if (!options_.quiet)
            fmt::print(stderr, "wrote {} … {} ({} frames)\n", path_of(numbered_file(p.file, p.first_frame)).string(),
                       numbered_file(p.file, p.first_frame + count - 1), count);
    }

    // ---- small things ----------------------------------------------------------------------

    int thread_count() const {
        if (options_.threads > 0) return options_.threads;
        return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    }

    static void stop_if_interrupted() {
        if (output::interrupted()) throw Stopped();
    }

    void tell_times() const {
        fmt::print(stderr,
                   "time: {:.2f} s in all; simulation {:.2f} s, drawing {:.2f} s ({} threads), conversion {:.2f} s, "
                   "encoding {:.2f} s, other files {:.2f} s\n",
                   seconds_since(started_), times_.simulate, times_.draw, thread_count(), times_.convert, times_.encode,
                   times_.write);
        if (plan_.simulation)
            fmt::print(stderr,
                       "simulation: {} steps, {} right-hand sides, {} impacts in {} collisions, energy closes to "
                       "{:.2e} of {:.3g} J\n",
                       result_.counters.steps, result_.counters.rhs_evaluations, result_.impacts.size(),
                       result_.collisions.size(), result_.energy_residual_max, result_.energy_scale);
    }

    Plan plan_;  // settled by find_impacts
    const Scene& scene_;
    const RunOptions& options_;
    Progress progress_;
    output::Manifest manifest_;
    sim::Result result_;
    Times times_;
    Clock::time_point started_;
};

}  // namespace

void run(const Plan& plan, const Scene& scene, const RunOptions& options) { Runner(plan, scene, options).go(); }

}  // namespace beamcam::scenes
