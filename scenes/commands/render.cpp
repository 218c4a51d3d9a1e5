#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <set>

#include "output/files/numbers.hpp"
#include "output/files/standard_output.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/outputs/run.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

struct RenderArguments {
    Common common;
    std::string scene, file;
    std::vector<std::string> others;
    std::optional<std::string> at, from, to, size, fps, style, theme, speed, codec, background, comparison, frames,
        shard, poster, show, duration;
};

// "0.1", or "impacts": slow motion around them.
void apply_speed(const std::string& text, Speed& speed) {
    if (text == "impacts") {
        speed = {.factor = 1, .around = SlowMotion{}};
        return;
    }
    const QuantityText read = parse_quantity(text);
    if (!read.quantity || !same(read.quantity->dimension, dimension::kNone) || !(read.quantity->value >= 1e-6) ||
        !(read.quantity->value <= 1000))
        throw UsageError(fmt::format(
            "--speed {}: write a factor from 1e-6 to 1000, 1 is real time; or impacts, for slow motion around them",
            text));
    speed = {.factor = read.quantity->value, .around = std::nullopt};
}

// The file's ending decides the codec unless --codec does; the scene's own is kept for its own kind of file.
void apply_format(const RenderArguments& args, VideoOutput& film) {
    const std::string ending = ending_of(args.file);
    const auto usual = output::default_codec(ending);
    if (!usual) return;
    Encoding& encoding = film.encoding;
    const output::Codec before = encoding.codec;
    if (args.codec) {
        const auto codec = output::codec_named(*args.codec);
        if (!codec)
            throw UsageError(
                fmt::format("--codec {}: choose h264, hevc, vp9, av1, prores, ffv1, gif, apng or webp", *args.codec));
        encoding.codec = *codec;
    } else if (ending_of(film.file) != ending) {
        encoding.codec = *usual;
    }
    if (encoding.codec != before) {
        encoding.crf.reset();
        if (const auto quality = output::quality_scale(encoding.codec)) encoding.crf = quality->usual;
    }
    if (encoding.codec == output::Codec::gif && !args.fps && film.span.fps.value() > 50) film.span.fps = {25, 1};
    for (const std::string& problem : {output::format_problem(ending, encoding.codec, film.view.transparent),
                                       output::size_problem(encoding.codec, film.size.width, film.size.height),
                                       output::rate_problem(encoding.codec, film.span.fps.value())})
        if (!problem.empty()) throw UsageError(problem);
}

// The scenes of the command line beside each other; the first one's outputs tell how.
void compare_scenes(const RenderArguments& args, Scene& scene, Picture& picture) {
    const auto entry = [](const Scene& one) { return Compared{one.title.empty() ? one.name : one.title, one.problem}; };
    if (args.comparison)
        picture.comparison = *args.comparison == "ghosts" ? render::Comparison::ghosts : render::Comparison::panels;
    if (args.others.empty()) return;
    if (args.others.size() > 7) throw UsageError("render: a picture compares at most eight scenes");
    // A grid made for one motion would show that one alone.
    if (picture.layout && picture.comparison == render::Comparison::panels) {
        std::set<int> shown;
        for (const render::PanelSpec& panel : render::panels_of(*picture.layout))
            if (panel.kind == render::PanelKind::mechanism) shown.insert(panel.member);
        if (shown.size() != args.others.size() + 1) {
            picture.layout.reset();
            if (!args.common.quiet)
                output::print_message(
                    "note: the layout in {} does not show {} motions; they stand in the standard arrangement\n",
                    args.scene, args.others.size() + 1);
        }
    }
    picture.compare = {entry(scene)};
    for (const std::string& other : args.others) picture.compare.push_back(entry(read_or_refuse(other, args.common)));
    // Each motion has its scene's title as its label; the first one's is no title for all.
    static constexpr std::string_view kCounts[] = {"Two", "Three", "Four", "Five", "Six", "Seven", "Eight"};
    scene.title = fmt::format("{} motions compared", kCounts[args.others.size() - 1]);
}

Instant instant_argument(const char* option, const std::string& text) {
    if (names_event(text)) {
        if (const auto instant = parse_instant(text)) return *instant;
        throw UsageError(fmt::format("{} {}: {}", option, text, kEventsCount));
    }
    return {.kind = Instant::Kind::time, .t = seconds_argument(option, text)};
}

void apply_picture_size(const std::string& text, VideoOutput& film) {
    const auto size = parse_size(text);
    if (!size)
        throw UsageError(
            fmt::format("--size {}: write WIDTHxHEIGHT in pixels, 16 to 16384 each, for example 1280x720", text));
    film.size = *size;
}

// Which instants of the motion the film shows, and how fast.
void apply_span(const RenderArguments& args, FrameSpan& span) {
    if (args.fps) {
        const auto fps = parse_frame_rate(*args.fps);
        if (!fps)
            throw UsageError(fmt::format("--fps {}: write frames a second, for example 60 or 30000/1001", *args.fps));
        span.fps = *fps;
    }
    if (args.from) {
        std::optional<double> from;
        set_bound(instant_argument("--from", *args.from), from, span.from_event);
        span.from = from.value_or(0);
    }
    if (args.to) set_bound(instant_argument("--to", *args.to), span.to, span.to_event);
    if (args.speed) apply_speed(*args.speed, span.speed), span.duration.reset();
    if (args.speed && args.duration) throw UsageError("--speed and --duration exclude each other; keep one");
    if (args.duration) {
        span.speed = {};
        span.duration = seconds_argument("--duration", *args.duration);
        if (!(*span.duration > 0)) throw UsageError("--duration must be positive");
    }
}

void apply_view(const RenderArguments& args, render::View& view) {
    if (args.background && !set_background(*args.background, view))
        throw UsageError(
            fmt::format("--background {}: write paper, transparent or a colour such as #f4f1ea", *args.background));
    if (args.show) {
        const double size = view.show.size;
        view.show = *shown_preset(*args.show);
        view.show.size = size;
    }
    if (args.style)
        view.style = *args.style == "flat"    ? render::Style::flat
                     : *args.style == "solid" ? render::Style::solid
                                              : render::Style::lit;
    if (args.theme)
        view.theme = *args.theme == "dark"    ? render::Theme::dark
                     : *args.theme == "print" ? render::Theme::print
                                              : render::Theme::light;
}

// "--fps belongs to films; --at makes one picture"
void refuse_options(std::initializer_list<std::pair<const std::optional<std::string>*, const char*>> options,
                    const char* of, const std::string& but) {
    for (const auto& [given, name] : options)
        if (*given) throw UsageError(fmt::format("{} belongs to {}; {}", name, of, but));
}

void refuse_options_of_films(const RenderArguments& args) {
    refuse_options({{&args.from, "--from"},
                    {&args.to, "--to"},
                    {&args.fps, "--fps"},
                    {&args.speed, "--speed"},
                    {&args.duration, "--duration"},
                    {&args.codec, "--codec"},
                    {&args.poster, "--poster"},
                    {&args.frames, "--frames"},
                    {&args.shard, "--shard"}},
                   "films", "--at makes one picture");
}

// A still of lines: the figure "strobe" at one instant, for print.
FigureOutput vector_still(const RenderArguments& args, const VideoOutput& film) {
    if (!args.at)
        throw UsageError(fmt::format("-o {}: name the instant with --at for one picture of lines", args.file));
    if (!args.others.empty())
        throw UsageError(fmt::format("-o {} shows one motion; name one scene, or a .png file", args.file));
    refuse_options_of_films(args);
    refuse_options({{&args.size, "--size"},
                    {&args.style, "--style"},
                    {&args.background, "--background"},
                    {&args.show, "--show"},
                    {&args.comparison, "--comparison"}},
                   "films and pictures of pixels",
                   fmt::format("-o {} is drawn in lines, as `beamcam figure strobe --at` draws it, which takes "
                               "--width and --column",
                               args.file));
    FigureOutput figure;
    figure.file = args.file;
    figure.figure = "strobe";
    figure.series.at = instant_argument("--at", *args.at);
    figure.lang = film.view.lang;
    figure.dark = args.theme == "dark";
    return figure;
}

Output still(const RenderArguments& args, const VideoOutput& film, bool numbered) {
    if (ending_of(args.file) != ".png" || numbered)
        throw UsageError(fmt::format("--at makes one picture; -o {} must be a .png file without '#'", args.file));
    refuse_options_of_films(args);
    return StillOutput{film, args.file, instant_argument("--at", *args.at)};
}

// A page or a moving model, which play the motion themselves.
Output played(const RenderArguments& args, VideoOutput film) {
    const std::string ending = ending_of(args.file);
    if (!args.others.empty()) throw UsageError(fmt::format("-o {} plays one motion; name one scene", args.file));
    refuse_options({{&args.size, "--size"},
                    {&args.speed, "--speed"},
                    {&args.codec, "--codec"},
                    {&args.comparison, "--comparison"},
                    {&args.frames, "--frames"},
                    {&args.shard, "--shard"},
                    {&args.poster, "--poster"},
                    {&args.duration, "--duration"}},
                   "films and pictures", fmt::format("-o {} plays the motion itself", args.file));
    film.span.speed = {}, film.span.duration.reset(), film.span.events.clear(), film.span.hold = 0;
    film.compare.clear();
    if (ending == ".glb") return ModelOutput{film, args.file, film.span};
    PageOutput page{film, args.file, film.span};
    if (!args.fps) page.span.fps = PageOutput().span.fps;
    return page;
}

Output sequence(const RenderArguments& args, const VideoOutput& film, bool numbered) {
    refuse_options({{&args.poster, "--poster"}, {&args.codec, "--codec"}}, "films",
                   fmt::format("-o {} makes pictures already", args.file));
    if (!numbered)
        throw UsageError(fmt::format(
            "-o {}: name the instant with --at for one picture, or put #### in the name for a sequence", args.file));
    if (std::string problem = problem_with_numbering(args.file); !problem.empty())
        throw UsageError(fmt::format("-o {}: {}", args.file, problem));
    return FramesOutput{film, args.file, film.span};
}

// By the file's ending; `film` has what the options say.
Output render_output(const RenderArguments& args, VideoOutput film) {
    const std::string ending = ending_of(args.file);
    if (args.file == "-") throw UsageError("-o -: pictures go to files; name one that ends in .mp4 or .png");
    if (ending == ".pdf" || ending == ".svg" || ending == ".eps") return vector_still(args, film);
    need_ending(
        "-o", args.file,
        {".mp4", ".webm", ".mov", ".mkv", ".gif", ".apng", ".webp", ".png", ".pdf", ".svg", ".eps", ".html", ".glb"});
    const bool numbered = is_numbered(std::filesystem::path(args.file).filename().string());
    if (args.at) return still(args, film, numbered);
    if (ending == ".html" || ending == ".glb") return played(args, std::move(film));
    if (ending == ".png") return sequence(args, film, numbered);
    if (numbered)
        throw UsageError(fmt::format("-o {}: '#' numbers .png files; choose another name for a film", args.file));
    apply_format(args, film);
    film.file = args.file;
    return film;
}

// "12:40", ":40" or "12:" of the frames that the film has.
std::pair<long, long> frames_argument(const std::string& text, long begin, long end) {
    const std::size_t colon = text.find(':');
    const auto number = [&](std::string_view part, long otherwise) {
        if (part.empty()) return otherwise;
        return output::number_in<long>(part).value_or(-1);
    };
    if (colon == std::string::npos)
        throw UsageError(
            fmt::format("--frames {}: write FIRST:END, for example {}:{} for all of them", text, begin, end));
    const long from = number(std::string_view(text).substr(0, colon), begin),
               to = number(std::string_view(text).substr(colon + 1), end);
    if (from < begin || to > end || from >= to)
        throw UsageError(
            fmt::format("--frames {}: the frames are {}:{}, the last one not included; name at least one of them", text,
                        begin, end));
    return {from, to};
}

Selection asked_part(const RenderArguments& args, const Scene& scene) {
    Selection selection;
    if (!args.frames && !args.shard) return selection;
    if (args.frames && args.shard) throw UsageError("--frames and --shard exclude each other; keep one");
    if (args.shard) return shard_argument(*args.shard);
    const Plan made = plan(scene);
    const Pictures& whole = made.pictures.at(0);
    if (!whole.times_known)
        throw UsageError("--frames: only the impacts tell how many frames a film in slow motion has; use --shard");
    selection.frames =
        frames_argument(*args.frames, whole.first_frame, whole.first_frame + static_cast<long>(whole.draw.size()));
    return selection;
}

// In a scene such a poster is the film's nearest frame, so that films can be shortened; here it was asked for.
void require_poster_inside(const FrameSpan& span, double end_time) {
    const double to = span.to.value_or(end_time);
    if (!span.poster || span.poster->kind != Instant::Kind::time || span.from_event || span.to_event) return;
    if (span.poster->t < span.from || span.poster->t > to)
        throw UsageError(fmt::format("the poster at {:g} s is no frame of a film from {:g} s to {:g} s", span.poster->t,
                                     span.from, to));
}

int act(const RenderArguments& args) {
    Scene scene = read_or_refuse(args.scene, args.common);
    VideoOutput film = film_to_imitate(scene);
    if (args.size) apply_picture_size(*args.size, film);
    apply_span(args, film.span);
    apply_view(args, film.view);
    compare_scenes(args, scene, film);
    if (args.poster) film.span.poster = instant_argument("--poster", *args.poster);
    if (!args.at)
        if (std::string problem = problem_with_span(film.span, scene.end_time); !problem.empty())
            throw UsageError(problem);
    require_poster_inside(film.span, scene.end_time);
    scene.set_outputs({render_output(args, std::move(film))});
    RunOptions options = run_options(args.common, "");
    options.selection = asked_part(args, scene);
    run_or_plan({&scene, 1}, options, args.common);
    return 0;
}

// How the pictures look, how fast the film is and how it is coded.
void add_look_options(Command& app, RenderArguments& args) {
    app.option("--size", &args.size, "WxH", "Pixels, for example 1280x720");
    app.option("--fps", &args.fps, "RATE", "Frames a second, for example 60 or 30000/1001");
    app.option("--style", &args.style, "STYLE", "lit or solid (OpenGL; in perspective), or flat")
        .one_of({"lit", "flat", "solid"});
    app.option("--theme", &args.theme, "THEME", "light, dark or print").one_of({"light", "dark", "print"});
    app.option("--speed", &args.speed, "S", "Of time, 1 is real; or impacts: slow motion around them");
    app.option("--duration", &args.duration, "T", "How long the film is to last, in place of --speed");
    app.option("--codec", &args.codec, "CODEC",
               "h264, hevc, vp9, av1, prores, ffv1, gif, apng or webp (default: by the ending)");
    app.option("--background", &args.background, "WHAT", "paper, transparent, or a colour such as #f4f1ea");
    app.option("--show", &args.show, "PRESET", "What stands around the panels: all, talk, paper or clean")
        .one_of({"all", "talk", "paper", "clean"});
    app.option("--comparison", &args.comparison, "HOW", "Several scenes as panels, or as ghosts in one")
        .one_of({"panels", "ghosts"});
}

}  // namespace

void add_render(Grammar& grammar) {
    auto args = std::make_shared<RenderArguments>();
    Command& app = grammar.command("render",
                                   "Make one film (.mp4 .webm .mov .mkv .gif .apng .webp), sequence "
                                   "(name-####.png), still (--at; .png, or .pdf .svg .eps in lines), page that plays "
                                   "the motion (.html) or moving model (.glb)");
    add_scene(app, args->scene, args->common);
    app.positional("OTHERS", &args->others, "More scenes, to be compared with the first in one picture");
    app.option("-o,--output", &args->file, "FILE", "File to make").required();
    app.option(
        "--at", &args->at, "T",
        "One picture of this instant: seconds, with a unit, or impact:N, collision:N, apex:N, touch, release, last");
    app.option("--from", &args->from, "T", "First instant of the film, as for --at");
    app.option("--to", &args->to, "T", "Last instant of the film, as for --at");
    add_look_options(app, *args);
    app.option("--frames", &args->frames, "A:B",
               "Only these frames of the film, by number, the last one not included: 30:60. Scales and camera are "
               "those of the whole film");
    app.option("--poster", &args->poster, "T",
               "Put the film's frame at this instant beside it: film.png, T as for --at");
    add_shard(app, args->shard);
    add_work(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
