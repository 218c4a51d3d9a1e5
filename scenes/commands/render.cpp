#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "scenes/commands/commands.hpp"
#include "scenes/files.hpp"
#include "scenes/plan.hpp"
#include "scenes/reader.hpp"
#include "scenes/run.hpp"

namespace beamcam::scenes {
namespace {

struct Arguments {
    Common common;
    std::string scene, file;
    std::optional<std::string> at, from, to, size, fps, style, theme;
};

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
    const std::string ending = ending_of(args.file);
    if (args.file == "-") throw UsageError("-o -: pictures go to files; name one that ends in .mp4 or .png");
    need_ending("-o", args.file, {".mp4", ".png"});
    const bool numbered = is_numbered(std::filesystem::path(args.file).filename().string());
    if (args.at) {
        if (ending != ".png" || numbered)
            throw UsageError(fmt::format("--at makes one picture; -o {} must be a .png file without '#'", args.file));
        if (args.from || args.to || args.fps)
            throw UsageError("--at makes one picture; --from, --to and --fps belong to films");
        return StillOutput{args.file, film.size, film.view, seconds_argument("--at", *args.at)};
    }
    if (ending == ".png") {
        if (!numbered)
            throw UsageError(
                fmt::format("-o {}: name the instant with --at for one picture, or put #### in the name for a sequence",
                            args.file));
        if (std::string problem = problem_with_numbering(args.file); !problem.empty())
            throw UsageError(fmt::format("-o {}: {}", args.file, problem));
        return FramesOutput{args.file, film.size, film.view, film.span};
    }
    if (numbered)
        throw UsageError(fmt::format("-o {}: '#' numbers .png files; choose another name for a film", args.file));
    if (film.size.width % 2 || film.size.height % 2)
        throw UsageError(
            fmt::format("a film of {} × {}: H.264 (yuv420p) needs even sides; choose --size {}x{}, or a .png sequence",
                        film.size.width, film.size.height, film.size.width + film.size.width % 2,
                        film.size.height + film.size.height % 2));
    film.file = args.file;
    return film;
}

int act(const Arguments& args) {
    Scene scene = read_or_refuse(args.scene, args.common);
    VideoOutput film = film_to_imitate(scene);
    apply_render_options(args, film);
    if (!args.at)
        if (std::string problem = problem_with_span(film.span, scene.end_time); !problem.empty())
            throw UsageError(problem);
    scene.outputs = {render_output(args, std::move(film))};
    if (args.common.dry_run)
        show_plan(scene, args.common.json);
    else
        run(plan(scene), scene, run_options(args.common, ""));
    return 0;
}

}  // namespace

void add_render(Grammar& grammar) {
    auto args = std::make_shared<Arguments>();
    CLI::App* app =
        grammar.app.add_subcommand("render", "Make one film (.mp4), sequence (name-####.png) or still (--at, .png)");
    add_scene(*app, args->scene, args->common);
    app->add_option("-o,--output", args->file, "File to make")->required()->type_name("FILE");
    app->add_option("--at", args->at, "One picture of this instant, in seconds or with a unit")->type_name("T");
    app->add_option("--from", args->from, "First instant of the film")->type_name("T");
    app->add_option("--to", args->to, "Last instant of the film")->type_name("T");
    app->add_option("--size", args->size, "Pixels, for example 1280x720")->type_name("WxH");
    app->add_option("--fps", args->fps, "Frames a second, for example 60 or 30000/1001")->type_name("RATE");
    app->add_option("--style", args->style, "lit (OpenGL) or flat")
        ->check(CLI::IsMember({"lit", "flat"}))
        ->type_name("STYLE");
    app->add_option("--theme", args->theme, "light, dark or print")
        ->check(CLI::IsMember({"light", "dark", "print"}))
        ->type_name("THEME");
    add_work(*app, args->common);
    grammar.bind(app, args, act);
}

}  // namespace beamcam::scenes
