// `beamcam figure`: one figure for print.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "output/data/table_reader.hpp"
#include "output/json/source.hpp"
#include "render/draw/markup.hpp"
#include "scenes/commands/key_options.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/format/presets.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/outputs/run.hpp"

namespace beamcam::scenes {
namespace {

using OptionKey = std::pair<std::string_view, const char*>;
constexpr OptionKey kOptionsOfTables[] = {
    {"--label", "label"}, {"--unit", "unit"}, {"--x-label", "x_label"}, {"--x-unit", "x_unit"}};

struct FigureArguments {
    Common common;
    std::string scene, figure, file;
    std::optional<std::string> preset;  // a file
    bool list = false;
    KeyOptions general{"figure"}, channels{"figure"}, span{"figure"};
    KeyOptions panel{"figure"};  // of the figure's only panel
    std::optional<std::string> data, caption;
    // Options of "series":
    KeyOptions series{"figure"};
    std::vector<std::string> compare, notes;
    std::optional<std::string> title;
    bool logarithmic = false;

    bool describes_panel() const { return panel.any() || title; }
    // Options that describe a series, and their keys; `general` options do not choose the figure.
    std::vector<std::pair<std::string, std::string>> of_series() const {
        std::vector<std::pair<std::string, std::string>> out;
        for (const KeyOptions* group : {&channels, &span, &panel, &series})
            std::ranges::move(group->given(), back_inserter(out));
        if (title) out.emplace_back("--title", "panels");
        if (logarithmic) out.emplace_back("--log", "panels");
        if (!compare.empty()) out.emplace_back("--compare", "compare");
        if (!notes.empty()) out.emplace_back("--note", "notes");
        return out;
    }
};

Node output_of(const std::string& figure) { return object_node({{"type", FigureOutput::kType}, {"figure", figure}}); }

// Why the scene cannot have this figure.
std::optional<std::string> refusal_of(const Preset& preset, const FigureArguments& args, const Scene& scene) {
    try {
        read_output(output_of(preset.name), {}, scene, args.scene, args.common);
        return std::nullopt;
    } catch (const UsageError& error) {
        return error.what();
    }
}

// The names of all figures and presets; why the scene cannot have some of them.
std::string list(const FigureArguments& args, const Scene& scene) {
    std::string text;
    const auto add = [&](std::string_view name, std::string_view title, const std::optional<std::string>& refusal) {
        text += fmt::format("{:<18} {}{}\n", name, render::to_plain(title),
                            refusal ? fmt::format(" (not for this scene: {})", *refusal) : "");
    };
    for (const FigureType& type : figure_types()) add(type.name, type.title, type.refusal(scene));
    for (const Preset& preset : embedded_presets()) add(preset.name, preset.title(), refusal_of(preset, args, scene));
    return text;
}

// The preset that the arguments name; nothing for a figure of its own.
std::optional<Preset> preset_of(const FigureArguments& args) {
    if (!args.preset) {
        const Preset* embedded = embedded_preset(args.figure);
        return embedded ? std::optional(*embedded) : std::nullopt;
    }
    const Source source = load_source(*args.preset, "`beamcam figure SCENE` lists the presets");
    Parsed parsed = parse(source.text);
    if (parsed.is_json && parsed.root.kind != Node::Kind::object)
        parsed.messages.push_back({parsed.root.place, "a preset is an object with the keys of a figure", true});
    if (!parsed.messages.empty()) throw SceneError(describe({source}, parsed.messages));
    return Preset{std::filesystem::path(*args.preset).stem().string(), std::move(parsed.root)};
}

// ---- the output as a scene would describe it -------------------------------------------------------

// The scene and the others, labelled by the names of their files.
Node compare_node(const FigureArguments& args) {
    Node compare = array_node();
    const auto add_motion = [&](const std::filesystem::path& file, bool other) {
        Node motion = object_node({{"label", file.stem().string()}});
        if (other) add(motion, "scene", std::filesystem::absolute(file).string());
        compare.items.push_back(std::move(motion));
    };
    add_motion(args.scene, false);
    for (const std::string& file : args.compare) add_motion(file, true);
    return compare;
}

// "impact:1=first touch"
Node note_node(const std::string& text) {
    const std::size_t sign = text.find('=');
    Node note = object_node({{"at", value_node(text.substr(0, sign))}});
    if (sign != std::string::npos) add(note, "text", text.substr(sign + 1));
    return note;
}

Node output_node(const FigureArguments& args, const std::optional<Preset>& preset) {
    Node output = output_of(args.figure);
    if (preset) add_preset(output, *preset);
    if (args.describes_panel() && !preset)
        add(output, "panels", array_node({object_node({{"channels", args.channels.values("--channels")}})}));
    if (Node* panels = child(output, "panels"); panels && !panels->items.empty()) {
        if (args.title) remove(panels->items.front(), "title"), add(panels->items.front(), "title", *args.title);
        for (Node& panel : panels->items)
            if (args.logarithmic) remove(panel, "scale"), add(panel, "scale", "log");
    }
    if (!args.compare.empty()) add(output, "compare", compare_node(args));
    if (!args.notes.empty()) add(output, "notes", array_node(args.notes, note_node));
    return output;
}

void reject_options_of_others(const FigureArguments& args, const FigureType& type) {
    auto given = args.of_series();
    std::ranges::move(args.general.given(), back_inserter(given));
    for (const auto& [option, key] : given)
        if (const auto misplaced = type.misplaced(key)) throw UsageError(fmt::format("{} {}", option, *misplaced));
}

FigureOutput with_files(FigureOutput figure, const FigureArguments& args) {
    require_ending("-o", args.file, kFigureEndings);
    figure.file = args.file;
    if (args.data) {
        require_ending("--data", *args.data, {".csv"});
        figure.data_file = *args.data;
    }
    if (args.caption) {
        require_ending("--caption", *args.caption, kCaptionEndings);
        figure.caption_file = *args.caption;
    }
    return figure;
}

FigureOutput figure_output(const FigureArguments& args, const std::optional<Preset>& preset, const Scene& scene) {
    if (args.figure == "series" && !preset && !args.channels.any())
        throw UsageError("figure series: name its --channels, for example theta,contact_force");
    const KeyOptions no_channels{"figure"};  // they are in the panel
    auto figure = std::get<FigureOutput>(read_output(
        output_node(args, preset),
        {&args.general, args.describes_panel() ? &no_channels : &args.channels, &args.panel, &args.span, &args.series},
        scene, args.scene, args.common));
    if (SeriesKeys& keys = figure.series; !args.compare.empty())
        keys.compare.front().problem = scene.problem;  // with the values of --set
    for (SeriesPanel& panel : figure.series.panels) panel.logarithmic = panel.logarithmic || args.logarithmic;
    return with_files(std::move(figure), args);
}

// ---- a table in place of a scene ---------------------------------------------------------------------

bool holds_columns(const std::string& file) {
    static constexpr std::array kEndings{".csv", ".npz", ".tsv", ".txt", ".dat"};
    return std::ranges::find(kEndings, lowered(std::filesystem::path(file).extension().string())) != kEndings.end();
}

// The columns that the options name.
Node table_node(const FigureArguments& args) {
    Node table = object_node({{"file", std::filesystem::path(args.scene).filename().string()}});
    if (const std::string* x = args.span.value("--x")) add(table, "x", *x);
    add(table, "y", args.channels.values("--channels"));
    for (const auto& [option, key] : kOptionsOfTables)
        for (const KeyOptions* group : {&args.span, &args.panel})
            if (const std::string* value = group->value(option)) add(table, key, *value);
    return table;
}

void draw_table(const FigureArguments& args) {
    const auto names = output::read_columns(args.scene, [](const std::string&) { return false; }).names();
    if (args.list || args.file.empty()) return print_text(fmt::format("{}\n", fmt::join(names, "\n")));
    for (const auto& [option, key] : args.of_series())
        if (option != "--x" && option != "--channels" &&
            !std::ranges::count(kOptionsOfTables, option, &OptionKey::first))
            throw UsageError(fmt::format("{} needs a scene; {} is a table", option, args.scene));
    if (!args.figure.empty() && args.figure != "table")
        throw UsageError(fmt::format("figure {} needs a scene; {} is a table", args.figure, args.scene));
    if (!args.span.value("--x") || !args.channels.any())
        throw UsageError(fmt::format("figure {}: name the columns with --x and --channels; it has {}", args.scene,
                                     fmt::join(names, ", ")));
    Scene scene;
    scene.name = std::filesystem::path(args.scene).stem().string();
    Node output = output_of("table");
    add(output, "table", table_node(args));
    auto figure =
        std::get<FigureOutput>(read_output(std::move(output), {&args.general}, scene, args.scene, args.common));
    scene.set_outputs({with_files(std::move(figure), args)});
    run_or_plan({&scene, 1}, run_options(args.common, ""), args.common);
}

void act(const FigureArguments& given) {
    FigureArguments args = given;
    if (holds_columns(args.scene)) return draw_table(args);
    Scene scene = load_scene(args.scene, args.common);
    if (args.preset && !args.figure.empty())
        throw UsageError(fmt::format("figure {}: --preset names another figure; give one of them", args.figure));
    if (!args.preset && args.figure.empty() && !args.of_series().empty()) args.figure = "series";
    if (args.list || (args.figure.empty() && !args.preset)) {
        if (!args.file.empty())
            throw UsageError(fmt::format("-o {}: which figure? `beamcam figure {}` lists them", args.file, args.scene));
        print_text(list(args, scene));
        return;
    }
    const std::optional<Preset> preset = preset_of(args);
    if (preset) args.figure = preset->figure();
    const FigureType* type = figure_type(args.figure);
    if (!type) {
        throw UsageError(fmt::format("{}there is no figure {}{}", args.preset ? *args.preset + ": " : "",
                                     in_quotes(args.figure),
                                     suggestion_or_list(args.figure, names_of_figures_and_presets())));
    }
    if (preset && preset->keys.find("panels") && args.channels.any())
        throw UsageError(fmt::format(
            "--channels: the panels of the preset {} have channels and units of their own; give one of both",
            preset->name));
    reject_options_of_others(args, *type);
    if (args.file.empty()) args.file = (preset ? preset->name : args.figure) + ".pdf";
    if (const auto refusal = type->refusal(scene))
        throw SceneError(fmt::format("{}: no figure \"{}\": {}", args.scene, type->name, *refusal));
    scene.set_outputs({figure_output(args, preset, scene)});
    run_or_plan({&scene, 1}, run_options(args.common, ""), args.common);
}

// ---- options ---------------------------------------------------------------------------------------

void add_print_options(CLI::App& app, FigureArguments& args) {
    args.general.add(app, "--column", "column", "COLUMN");
    args.general.add(app, "--width", "width", "W");
    args.general.add(app, "--height", "height", "H");
    args.general.add(app, "--lang", "lang", "LANG");
    args.general.add(app, "--dpi", "dpi", "N");
    args.general.add(app, "--font", "font", "FONT");
    args.general.add(app, "--theme", "theme", "THEME");
    add_option(app, "--data", args.data, "FILE", "Write the plotted numbers, too: .csv");
    add_option(app, "--caption", args.caption, "FILE", "Write the caption, too: .txt or .md");
}

void add_content_options(CLI::App& app, FigureArguments& args) {
    args.channels.add_list(app, "--channels", "channels", "CHANNEL,...");
    args.span.add(app, "--x", "x", "CHANNEL");
    args.span.add(app, "--x-low", "x_low", "V");
    args.span.add(app, "--x-high", "x_high", "V");
    args.span.add(app, "--x-label", "x_label", "TEXT");
    args.span.add(app, "--x-unit", "x_unit", "UNIT");
    args.span.add_flag(app, "--horizon", "horizon", "true",
                       "In \"series\": paler curves where θ is not reproducible; this takes a second run");
    args.span.add(app, "--from", "from", "T");
    args.span.add(app, "--to", "to", "T");
    args.general.add(app, "--window", "window", "T");
}

void add_series_options(CLI::App& app, FigureArguments& args) {
    add_list(app, "--compare", args.compare, "SCENE,...", "In \"series\": the same channels of these scenes, too");
    const std::string one_panel = "In \"series\" with one panel: ";
    args.panel.add_list(app, "--lines", "panels.0.lines", "V,...")
        ->description(
            one_panel +
            "horizontal lines at these values of the vertical axis, such as 45deg; plain numbers are in SI units");
    args.panel.add(app, "--low", "panels.0.low", "V")
        ->description(one_panel + "lower end of the vertical axis, such as 45deg; a plain number is in SI units");
    args.panel.add(app, "--high", "panels.0.high", "V")
        ->description(one_panel + "upper end of the vertical axis; a plain number is in SI units");
    args.panel.add(app, "--label", "panels.0.label", "TEXT")
        ->description(one_panel + "label of the vertical axis, without the unit");
    args.panel.add(app, "--unit", "panels.0.unit", "UNIT")
        ->description(one_panel + "unit of the vertical axis, such as MPa or deg");
    add_option(app, "--title", args.title, "TEXT", "In \"series\" with one panel: its title; $θ$ is mathematics");
    add_option(app, "--note", args.notes, "AT=TEXT",
               "In \"series\": a line with a text at an instant, for example impact:1=touch (repeatable)");
    app.add_flag("--log", args.logarithmic,
                 "In \"series\": logarithmic axes of values, which omit values that are not positive");
    args.series.add_flag(app, "--panels", "comparison", "panels",
                         "In \"series\" with --compare: separate panels for each motion");
    args.series.add_flag(app, "--impacts", "impacts", "true", "In \"series\": lines where impacts begin");
    args.series.add_flag(app, "--residuals", "residuals", "true",
                         "In \"series\": below each panel with measured data, a panel with the differences");
}

}  // namespace

void add_figure(Program& program) {
    const auto [app, args] = add_command<FigureArguments>(
        program, "figure", "Make a figure for print; without FIGURE, list the figures of the scene", act);
    add_examples(app, {"figure fall.json energy -o energy.pdf --column aps",
                       "figure fall.json --channels theta,contact_force --from impact:1 -o touch.svg",
                       "figure peaks.csv --x cam.speed --x-unit rpm --channels force_peak -o peaks.pdf"});
    add_note(app,
             "In place of SCENE a table may stand (.csv, .npz): its columns --channels over --x, with --label, --unit, "
             "--x-label and --x-unit. Without -o its columns are listed.");
    add_scene(app, args.scene, args.common);
    app.add_option("FIGURE", args.figure, "Name of the figure or preset; not needed with --channels (\"series\")");
    app.add_flag("--list", args.list, "List all figures and presets, and which of them this scene cannot have");
    add_option(app, "--preset", args.preset, "FILE", "A preset of your own: .json with the keys of a figure");
    add_option(app, "-o,--output", args.file, "FILE", "File to make: .pdf, .svg or .png (default: FIGURE.pdf)");
    add_print_options(app, args);
    add_content_options(app, args);
    add_series_options(app, args);
    add_work(app, args.common);
}

}  // namespace beamcam::scenes
