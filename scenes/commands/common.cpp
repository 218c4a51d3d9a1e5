// Options and arguments that the commands share.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "output/files/standard_output.hpp"
#include "render/plot/style.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/absent.hpp"
#include "scenes/format/keys.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/film_times.hpp"

namespace beamcam::scenes {

void add_set(CLI::App& app, Common& common) {
    add_option(app, "--set", common.overrides, "KEY=VALUE",
               "Change a key of the scene, for example --set cam.speed=300rpm: a JSON value or a plain word "
               "(repeatable)")
        ->check(problem_with_override, "");
}
void add_quiet(CLI::App& app, Common& common) {
    app.add_flag("-q,--quiet", common.quiet,
                 "Print no messages but errors on standard error; standard output stays the same");
}

void add_scene(CLI::App& app, std::string& scene, Common& common) {
    app.add_option("SCENE", scene, "The scene, a JSON file; - is standard input")->required();
    add_set(app, common);
    add_quiet(app, common);
}

void add_scenes(CLI::App& app, std::vector<std::string>& scenes, Common& common) {
    app.add_option("SCENE", scenes, "Scenes, JSON files; - is standard input")->required();
    add_set(app, common);
    add_quiet(app, common);
}

void add_jobs(CLI::App& app, Common& common, const char* what) {
    within(add_option(app, "-j,--jobs", common.threads, "N", fmt::format("{} (default: one for each core)", what)), 1,
           1024);
}
void add_progress(CLI::App& app, Common& common) {
    add_choice(app, "--progress", common.progress, kProgressStyles, "STYLE", "Progress on standard error");
}
void add_json(CLI::App& app, Common& common) { app.add_flag("--json", common.json, "Print JSON"); }
void add_force(CLI::App& app, Common& common) {
    app.add_flag("--force", common.force, "Replace existing files, even those that beamcam did not make");
}
void add_column(CLI::App& app, std::string& column) {
    one_of(add_option(app, "--column", column, "COLUMN", "Column of a journal: sets width and font size of the figure"),
           render::figure::column_names());
}
void add_lang(CLI::App& app, Lang& lang) {
    add_choice(app, "--lang", lang, kLanguages, "LANG", "Language of the figure");
}

void add_work(CLI::App& app, Common& common) {
    app.add_flag("-v,--verbose", common.verbose, "Print where the time was spent, and counts of the work");
    add_jobs(app, common, "Largest number of threads");
    add_progress(app, common);
    app.add_flag(
        "--force", common.force,
        "Replace existing files, even those that beamcam did not make, and make files again that are up to date");
    app.add_flag("-n,--dry-run", common.dry_run, "Print the plan and do nothing");
    app.add_flag("--json", common.json, "With -n: print the plan as JSON");
}

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

void inform(const Common& common, const std::string& text) {
    if (!common.quiet) output::print_message("{}\n", text);
}

static Scene scene_of(Reading reading, const Common& common) {
    if (!reading.scene) throw SceneError(reading.report());
    if (!common.quiet && !reading.messages.empty()) output::print_message("{}", reading.report());
    return std::move(*reading.scene);
}

Scene load_scene(const std::string& path, const Common& common) {
    return scene_of(read_scene(load_source(path), common.overrides), common);
}

Scene load_scene_with_output(const std::string& path, const Common& common) {
    Reading reading = read_scene(load_source(path), common.overrides);
    if (!reading.scene || !reading.scene->outputs.empty()) return scene_of(std::move(reading), common);
    const PictureOutput film = default_film(*reading.scene);
    reading.scene->outputs.push_back(film);
    reading.scene->output_places.push_back(path);
    if (const std::string problem = problem_with_span(film.span, reading.scene->end_time); !problem.empty()) {
        const Node &time = reading.root.find("time")->value, &end = time.find("end")->value;  // not the default
        reading.messages.push_back({end.place, "time.end: a scene without outputs makes a film: " + problem, true});
        reading.scene.reset();
    }
    return scene_of(std::move(reading), common);
}

void print_result(const Common& common, const std::string& json, const std::string& text) {
    common.json ? print_json(json) : print_text(text);
}

LoadedScenes load_scenes(const std::vector<std::string>& paths, const Common& common) {
    LoadedScenes all;
    all.code =
        for_each_file(paths, [&](const auto& path) { all.scenes.push_back(load_scene_with_output(path, common)); });
    return all;
}

PictureOutput film_template(const Scene& scene) {
    for (const Output& output : scene.outputs) {
        const auto* own = std::get_if<PictureOutput>(&output);
        if (!own || own->kind == PictureOutput::Kind::page) continue;
        PictureOutput film = *own;
        if (own->kind != PictureOutput::Kind::video)
            film.kind = PictureOutput::Kind::video, film.file = default_film(scene).file;
        film.span.poster.reset();  // one file only
        return film;
    }
    return default_film(scene);
}

ProgressStyle progress_style(const Common& common) {
    return common.quiet ? ProgressStyle::none : resolve(common.progress);
}

RunOptions run_options(const Common& common, std::string directory) {
    RunOptions options = common;
    options.directory = std::move(directory);
    options.progress = progress_style(common);
    return options;
}

void print_plans(std::span<const Scene> scenes, const RunOptions& options, bool json) {
    std::string text;
    for (const Scene& scene : scenes) {
        const Plan planned = plan_for(scene, options);
        if (json) {
            text += (text.empty() ? "" : ",\n") + to_json(planned, scene);
        } else {
            if (scenes.size() > 1) text += fmt::format("{}{}\n", text.empty() ? "" : "\n", scene.name);
            text += to_text(planned, scene);
        }
    }
    if (json)
        print_json(scenes.size() > 1 ? "[" + text + "]\n" : text);
    else
        print_text(text);
}

void run_or_plan(std::span<const Scene> scenes, const RunOptions& options, const Common& common) {
    if (common.dry_run)
        print_plans(scenes, options, common.json);
    else
        run(scenes, options);
}

double signed_argument(const std::string& option, const std::string& text, const Dimension& dimension) {
    const QuantityText read = parse_quantity(text);
    if (!read.quantity) throw UsageError(fmt::format("{} {}: {}", option, text, read.problem));
    const bool plain = same(read.quantity->dimension, dimension::kNone) && text.find('%') == std::string::npos;
    if (!plain && !same(read.quantity->dimension, dimension))
        throw UsageError(fmt::format("{} {}: its unit is {}", option, text, si_unit(dimension)));
    return read.quantity->value;
}

void require_units(const std::string& option, const std::vector<std::string>& values) {
    const auto is_plain = [](const std::string& text) {
        return text.find_last_not_of(" 0123456789.eE+-") == std::string::npos;
    };
    const auto lacks_unit = [&](const std::string& text) { return is_plain(text) && text != "0"; };
    const auto has_unit = [&](const std::string& text) { return !is_plain(text) && parse_quantity(text).quantity; };
    if (std::ranges::any_of(values, lacks_unit) && std::ranges::any_of(values, has_unit))
        throw UsageError(fmt::format(
            "{}: some of its numbers have a unit; write it with each of them, as in 100rpm:900rpm:9", option));
}

sim::CamSpan span_argument(const char* option, const std::string& text) {
    constexpr double kMost = 1e9;   // more than any integration reaches
    constexpr double kParts = 1e9;  // of a turn: "7.1 turns" is an angle that is not exactly so many turns
    const QuantityText read = parse_quantity(text);
    if (!read.quantity || !(read.quantity->value >= 0 && read.quantity->value <= kMost))
        throw UsageError(
            fmt::format("{} {}: write turns of the cam, or a time such as \"30 s\", up to {:g}", option, text, kMost));
    sim::CamSpan span;
    if (same(read.quantity->dimension, dimension::kNone))
        span.turns = read.quantity->value;
    else if (same(read.quantity->dimension, dimension::kAngle))
        span.turns = std::round(read.quantity->value / (2 * std::numbers::pi) * kParts) / kParts;
    else
        span.time = signed_argument(option, text, dimension::kTime);
    return span;
}

double positive_argument(const char* option, const std::string& text, const Dimension& dimension) {
    const double value = signed_argument(option, text, dimension);
    if (!(value > 0)) throw UsageError(fmt::format("{} {}: must be positive", option, text));
    return value;
}

void require_ending(const char* option, const std::string& file, std::initializer_list<const char*> endings) {
    if (is_stdout(file))
        throw UsageError(fmt::format("{} -: name a file that ends in {}", option, fmt::join(endings, " or ")));
    if (std::ranges::find(endings, ending_of(file)) != endings.end()) return;
    throw UsageError(fmt::format("{} {}: the name must end in {}{}", option, file, fmt::join(endings, " or "),
                                 absent(ending_of(file))));
}

void require_ending_or_stdout(const char* option, const std::string& file, std::initializer_list<const char*> endings) {
    if (!is_stdout(file)) require_ending(option, file, endings);
}

}  // namespace beamcam::scenes
