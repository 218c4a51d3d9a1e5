// `beamcam render`: one picture, sequence, film or page of a scene.
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <set>

#include "output/json/tree.hpp"
#include "scenes/commands/key_options.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/keys.hpp"
#include "scenes/outputs/run.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

struct RenderArguments {
    Common common;
    std::string scene, file;
    std::vector<std::string> others;
    KeyOptions film{"video"}, still{"still"};
    std::optional<std::string> title;
};

// ---- the output that the file's name asks for ------------------------------------------------------

// The output has the keys that it has in common with `film`.
PictureOutput output_for_file(const RenderArguments& args, PictureOutput film) {
    const std::string ending = ending_of(args.file);
    require_ending("-o", args.file,
                   {".mp4", ".webm", ".mov", ".mkv", ".gif", ".webp", ".png", ".pdf", ".svg", ".html"});
    const bool vector = ending == ".pdf" || ending == ".svg";
    const bool numbered = is_numbered(std::filesystem::path(args.file).filename().string());
    using enum PictureOutput::Kind;
    film.kind = args.still.value("--at") ? still : ending == ".html" ? page : ending == ".png" ? frames : video;
    if (vector && film.kind != still) throw UsageError(fmt::format("-o {}: name the instant with --at", args.file));
    if (film.kind == still && ((ending != ".png" && !vector) || numbered))
        throw UsageError(
            fmt::format("--at makes one picture; -o {} must be a .png, .pdf or .svg file without '#'", args.file));
    if (film.kind == page && !args.others.empty())
        throw UsageError(fmt::format("-o {} plays one motion; name one scene", args.file));
    if (film.kind == frames && !numbered)
        throw UsageError(fmt::format(
            "-o {}: name the instant with --at for one picture, or put #### in the name for a sequence", args.file));
    if (film.kind == page) film.span.fps = PictureOutput::of(page).span.fps;
    return film;
}

// The output with the values of the options.
Output with_options(const RenderArguments& args, const PictureOutput& base, const Scene& scene) {
    Node node = to_tree(Output(base));
    const std::string ending = ending_of(args.file);
    const std::string* codec = args.film.value("--codec");
    if (codec ? *codec != name(base.encoding.codec)
              : ending_of(base.file) != ending)  // another one has its own settings
        for (const char* key : {"codec", "crf", "preset"}) remove(node, key);
    if (ending == ".gif" && base.span.fps.value() > 50) remove(node, "fps");
    remove(node, "file");
    add(node, "file", std::filesystem::path(args.file).filename().string());
    if (args.film.value("--speed")) remove(node, "duration");
    if (args.film.value("--duration")) remove(node, "speed");
    if (args.film.value("--story")) {
        for (const char* key : kKeysOfStories) remove(node, key);
        remove(node, "layout");  // that of a film which shows everything
    } else if (args.film.value("--to") || args.film.value("--speed") || args.film.value("--duration")) {
        remove(node, "story");  // of the scene's own film
    }
    Output output = read_output(std::move(node), {&args.film, &args.still}, scene, args.scene, args.common);
    std::visit([&](auto& each) { each.file = args.file; }, output);  // wherever it is
    return output;
}

// ---- several scenes in one picture -----------------------------------------------------------------

// A grid that was made for one motion would show that one alone.
bool shows_motions(const render::LayoutNode& layout, std::size_t motions) {
    std::set<int> shown;
    for (const render::PanelSpec& panel : render::panels_of(layout))
        if (panel.kind == render::PanelKind::mechanism) shown.insert(panel.member);
    return shown.size() == motions;
}

// The scenes of the command line beside each other; the outputs of the first one describe the picture.
void compare_scenes(const RenderArguments& args, Scene& scene, Picture& picture) {
    const auto compared = [](const Scene& one, bool has_title) {
        return Compared{has_title && !one.title.empty() ? one.title : one.name, one.problem};
    };
    const std::size_t motions = args.others.size() + 1;
    if (motions == 1) return;
    if (motions > kMostCompared) throw UsageError("render: a picture compares at most eight scenes");
    const std::string* comparison = args.film.value("--comparison");
    const bool ghosts = comparison ? *comparison == "ghosts" : picture.comparison == render::Comparison::ghosts;
    if (picture.layout && !ghosts && !shows_motions(*picture.layout, motions)) {
        picture.layout.reset();
        inform(args.common,
               fmt::format("note: the layout in {} does not show {} motions; the standard layout replaces it",
                           args.scene, motions));
    }
    // Each motion has its scene's title as its label; the title of the first is not the title of all.
    picture.compare = {compared(scene, !args.title)};
    for (const std::string& other : args.others)
        picture.compare.push_back(compared(load_scene(other, args.common), true));
    static constexpr std::string_view kCounts[] = {"Two", "Three", "Four", "Five", "Six", "Seven", "Eight"};
    if (!args.title) scene.title = fmt::format("{} motions compared", kCounts[motions - 2]);
}

void act(const RenderArguments& args) {
    Common with_title = args.common;
    if (args.title) with_title.overrides.push_back("title=" + to_text(Node(*args.title)));
    Scene scene = load_scene(args.scene, with_title);
    PictureOutput film = film_template(scene);
    compare_scenes(args, scene, film);
    scene.set_outputs({with_options(args, output_for_file(args, std::move(film)), scene)});
    run_or_plan({&scene, 1}, run_options(args.common, ""), args.common);
}

void add_key_options(CLI::App& app, RenderArguments& args) {
    args.still.add(app, "--at", "at", "T", "Make one picture.");
    args.film.add(app, "--from", "from", "T");
    args.film.add(app, "--to", "to", "T");
    args.film.add(app, "--size", "size", "WxH");
    args.film.add(app, "--fps", "fps", "RATE");
    args.film.add(app, "--speed", "speed", "S");
    args.film.add(app, "--duration", "duration", "T");
    args.film.add(app, "--story", "story", "STORY");
    args.film.add(app, "--style", "view.style", "STYLE");
    args.film.add(app, "--theme", "theme", "THEME");
    args.film.add(app, "--background", "background", "COLOUR");
    args.film.add(app, "--show", "show", "PRESET");
    args.film.add(app, "--layout", "layout", "PANELS");
    args.film.add(app, "--lang", "lang", "LANG");
    args.film.add(app, "--comparison", "comparison", "HOW", "With several scenes.");
    args.film.add(app, "--codec", "codec", "CODEC");
    args.film.add(app, "--crf", "crf", "N");
    args.film.add(app, "--preset", "preset", "PRESET");
    args.film.add(app, "--poster", "poster", "T");
}

}  // namespace

void add_render(Program& program) {
    const auto [app, args] = add_command<RenderArguments>(
        program, "render", "Make one film, picture sequence, still picture or page of a scene", act);
    add_examples(app,
                 {"render fall.json -o fall.mp4 --size 1280x720 --to 0.4 --speed impacts",
                  "render fall.json -o touch.png --at impact:1", "render slow.json fast.json -o both.mp4 --to 0.5"});
    add_scene(app, args.scene, args.common);
    app.add_option("OTHERS", args.others, "Further scenes, compared with the first in one picture");
    add_option(
        app, "-o,--output", args.file, "FILE",
        "File to make. The ending chooses the kind: film (.mp4 .webm .mov .mkv .gif .webp), sequence of pictures "
        "(name-####.png), still picture (.png, or .pdf .svg in vector graphics, with --at), page that plays the "
        "motion (.html)")
        ->required();
    add_option(app, "--title", args.title, "TEXT", "Title of the picture");
    add_key_options(app, args);
    add_work(app, args.common);
    add_note(app, "Other properties are those of the first film, sequence or still picture of the scene.");
}

}  // namespace beamcam::scenes
