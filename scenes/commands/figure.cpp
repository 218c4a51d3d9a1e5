#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "output/files/numbers.hpp"
#include "render/plot/style.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/format/source.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/outputs/run.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {
namespace {

struct FigureArguments {
    Common common;
    std::string scene, figure, file, column = "elsevier", lang = "en", text = "outlines", font = "sans";
    std::optional<std::string> width, data, caption;
    double dpi = 0;  // by the file
    std::vector<std::string> channels, compare;
    std::optional<std::string> against, from, to, height, window;
    bool impacts = false, residuals = false, logarithmic = false;
};

// Names that the scene has, and why it has not the others.
std::string list(const Scene& scene, Lang lang) {
    std::string text;
    for (const Recipe& recipe : recipes()) {
        const auto refusal = refusal_of(recipe, scene);
        text += fmt::format("{:<18} {}{}\n", recipe.name, recipe.title.in(lang),
                            refusal ? fmt::format(" (not of this scene: {})", *refusal) : "");
    }
    return text;
}

Node value_node(const std::string& text) {
    const auto number = output::number_in<double>(text);
    Node node = number && std::isfinite(*number) ? number_node(*number) : text_node(text);
    node.text = text;  // for messages
    return node;
}

// The scene and the others, by the names of their files.
Node compared_node(const FigureArguments& args) {
    Node compare = array_node();
    const auto add_motion = [&](const std::filesystem::path& file, bool other) {
        Node motion = object_node();
        add(motion, "label", text_node(file.stem().string()));
        if (other) add(motion, "scene", text_node(std::filesystem::absolute(file).string()));
        compare.items.push_back(std::move(motion));
    };
    add_motion(args.scene, false);
    for (const std::string& file : args.compare) add_motion(file, true);
    return compare;
}

// The keys of the figure's own that options name, read as if the scene said so.
SeriesKeys series_keys(const FigureArguments& args, Scene scene) {
    if (args.figure == "series" && args.channels.empty())
        throw UsageError("figure series: name its --channels, for example theta,contact_force");
    Node output = object_node();
    add(output, "type", text_node(FigureOutput::kType));
    add(output, "figure", text_node(args.figure));
    Node channels = array_node();
    for (const std::string& channel : args.channels) channels.items.push_back(text_node(channel));
    if (!args.channels.empty()) add(output, "channels", std::move(channels));
    const std::pair<const char*, const std::optional<std::string>&> options[] = {
        {"x", args.against}, {"from", args.from}, {"to", args.to}, {"height", args.height}, {"window", args.window}};
    for (const auto& [key, text] : options)
        if (text) add(output, key, value_node(*text));
    if (!args.compare.empty()) add(output, "compare", compared_node(args));
    if (args.impacts) add(output, "impacts", truth_node(true));
    if (args.residuals) add(output, "residuals", truth_node(true));

    SceneFiles files;
    std::vector<Message> messages;
    if (!read_only_output(output, args.scene, "--", files, scene, messages))
        throw UsageError(std::ranges::find(messages, true, &Message::fatal)->text);
    SeriesKeys keys = std::get<FigureOutput>(scene.outputs.front()).series;
    if (!keys.compare.empty()) keys.compare.front().problem = scene.problem;  // with what --set says of it
    if (args.logarithmic && args.figure != "series") throw UsageError("--log belongs to the figure series");
    for (SeriesPanel& panel : keys.panels) panel.logarithmic = panel.logarithmic || args.logarithmic;
    return keys;
}

bool asks_for_series(const FigureArguments& args) {
    return !args.channels.empty() || !args.compare.empty() || args.against || args.from || args.to || args.height ||
           args.window || args.impacts || args.residuals || args.logarithmic;
}

FigureOutput wanted(const FigureArguments& args, const Recipe& recipe, const Scene& scene) {
    if (args.file == "-")
        throw UsageError("-o -: figures go to files; name one that ends in .pdf, .svg, .eps, .png or .tif");
    need_ending("-o", args.file, kFigureEndings);
    FigureOutput figure;
    figure.file = args.file;
    figure.figure = recipe.name;
    if (figure.figure == "series" || asks_for_series(args)) figure.series = series_keys(args, scene);
    figure.column = args.column;
    figure.lang = args.lang == "zh" ? Lang::zh : Lang::en;
    if (args.dpi > 0) figure.dpi = args.dpi;
    figure.editable = args.text == "editable";
    figure.serif = args.font == "serif";
    if (args.width) {
        figure.width = quantity_argument("--width", *args.width, dimension::kLength);
        if (!(*figure.width >= 0.03 && *figure.width <= 1))
            throw UsageError(
                fmt::format("--width {}: a figure is 30 … 1000 mm wide; a plain number is in metres, "
                            "\"90 mm\" says its unit",
                            *args.width));
    }
    if (args.data) {
        if (*args.data == "-") throw UsageError("--data -: name a file that ends in .csv");
        need_ending("--data", *args.data, {".csv"});
        figure.data_file = *args.data;
    }
    if (args.caption) {
        if (*args.caption == "-") throw UsageError("--caption -: name a file that ends in .txt, .md or .tex");
        need_ending("--caption", *args.caption, {".txt", ".md", ".tex"});
        figure.caption_file = *args.caption;
    }
    return figure;
}

int act(const FigureArguments& given) {
    FigureArguments args = given;
    Scene scene = read_or_refuse(args.scene, args.common);
    if (args.figure.empty() && asks_for_series(args)) args.figure = "series";
    if (args.figure.empty()) {
        if (!args.file.empty())
            throw UsageError(fmt::format("-o {}: which figure? `beamcam figure {}` lists them", args.file, args.scene));
        print_text(list(scene, args.lang == "zh" ? Lang::zh : Lang::en));
        return 0;
    }
    const Recipe* recipe = recipe_named(args.figure);
    if (!recipe)
        throw UsageError(fmt::format("there is no figure {}{}", in_quotes(args.figure),
                                     suggestion_or_list(args.figure, recipe_names())));
    if (args.file.empty())
        throw UsageError(
            fmt::format("figure {}: name the file with -o, ending in .pdf, .svg, .eps, .png or .tif", args.figure));
    if (const auto refusal = refusal_of(*recipe, scene))
        throw SceneError(fmt::format("{}: no figure \"{}\": {}", args.scene, recipe->name, *refusal));
    scene.set_outputs({wanted(args, *recipe, scene)});
    const RunOptions options = run_options(args.common, "");
    run_or_plan({&scene, 1}, options, args.common);
    return 0;
}

}  // namespace

void add_figure(Grammar& grammar) {
    auto args = std::make_shared<FigureArguments>();
    Command& app =
        grammar.command("figure", "Make a figure for print (.pdf, .svg, .eps, .png, .tif); no FIGURE: list them");
    add_scene(app, args->scene, args->common);
    app.positional("FIGURE", &args->figure, "Which figure; none: list those of the scene");
    app.option("-o,--output", &args->file, "FILE", "File to make: .pdf, .svg, .eps, .png or .tif");
    app.option("--column", &args->column, "COLUMN", "Width and letters of a journal's column")
        .one_of(render::figure::column_names());
    app.option("--width", &args->width, "W", "Another width than the column's, for example 120mm");
    app.option("--lang", &args->lang, "LANG", "Language of labels and caption: en or zh").one_of({"en", "zh"});
    app.option("--dpi", &args->dpi, "N", "Dots per inch of a .png or .tif (default: 300, 600)").range(50, 2400);
    app.option("--text", &args->text, "HOW", "Letters of an .svg: outlines or editable")
        .one_of({"outlines", "editable"});
    app.option("--font", &args->font, "FONT", "Letters: sans, or serif as in text set by LaTeX")
        .one_of({"sans", "serif"});
    app.option("--data", &args->data, "FILE", "Write the plotted numbers too, .csv");
    app.option("--caption", &args->caption, "FILE", "Write the caption too, plain and LaTeX, .txt or .tex");
    app.option("--channels", &args->channels, "A,B,…",
               "Of the figure series, which needs no FIGURE then: these channels, a panel for each unit; of "
               "spectrogram one")
        .separated_by(',');
    app.option("--compare", &args->compare, "SCENE,…", "Of series: the same channels of these scenes too")
        .separated_by(',');
    app.option("--x", &args->against, "CHANNEL",
               "Of series: against what; t, turns (of the cam), frequency or a channel");
    app.option("--from", &args->from, "T",
               "Of series and of figures of a stretch such as kymograph: from this instant");
    app.option("--to", &args->to, "T", "Of these: until this instant");
    app.option("--height", &args->height, "H", "Of series: its height, for example 60mm");
    app.option("--window", &args->window, "T", "Of spectrogram: length of its windows");
    app.flag("--log", args->logarithmic, "Of series: logarithmic axes of values");
    app.flag("--impacts", args->impacts, "Of series: lines where impacts begin");
    app.flag("--residuals", args->residuals, "Of series: panels with what measured data differ by");
    add_work(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
