#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "output/files/numbers.hpp"
#include "output/files/standard_output.hpp"
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
    std::string scene, figure, file, column = "elsevier", lang = "en", text = "outlines", font = "sans",
                                     theme = "light";
    std::optional<std::string> width, data, caption;
    double dpi = 0;  // by the file
    std::vector<std::string> channels, right, compare, notes;
    std::optional<std::string> against, x_low, x_high, low, high, title, from, to, at, height, window, collision;
    bool impacts = false, residuals = false, logarithmic = false, apart = false;

    // Of the only panel, which a list of channels does not name.
    bool tells_panel() const { return !right.empty() || low || high || title; }
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

Node list_node(const std::vector<std::string>& words) {
    Node list = array_node();
    for (const std::string& word : words) list.items.push_back(text_node(word));
    return list;
}

Node panel_node(const FigureArguments& args) {
    Node panel = object_node();
    add(panel, "channels", list_node(args.channels));
    if (!args.right.empty()) add(panel, "right", list_node(args.right));
    if (args.low) add(panel, "low", value_node(*args.low));
    if (args.high) add(panel, "high", value_node(*args.high));
    if (args.title) add(panel, "title", text_node(*args.title));
    return panel;
}

// "impact:1=first touch"
Node note_node(const std::string& text) {
    Node note = object_node();
    const std::size_t sign = text.find('=');
    add(note, "at", value_node(text.substr(0, sign)));
    if (sign != std::string::npos) add(note, "text", text_node(text.substr(sign + 1)));
    return note;
}

// The output as a scene would write it.
Node output_node(const FigureArguments& args) {
    Node output = object_node();
    add(output, "type", text_node(FigureOutput::kType));
    add(output, "figure", text_node(args.figure));
    if (args.tells_panel()) {
        Node panels = array_node();
        panels.items.push_back(panel_node(args));
        add(output, "panels", std::move(panels));
    } else if (!args.channels.empty()) {
        add(output, "channels", list_node(args.channels));
    }
    const std::pair<const char*, const std::optional<std::string>&> options[] = {
        {"x", args.against},     {"x_low", args.x_low},   {"x_high", args.x_high},
        {"from", args.from},     {"to", args.to},         {"at", args.at},
        {"height", args.height}, {"window", args.window}, {"collision", args.collision}};
    for (const auto& [key, text] : options)
        if (text) add(output, key, value_node(*text));
    if (!args.compare.empty()) add(output, "compare", compared_node(args));
    if (args.impacts) add(output, "impacts", boolean_node(true));
    if (args.residuals) add(output, "residuals", boolean_node(true));
    if (args.apart) add(output, "comparison", text_node("panels"));
    if (!args.notes.empty()) {
        Node notes = array_node();
        for (const std::string& note : args.notes) notes.items.push_back(note_node(note));
        add(output, "notes", std::move(notes));
    }
    return output;
}

// The keys of the figure's own that options name, read as if the scene said so.
FigureOutput with_keys(const FigureArguments& args, Scene scene) {
    if (args.figure == "series" && args.channels.empty())
        throw UsageError("figure series: name its --channels, for example theta,contact_force");
    SceneFiles files;
    std::vector<Message> messages;
    if (!read_only_output(output_node(args), args.scene, "--", files, scene, messages))
        throw UsageError(std::ranges::find(messages, true, &Message::fatal)->text);
    for (const Message& warning : messages)
        if (!args.common.quiet) output::print_message("{}: warning: {}\n", args.scene, warning.text);
    FigureOutput figure = std::get<FigureOutput>(scene.outputs.front());
    SeriesKeys& keys = figure.series;
    if (!keys.compare.empty()) keys.compare.front().problem = scene.problem;  // with what --set says of it
    if (args.logarithmic && args.figure != "series") throw UsageError("--log belongs to the figure series");
    for (SeriesPanel& panel : keys.panels) panel.logarithmic = panel.logarithmic || args.logarithmic;
    return figure;
}

bool asks_for_series(const FigureArguments& args) {
    return !args.channels.empty() || !args.compare.empty() || !args.notes.empty() || args.tells_panel() ||
           args.against || args.x_low || args.x_high || args.from || args.to || args.impacts || args.residuals ||
           args.logarithmic || args.apart;
}
bool tells_keys(const FigureArguments& args) {
    return args.figure == "series" || asks_for_series(args) || args.window || args.collision || args.height || args.at;
}

FigureOutput wanted(const FigureArguments& args, const Recipe& recipe, const Scene& scene) {
    if (args.file == "-")
        throw UsageError("-o -: figures go to files; name one that ends in .pdf, .svg, .eps, .png or .tif");
    need_ending("-o", args.file, kFigureEndings);
    FigureOutput figure;
    if (tells_keys(args)) figure = with_keys(args, scene);
    figure.file = args.file;
    figure.figure = recipe.name;
    figure.column = args.column;
    figure.lang = args.lang == "zh" ? Lang::zh : Lang::en;
    if (args.dpi > 0) figure.dpi = args.dpi;
    figure.editable = args.text == "editable";
    figure.serif = args.font == "serif";
    figure.dark = args.theme == "dark";
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
    if (args.figure.empty() && args.at) args.figure = "strobe";
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

// How every figure is printed, and what stands beside it.
void add_print_options(Command& app, FigureArguments& args) {
    app.option("--column", &args.column, "COLUMN", "Width and letters of a journal's column")
        .one_of(render::figure::column_names());
    app.option("--width", &args.width, "W", "Another width than the column's, for example 120mm");
    app.option("--lang", &args.lang, "LANG", "Language of labels and caption: en or zh").one_of({"en", "zh"});
    app.option("--dpi", &args.dpi, "N", "Dots per inch of a .png or .tif (default: 300, 600)").range(50, 2400);
    app.option("--text", &args.text, "HOW", "Letters of an .svg: outlines or editable")
        .one_of({"outlines", "editable"});
    app.option("--font", &args.font, "FONT", "Letters: sans, or serif as in text set by LaTeX")
        .one_of({"sans", "serif"});
    app.option("--theme", &args.theme, "THEME", "Colours: light, of white paper, or dark, of a slide")
        .one_of({"light", "dark"});
    app.option("--data", &args.data, "FILE", "Write the plotted numbers too, .csv");
    app.option("--caption", &args.caption, "FILE", "Write the caption too, plain and LaTeX, .txt or .tex");
}

void add_series_options(Command& app, FigureArguments& args) {
    app.option("--channels", &args.channels, "A,B,…",
               "Of the figure series, which needs no FIGURE then: these channels, a panel for each unit; of "
               "spectrogram one")
        .separated_by(',');
    app.option("--right", &args.right, "A,B,…", "Of series: channels of another unit, on an axis at the right")
        .separated_by(',');
    app.option("--compare", &args.compare, "SCENE,…", "Of series: the same channels of these scenes too")
        .separated_by(',');
    app.option("--x", &args.against, "CHANNEL",
               "Of series: against what; t, turns or phase (of the cam), frequency or a channel");
    app.option("--x-low", &args.x_low, "V", "Of series: lower end of that axis, in SI units");
    app.option("--x-high", &args.x_high, "V", "Of series: its upper end");
    app.option("--low", &args.low, "V", "Of series of one panel: lower end of the axis at the left, in SI units");
    app.option("--high", &args.high, "V", "Of series of one panel: its upper end");
    app.option("--title", &args.title, "WORDS", "Of series of one panel: above it; $θ$ is mathematics");
    app.option("--note", &args.notes, "AT=WORDS", "Of series: a line at an instant, impact:1=touch (repeatable)");
}

// Keys that several figures have.
void add_stretch_options(Command& app, FigureArguments& args) {
    app.option("--from", &args.from, "T",
               "Of series and of figures of a stretch such as kymograph: from this instant: a time, impact:2, …");
    app.option("--to", &args.to, "T", "Of these: until this instant");
    app.option("--at", &args.at, "T",
               "Of strobe, which needs no FIGURE then: this instant alone: a time, impact:2, apex:1, last");
    app.option("--height", &args.height, "H", "Its height, for example 60mm");
    app.option("--window", &args.window, "T", "Of spectrogram: length of its windows");
    app.option("--collision", &args.collision, "N", "Of collision: which one, counted from 1");
}

void add_series_flags(Command& app, FigureArguments& args) {
    app.flag("--panels", args.apart, "Of series with --compare: each motion in panels of its own");
    app.flag("--log", args.logarithmic, "Of series: logarithmic axes of values");
    app.flag("--impacts", args.impacts, "Of series: lines where impacts begin");
    app.flag("--residuals", args.residuals, "Of series: panels with what measured data differ by");
}

}  // namespace

void add_figure(Grammar& grammar) {
    auto args = std::make_shared<FigureArguments>();
    Command& app =
        grammar.command("figure", "Make a figure for print (.pdf, .svg, .eps, .png, .tif); no FIGURE: list them");
    add_scene(app, args->scene, args->common);
    app.positional("FIGURE", &args->figure, "Which figure; none: list those of the scene");
    app.option("-o,--output", &args->file, "FILE", "File to make: .pdf, .svg, .eps, .png or .tif");
    add_print_options(app, *args);
    add_series_options(app, *args);
    add_stretch_options(app, *args);
    add_series_flags(app, *args);
    add_work(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
