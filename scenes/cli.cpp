#include "scenes/cli.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "output/atomic_file.hpp"
#include "output/errors.hpp"
#include "output/interrupt.hpp"
#include "output/records.hpp"
#include "render/error.hpp"
#include "scenes/capabilities.hpp"
#include "scenes/embedded.hpp"
#include "scenes/files.hpp"
#include "scenes/plan.hpp"
#include "scenes/reader.hpp"
#include "scenes/run.hpp"
#include "scenes/suggest.hpp"
#include "scenes/units.hpp"
#include "scenes/version.hpp"
#include "sim/modes.hpp"

namespace beamcam::scenes {
namespace {

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};
// The report has one message or more, positioned and complete.
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// ---- what the commands were given --------------------------------------------------------------

// Options that several commands share.
struct Common {
    std::vector<std::string> overrides;
    int threads = 0;
    bool quiet = false, verbose = false, force = false, no_cache = false;
    std::string progress = "auto";
};

struct Arguments {
    Common common;
    std::vector<std::string> scenes;
    std::string output;  // -o
    bool json = false, dry_run = false;
    // render
    std::optional<std::string> at, from, to, size, fps, style, theme;
    // simulate
    std::optional<std::string> trajectory, impacts, summary, rate;
    std::vector<std::string> times, channels;
    bool horizon = false;
    // modes
    std::optional<std::string> speed;
    // init
    std::string name = "scene";
};

// ---- helpers -----------------------------------------------------------------------------------

void say(const Common& common, const std::string& text) {
    if (!common.quiet) fmt::print(stderr, "{}\n", text);
}

void print_data(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw output::IoError("cannot write to standard output; is the pipe closed or the disk full?");
}

Scene read_or_refuse(const std::string& path, const Common& common) {
    Reading reading = read_scene(load_source(path), common.overrides);
    if (!reading.scene) throw SceneError(reading.report());
    if (!common.quiet && !reading.messages.empty()) fmt::print(stderr, "{}", reading.report());
    return std::move(*reading.scene);
}

double instant_argument(const char* option, const std::string& text, const Dimension& dimension) {
    const QuantityText read = parse_quantity(text);
    if (!read.quantity) throw UsageError(fmt::format("{} {}: {}", option, text, read.problem));
    const bool plain = same(read.quantity->dimension, dimension::kNone) && text.find('%') == std::string::npos;
    if (!plain && !same(read.quantity->dimension, dimension))
        throw UsageError(fmt::format("{} {}: it is measured in {}", option, text, si_unit(dimension)));
    if (!(read.quantity->value >= 0)) throw UsageError(fmt::format("{} {}: must not be negative", option, text));
    return read.quantity->value;
}

double seconds_argument(const char* option, const std::string& text) {
    return instant_argument(option, text, dimension::kTime);
}

std::string ending_of(const std::string& file) { return std::filesystem::path(file).extension().string(); }

void need_ending(const char* option, const std::string& file, std::initializer_list<std::string_view> endings) {
    if (file == "-" || std::find(endings.begin(), endings.end(), ending_of(file)) != endings.end()) return;
    if (const auto planned = not_available("file", ending_of(file)))
        throw UsageError(fmt::format("{} {}: {}", option, file, *planned));
    throw UsageError(fmt::format("{} {}: the name must end in {}", option, file, fmt::join(endings, " or ")));
}

RunOptions run_options(const Common& common, std::string directory) {
    RunOptions options;
    options.directory = std::move(directory);
    options.threads = common.threads;
    options.force = common.force;
    options.quiet = common.quiet;
    options.verbose = common.verbose;
    const auto style = progress_style_named(common.progress);
    if (!style) throw UsageError(fmt::format("--progress {}: choose auto, bar, plain, json or none", common.progress));
    options.progress = common.quiet ? ProgressStyle::none : resolve(*style);
    return options;
}

// ---- commands ----------------------------------------------------------------------------------

void check(const Arguments& args) {
    bool fine = true;
    for (const std::string& path : args.scenes) {
        const Reading reading = read_scene(load_source(path), args.common.overrides);
        fmt::print(stderr, "{}", reading.report());
        if (reading.scene)
            say(args.common, fmt::format("{}: fine", path));
        else
            fine = false;
    }
    if (!fine) throw SceneError("");
}

void show_plan(const Scene& scene, bool json) {
    const Plan made = plan(scene);
    print_data(json ? to_json(made, scene) : to_text(made, scene));
}

Scene with_default_output(Scene scene) {
    if (scene.outputs.empty()) scene.outputs.push_back(default_film(scene));
    return scene;
}

void run_command(const Arguments& args) {
    const Scene scene = with_default_output(read_or_refuse(args.scenes.front(), args.common));
    if (args.dry_run) return show_plan(scene, args.json);
    run(plan(scene), scene, run_options(args.common, args.output.empty() ? "." : args.output));
}

void plan_command(const Arguments& args) {
    show_plan(with_default_output(read_or_refuse(args.scenes.front(), args.common)), args.json);
}

// What `render` draws like: the scene's first film, sequence or still, else the default film.
VideoOutput film_to_imitate(const Scene& scene) {
    VideoOutput film = default_film(scene);
    for (const Output& output : scene.outputs) {
        if (const auto* video = std::get_if<VideoOutput>(&output)) return *video;
        if (const auto* frames = std::get_if<FramesOutput>(&output)) {
            film.size = frames->size;
            film.view = frames->view;
            film.span = frames->span;
            return film;
        }
        if (const auto* still = std::get_if<StillOutput>(&output)) {
            film.size = still->size;
            film.view = still->view;
            return film;
        }
    }
    return film;
}

void apply_render_options(const Arguments& args, VideoOutput& film) {
    if (args.size) {
        const auto size = parse_size(*args.size);
        if (!size)
            throw UsageError(fmt::format("--size {}: write WIDTHxHEIGHT in pixels, for example 1280x720", *args.size));
        film.size = *size;
    }
    if (args.fps) {
        const auto fps = parse_frame_rate(*args.fps);
        if (!fps)
            throw UsageError(fmt::format("--fps {}: write frames a second, for example 60 or 30000/1001", *args.fps));
        film.span.fps = *fps;
    }
    if (args.from) film.span.from = seconds_argument("--from", *args.from);
    if (args.to) film.span.to = seconds_argument("--to", *args.to);
    if (args.style) film.view.style = *args.style == "flat" ? render::Style::flat : render::Style::lit;
    if (args.theme)
        film.view.theme = *args.theme == "dark"    ? render::Theme::dark
                          : *args.theme == "print" ? render::Theme::print
                                                   : render::Theme::light;
}

Output render_output(const Arguments& args, VideoOutput film) {
    const std::string ending = ending_of(args.output);
    if (args.output == "-") throw UsageError("-o -: pictures go to files; name one that ends in .mp4 or .png");
    need_ending("-o", args.output, {".mp4", ".png"});
    const bool numbered = is_numbered(std::filesystem::path(args.output).filename().string());
    if (args.at) {
        if (ending != ".png" || numbered)
            throw UsageError(fmt::format("--at makes one picture; -o {} must be a .png file without '#'", args.output));
        if (args.from || args.to || args.fps)
            throw UsageError("--at makes one picture; --from, --to and --fps belong to films");
        return StillOutput{args.output, film.size, film.view, seconds_argument("--at", *args.at)};
    }
    if (ending == ".png") {
        if (!numbered)
            throw UsageError(
                fmt::format("-o {}: name the instant with --at for one picture, or put #### in the name for a sequence",
                            args.output));
        if (std::string problem = problem_with_numbering(args.output); !problem.empty())
            throw UsageError(fmt::format("-o {}: {}", args.output, problem));
        return FramesOutput{args.output, film.size, film.view, film.span};
    }
    if (numbered)
        throw UsageError(fmt::format("-o {}: '#' numbers .png files; choose another name for a film", args.output));
    if (film.size.width % 2 || film.size.height % 2)
        throw UsageError(
            fmt::format("a film of {} × {}: H.264 (yuv420p) needs even sides; choose --size {}x{}, or a .png sequence",
                        film.size.width, film.size.height, film.size.width + film.size.width % 2,
                        film.size.height + film.size.height % 2));
    film.file = args.output;
    return film;
}

void render_command(const Arguments& args) {
    Scene scene = read_or_refuse(args.scenes.front(), args.common);
    VideoOutput film = film_to_imitate(scene);
    apply_render_options(args, film);
    if (!args.at)
        if (std::string problem = problem_with_span(film.span, scene.end_time); !problem.empty())
            throw UsageError(problem);
    scene.outputs = {render_output(args, std::move(film))};
    if (args.dry_run) return show_plan(scene, args.json);
    run(plan(scene), scene, run_options(args.common, ""));
}

TrajectoryOutput trajectory_output(const Arguments& args, const Scene& scene) {
    TrajectoryOutput table;
    table.file = args.trajectory.value_or("-");
    need_ending("--trajectory", table.file, {".csv", ".npz"});
    if (args.rate && !args.times.empty()) throw UsageError("--rate and --times exclude each other; keep one");
    if (args.rate) {
        table.rate = instant_argument("--rate", *args.rate, dimension::kFrequency);
        if (!(table.rate > 0)) throw UsageError("--rate must be positive");
        if (table.rate * scene.end_time > 2e7)
            throw UsageError(fmt::format("--rate {}: more than 2e7 rows; lower it", *args.rate));
    }
    for (const std::string& text : args.times) table.times.push_back(seconds_argument("--times", text));
    std::vector<std::string> known;
    const std::vector<sim::Channel> every = all_channels(scene.problem);
    for (const sim::Channel& channel : every) known.push_back(name(channel));
    for (const std::string& text : args.channels) {
        const auto found = std::find(known.begin(), known.end(), text);
        if (found == known.end())
            throw UsageError(fmt::format("--channels: {} is not a channel of this scene{}", in_quotes(text),
                                         suggestion_or_list(text, known)));
        const sim::Channel channel = every[static_cast<std::size_t>(found - known.begin())];
        if (std::find(table.channels.begin(), table.channels.end(), channel) != table.channels.end())
            throw UsageError(fmt::format("--channels: {} stands twice", text));
        table.channels.push_back(channel);
    }
    return table;
}

// With no file named, the table goes to standard output if its options were given, else the summary.
std::vector<Output> simulate_outputs(const Arguments& args, const Scene& scene) {
    std::vector<Output> outputs;
    const bool wants_table = args.trajectory || args.rate || !args.times.empty() || !args.channels.empty();
    if (wants_table) outputs.push_back(trajectory_output(args, scene));
    if (args.impacts) {
        need_ending("--impacts", *args.impacts, {".json", ".csv"});
        outputs.push_back(ImpactsOutput{*args.impacts});
    }
    if (args.summary || outputs.empty() || args.horizon) {
        const std::string file = args.summary.value_or("-");
        need_ending("--summary", file, {".json"});
        outputs.push_back(SummaryOutput{file, args.horizon});
    }
    const auto to_stdout =
        std::count_if(outputs.begin(), outputs.end(), [](const Output& o) { return file_of(o) == "-"; });
    if (to_stdout > 1) throw UsageError("more than one output would go to standard output; name files for the others");
    for (std::size_t i = 0; i < outputs.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (may_collide(file_of(outputs[i]), file_of(outputs[k])))
                throw UsageError(
                    fmt::format("{} is named twice; give each output a file of its own", file_of(outputs[i])));
    return outputs;
}

void simulate_command(const Arguments& args) {
    Scene scene = read_or_refuse(args.scenes.front(), args.common);
    scene.outputs = simulate_outputs(args, scene);
    if (args.dry_run) return show_plan(scene, args.json);
    run(plan(scene), scene, run_options(args.common, ""));
}

void modes_command(const Arguments& args) {
    const Scene scene = read_or_refuse(args.scenes.front(), args.common);
    std::optional<double> speed;
    if (args.speed) {
        const QuantityText read = parse_quantity(*args.speed);
        if (!read.quantity) throw UsageError(fmt::format("--speed {}: {}", *args.speed, read.problem));
        const bool plain = same(read.quantity->dimension, dimension::kNone);
        if (!plain && !same(read.quantity->dimension, dimension::kAngularSpeed))
            throw UsageError(fmt::format("--speed {}: it is measured in rad/s", *args.speed));
        speed = read.quantity->value;
    }
    const std::vector<sim::Mode> modes = sim::natural_modes(scene.problem, speed);
    if (args.json) return print_data(output::modes_json(modes));
    if (modes.empty()) return say(args.common, "a rigid beam has no bending modes");
    std::string text = fmt::format("{:>4}  {:>20}  {:>20}\n", "mode", "omega [rad/s]", "f [Hz]");
    for (std::size_t i = 0; i < modes.size(); ++i) {
        if (std::isnan(modes[i].omega))
            text += fmt::format("{:4}  {:>20}  {:>20}\n", i + 1, "diverges", "-");
        else
            text += fmt::format("{:4}  {:20.12g}  {:20.12g}\n", i + 1, modes[i].omega,
                                modes[i].omega / (2 * std::numbers::pi));
    }
    print_data(text);
}

void init_command(const Arguments& args) {
    std::string text(default_scene_text());
    const std::filesystem::path path(args.name.ends_with(".json") ? args.name : args.name + ".json");
    if (args.name == "-") return print_data(text);
    const std::string film = "\"default.mp4\"", title = path.stem().string();
    if (const std::size_t at = text.find(film); at != std::string::npos)
        text.replace(at, film.size(), fmt::format("\"{}.mp4\"", title));
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::symlink_status(path, ignored)) && !args.common.force)
        throw output::WouldOverwrite(
            fmt::format("{} exists; choose another name, or replace it with --force", path.string()));
    output::write_file(path, text);
    say(args.common, fmt::format("wrote {}; `beamcam run {}` films it, `beamcam schema > beamcam-scene.schema.json` "
                                 "lets an editor complete its keys",
                                 path.string(), path.string()));
}

// ---- the grammar -------------------------------------------------------------------------------

void add_set(CLI::App& app, Common& common) {
    app.add_option("--set", common.overrides,
                   "Change the scene: key.path=value, a JSON value or a plain word (repeatable)")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}
void add_quiet(CLI::App& app, Common& common) { app.add_flag("-q,--quiet", common.quiet, "No messages but errors"); }

void add_scene(CLI::App& app, Arguments& args) {
    app.add_option("SCENE", args.scenes, "The scene, a JSON file; - is standard input")
        ->required()
        ->expected(1)
        ->type_name("");
    add_set(app, args.common);
    add_quiet(app, args.common);
}

void add_work(CLI::App& app, Arguments& args) {
    app.add_flag("-v,--verbose", args.common.verbose, "Tell where the time went");
    app.add_option("-j,--jobs", args.common.threads, "Threads that draw (default: one for each core)")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
    app.add_option("--progress", args.common.progress, "Progress on standard error: auto, bar, plain, json or none")
        ->type_name("STYLE");
    app.add_flag("--force", args.common.force, "Replace files that beamcam did not make");
    app.add_flag("--no-cache", args.common.no_cache, "Neither read nor keep cached results (this version keeps none)");
    app.add_flag("-n,--dry-run", args.dry_run, "Print the plan and do nothing");
    app.add_flag("--json", args.json, "With -n: the plan as JSON");
}

using Commands = std::vector<std::pair<CLI::App*, std::function<void(const Arguments&)>>>;

void add_run(CLI::App& app, Arguments& args, Commands& commands) {
    CLI::App* run =
        app.add_subcommand("run", "Make every output that the scene lists; none: a film named after the scene");
    add_scene(*run, args);
    run->add_option("-o,--output", args.output, "Directory of the outputs (default: the current one)")
        ->type_name("DIR");
    add_work(*run, args);
    commands.emplace_back(run, run_command);
}

void add_render(CLI::App& app, Arguments& args, Commands& commands) {
    CLI::App* render =
        app.add_subcommand("render", "Make one film (.mp4), sequence (name-####.png) or still (--at, .png)");
    add_scene(*render, args);
    render->add_option("-o,--output", args.output, "File to make")->required()->type_name("FILE");
    render->add_option("--at", args.at, "One picture of this instant, in seconds or with a unit")->type_name("T");
    render->add_option("--from", args.from, "First instant of the film")->type_name("T");
    render->add_option("--to", args.to, "Last instant of the film")->type_name("T");
    render->add_option("--size", args.size, "Pixels, for example 1280x720")->type_name("WxH");
    render->add_option("--fps", args.fps, "Frames a second, for example 60 or 30000/1001")->type_name("RATE");
    render->add_option("--style", args.style, "lit (OpenGL) or flat")
        ->check(CLI::IsMember({"lit", "flat"}))
        ->type_name("STYLE");
    render->add_option("--theme", args.theme, "light, dark or print")
        ->check(CLI::IsMember({"light", "dark", "print"}))
        ->type_name("THEME");
    add_work(*render, args);
    commands.emplace_back(render, render_command);
}

void add_simulate(CLI::App& app, Arguments& args, Commands& commands) {
    CLI::App* simulate = app.add_subcommand("simulate", "Compute without pictures; with no option, print the summary");
    add_scene(*simulate, args);
    simulate->add_option("--trajectory", args.trajectory, "Table of channels, .csv or .npz; - is standard output (CSV)")
        ->type_name("FILE");
    simulate->add_option("--rate", args.rate, "Rows a second (default: 1000)")->type_name("HZ");
    simulate->add_option("--times", args.times, "Exactly these rows, in this order")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("T,T,...");
    simulate->add_option("--channels", args.channels, "Columns besides the time (default: all)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("A,B,...");
    simulate
        ->add_option("--impacts", args.impacts, "Impacts and collisions, .json or .csv; - is standard output (JSON)")
        ->type_name("FILE");
    simulate->add_option("--summary", args.summary, "Counts, extremes, energy balance, .json; - is standard output")
        ->type_name("FILE");
    simulate->add_flag("--horizon", args.horizon,
                       "Tell in the summary until when the motion is reproducible (a second run)");
    add_work(*simulate, args);
    commands.emplace_back(simulate, simulate_command);
}

void add_small_commands(CLI::App& app, Arguments& args, Commands& commands) {
    CLI::App* modes = app.add_subcommand("modes", "Natural frequencies of beam and hub, at rest or turning");
    add_scene(*modes, args);
    modes
        ->add_option(
            "--speed", args.speed,
            "The beam turns at this speed, clamped to a hub held at it, for example 300rpm; without it the hub is free")
        ->type_name("RAD_S");
    modes->add_flag("--json", args.json, "As JSON, with mass-normalized shapes");
    commands.emplace_back(modes, modes_command);

    CLI::App* check_app =
        app.add_subcommand("check", "Validate scenes: every issue at once, with its place and remedy");
    check_app->add_option("SCENE", args.scenes, "Scenes, JSON files; - is standard input")->required()->type_name("");
    add_set(*check_app, args.common);
    add_quiet(*check_app, args.common);
    commands.emplace_back(check_app, check);

    CLI::App* plan_app = app.add_subcommand("plan", "Tell what `run` would do, and what it would skip and why");
    add_scene(*plan_app, args);
    plan_app->add_flag("--json", args.json, "As JSON");
    commands.emplace_back(plan_app, plan_command);

    CLI::App* init = app.add_subcommand("init", "Write a commented scene to start from");
    init->add_option("NAME", args.name, "Its name (default: scene); - is standard output")->type_name("");
    init->add_flag("--force", args.common.force, "Replace an existing file");
    add_quiet(*init, args.common);
    commands.emplace_back(init, init_command);

    CLI::App* schema = app.add_subcommand("schema", "Print the JSON Schema of scenes, for editors");
    commands.emplace_back(schema, [](const Arguments&) { print_data(schema_text()); });
}

// A command that does not exist, told before the parser guesses.
void refuse_unknown_command(int argc, const char* const* argv, const CLI::App& app) {
    if (argc < 2 || argv[1][0] == '-') return;
    const std::string word = argv[1];
    std::vector<std::string> known;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        known.push_back(command->get_name());
    if (std::find(known.begin(), known.end(), word) != known.end()) return;
    if (const auto planned = not_available("command", word)) throw UsageError(*planned);
    if (word.ends_with(".json"))
        throw UsageError(fmt::format("no command before the scene; write beamcam run {}", word));
    throw UsageError(fmt::format("unknown command {}{}", in_quotes(word), suggestion_or_list(word, known)));
}

int parse_and_run(int argc, const char* const* argv) {
    CLI::App app("Films a mechanism: JSON scenes of a flexible beam and a turning cam in; films, stills and data out.",
                 "beamcam");
    Arguments args;
    Commands commands;
    app.set_version_flag("--version", fmt::format("beamcam {}", kVersion));
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done, 1 bug, 2 usage, 3 scene, 4 solver, 5 missing renderer, codec or font,\n"
        "6 input/output, 7 differs, 130 interrupted.");
    add_run(app, args, commands);
    add_render(app, args, commands);
    add_simulate(app, args, commands);
    add_small_commands(app, args, commands);
    refuse_unknown_command(argc, argv, app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        app.exit(success, std::cout, std::cerr);
        std::cout.flush();
        return kDone;
    } catch (const CLI::ParseError& error) {
        std::string command;
        for (const auto& [parsed, action] : commands)
            if (parsed->parsed()) command = " " + parsed->get_name();
        throw UsageError(fmt::format("{} (see beamcam{} --help)", error.what(), command));
    }
    for (const auto& [parsed, action] : commands)
        if (parsed->parsed()) action(args);
    return kDone;
}

int fail(int code, const std::string& text) {
    if (!text.empty()) fmt::print(stderr, "{}{}", text, text.ends_with('\n') ? "" : "\n");
    return code;
}

}  // namespace

int command_line(int argc, const char* const* argv) {
    try {
        output::install_handlers();
        return parse_and_run(argc, argv);
    } catch (const UsageError& e) {
        return fail(kUsage, fmt::format("beamcam: {}", e.what()));
    } catch (const SceneError& e) {
        return fail(kBadScene, e.what());
    } catch (const output::UnsupportedOption& e) {
        return fail(kBadScene, fmt::format("beamcam: {}", e.what()));
    } catch (const render::PictureError& e) {
        return fail(kBadScene, fmt::format("beamcam: {}", e.what()));
    } catch (const sim::SolverError& e) {
        return fail(kSolverFailed, fmt::format("beamcam: {} (reached {:.9g} s)", e.what(), e.last_time));
    } catch (const output::MissingCodec& e) {
        return fail(kMissingPart, fmt::format("beamcam: {}", e.what()));
    } catch (const render::MissingPart& e) {
        return fail(kMissingPart, fmt::format("beamcam: {}", e.what()));
    } catch (const output::IoError& e) {
        return fail(kInputOutput, fmt::format("beamcam: {}", e.what()));
    } catch (const UnreadableFile& e) {
        return fail(kInputOutput, fmt::format("beamcam: {}", e.what()));
    } catch (const sim::Interrupted&) {
        return fail(kInterrupted, "beamcam: interrupted; nothing half-written is left");
    } catch (const Stopped&) {
        return fail(kInterrupted, "beamcam: interrupted; nothing half-written is left");
    } catch (const std::exception& e) {
        return fail(kBug, fmt::format("beamcam: internal error: {}; please report it with the scene and the command",
                                      e.what()));
    } catch (...) {
        return fail(kBug, "beamcam: internal error of unknown kind; please report it with the scene and the command");
    }
}

}  // namespace beamcam::scenes
