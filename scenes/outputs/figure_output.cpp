// Output "figure": a figure for print, made by its type.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "render/plot/style.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/presets.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/planner.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::between;

static void visit(SceneVisitor& v, SeriesSum& sum) {
    v.text("label", sum.label, "Name in the legend; $θ$ is a formula.");
    v.value(sim::required("plus", "[\"energy_elastic\", \"energy_contact\"]"), channels_format(sum.plus),
            "Channels that are added.");
    v.value("minus", channels_format(sum.minus), "Channels that are subtracted; the curve is then drawn in black.");
    v.check([&sum](ObjectReader& r) { check_markup(r, "label", sum.label); });
}

static void visit(SceneVisitor& v, SeriesPanel& panel) {
    v.value(sim::required("channels", "[\"theta\"]"), channels_format(panel.channels), "Curves, all of one unit.");
    List sums = SceneVisitor::items_of(panel.sums);
    sums.max_size = 12, sums.of = "sums";
    sums.example = "[{\"label\": \"stored\", \"plus\": [\"energy_elastic\", \"energy_contact\"]}]";
    v.list("sums", sums, "Curves that are sums of channels; only they are drawn, in the unit of \"channels\".");
    v.choice("scale", panel.logarithmic, {{false, "linear"}, {true, "log"}},
             "Scale of the vertical axis; log omits values that are not positive; a logarithmic one begins at most six "
             "decades below its largest value, unless \"low\" tells where.");
    const DimensionOf of_axis = dimension_of_first(panel.channels);
    v.value("low", quantity_format(panel.low, of_axis),
            "Lower end of the vertical axis; a plain number is in SI units.");
    v.value("high", quantity_format(panel.high, of_axis),
            "Upper end of the vertical axis; a plain number is in SI units.");
    v.value("lines", quantities_format(panel.lines, of_axis),
            "Horizontal lines at these values of the vertical axis; plain numbers are in SI units.");
    v.text(
        "label", panel.label,
        "Label of the vertical axis, without the unit; by default the symbols of the channels; $v_{1}$ is a formula.");
    v.value("unit", unit_format(panel.unit, of_axis),
            "Unit of the vertical axis: \"MPa\", \"deg\"; by default that of the scene, or SI with a prefix.");
    v.text("title", panel.title, "Title above the panel; $θ$ is a formula.");
    v.check([&panel](ObjectReader& r) { check_series_panel(r, panel); });
}

static void visit(SceneVisitor& v, SeriesNote& note) {
    v.value(sim::required("at", "\"impact:1\""), instant_format(note.at), "The instant.");
    v.text("text", note.text, "Text beside the line, in the first panel; $θ$ is a formula.");
    v.check([&note](ObjectReader& r) { check_markup(r, "text", note.text); });
}

// A key of figures; only those that have it write it.
using KeyOfFigure = std::function<sim::Key(const char* name)>;

static void visit_abscissa(SceneVisitor& v, SeriesKeys& series, const KeyOfFigure& key) {
    const DimensionOf of_abscissa = [&series](const ObjectReader& r) -> std::optional<sim::Dimension> {
        if (series.against == "frequency") return dim::kFrequency;
        const auto channel = sim::channel_named(series.against);
        return channel ? dimension_of(*channel, r.context().scene.problem) : dim::kNone;  // of turns
    };
    v.value(
        key("x"), abscissa_format(series.against),
        "In \"series\": the abscissa: \"t\", \"turns\" of the cam, its \"phase\" (fraction of a turn since the start), "
        "\"frequency\" (amplitude spectra with a Hann window), or a channel.");
    v.value(key("x_low"), quantity_format(series.x_low, of_abscissa),
            "In \"series\": lower end of the abscissa; a plain number is in SI units, or in turns.");
    v.value(key("x_high"), quantity_format(series.x_high, of_abscissa),
            "In \"series\": upper end of the abscissa; a plain number is in SI units, or in turns.");
    v.text(key("x_label"), series.x_label, "In \"series\": label of the abscissa, without the unit; $t$ is a formula.");
    v.value(key("x_unit"), unit_format(series.x_unit, of_abscissa),
            "In \"series\": unit of the abscissa: \"ms\", \"deg\"; by default that of the scene, or SI with a prefix.");
}

// The part of the motion.
static void visit_interval(SceneVisitor& v, SeriesKeys& series, const KeyOfFigure& key) {
    v.value(key("from"), bound_format(series.from, series.from_event),
            fmt::format("In {}: first instant. Events are those of the first motion of the figure.",
                        list_of_figures_with("from"))
                .c_str());
    v.value(key("to"), bound_format(series.to, series.to_event, &series.to_last),
            "Last instant; a first event, or one after an event \"from\", is the end of the scene where it does not "
            "occur. By default that end, or in \"strobe\" the first impact; \"kymograph\" by default shows the first "
            "collision.");
}

// The keys of the figure "series"; the other figures have some of them.
static void visit_series(SceneVisitor& v, SeriesKeys& series, const std::string& figure) {
    const FigureType* type = figure_type(figure);
    const bool windows = type && type->takes("window");
    const KeyOfFigure key = [type](const char* name) { return sim::written_if(type && type->takes(name), name); };
    if (windows && series.panels.empty()) series.panels.emplace_back();
    v.value("channels",
            windows ? channels_format(series.panels.front().channels) : grouped_channels_format(series.panels),
            "In \"series\": the channels, with one panel for each unit, in place of \"panels\". In \"spectrogram\": "
            "one channel.");
    List panels = SceneVisitor::items_of(series.panels);
    panels.max_size = 8, panels.of = "panels";
    panels.example = "[{\"channels\": [\"theta\"], \"right\": [\"contact_force\"]}, {\"channels\": [\"gap\"]}]";
    v.list(key("panels"), panels, "In \"series\": the panels, from top to bottom.");
    v.exclusive("channels", "panels");
    visit_abscissa(v, series, key);
    visit_interval(v, series, key);
    v.boolean(key("impacts"), series.impacts, "In \"series\": vertical lines at the beginnings of impacts.");
    v.number(key("window"), series.window, dim::kTime, sim::kPositive,
             "In \"spectrogram\": length of the windows, rounded to a power of two of samples.");
    v.number(key("highest"), series.highest, dim::kFrequency, sim::kPositive,
             "In \"spectrogram\": highest frequency of the figure.");
    List notes = SceneVisitor::items_of(series.notes);
    notes.max_size = 12, notes.of = "notes", notes.example = "[{\"at\": \"impact:1\", \"text\": \"first touch\"}]";
    v.list(key("notes"), notes, "In \"series\": vertical lines with a text.");
    List motions = compared_motions(series.compare);
    motions.min_size = 1;
    v.list(key("compare"), motions, "In \"series\": the motions of the figure, as in pictures.");
    v.choice(key("comparison"), series.apart, {{false, "overlay"}, {true, "panels"}},
             "In \"series\": overlay: all motions in each panel; panels: separate panels for each motion, with equal "
             "scales.");
    v.boolean(key("residuals"), series.residuals,
              "In \"series\": a panel of the differences below each panel with measured data.");
    v.boolean(key("horizon"), series.horizon,
              "In \"series\": curves against time are paler during the intervals in which θ is not reproducible; this "
              "needs a second run with tighter tolerances and another method.");
}

void FigureOutput::visit(SceneVisitor& v) {
    v.value("file", file_format(file, kFigureEndings),
            "Name of the file; by default the name of the figure with .pdf.");
    v.choice("figure", figure, names_of_figures_and_presets(),
             "Name of the figure, or of a preset, whose keys the output then has besides its own.");
    v.text(sim::written_if(!title.empty(), "title"), title,
           "Title in the caption and the properties of the file; $θ$ is a formula.");
    v.check([this](ObjectReader& r) { check_markup(r, "title", title); });
    v.choice("column", column, render::figure::column_names(),
             "The journal's column: width and font size of the figure.");
    v.number("dpi", dpi, sim::kPlainNumber, between(50, 2400), "Dots per inch of .png.");
    v.choice("font", serif, {{false, "sans"}, {true, "serif"}},
             "Liberation Sans, similar to Arial, or Liberation Serif, similar to Times.");
    v.choice("theme", dark, {{false, "light"}, {true, "dark"}}, "Colours for white paper, or for dark slides.");
    v.choice("lang", lang, kLanguages, "Language of the labels.");
    v.number("width", width, dim::kLength,
             between(0.03, 1, "is outside 30 … 1000 mm; a plain number is in metres, \"90 mm\" says its unit"),
             "Width; by default that of the column.");
    v.number("height", series.height, dim::kLength,
             between(0.02, 1, "is outside 20 … 1000 mm; a plain number is in metres, \"60 mm\" says its unit"),
             "Height; by default it suits the panels.");
    v.value("caption", file_format(caption_file, {".txt", ".md"}),
            "File for the caption: title, parameters that differ from the defaults, accuracy; by default none.");
    v.value("data", file_format(data_file, {".csv"}), "File for the numbers of the figure; by default none.");
    visit_series(v, series, figure);
    const FigureType* type = figure_type(figure);
    v.object(sim::written_if(type && type->takes("table"), "table"), table, "In \"table\": the file and its columns.");
    v.text(sim::written_if(type && type->takes("value"), "value"), value,
           "In \"bifurcation\": the column of the samples, by default \"v_n_before\" or \"theta\". In \"map\" and "
           "\"basins\": \"class\", \"exponent\", \"impacts_per_period\", or a column, whose mean is shown.");
    v.check([this](ObjectReader& r) { check_figure(r, *this); });
}

void plan(Planner& planner, const FigureOutput& how, const ResolvedOutput& resolved) {
    const FigureType& type = *figure_type(how.figure);
    if (type.of_sweep()) planner.require_sweep(how.file);
    MotionRequests requests;
    FigureMaker maker = type.prepare(planner.scene(), how, requests);
    planner.add(
        {resolved.index, how.file, how.figure, {}},
        [maker = std::move(maker), height = how.series.height](const MotionResults& results) {
            render::figure::Figure made = maker(results);
            if (height) made.height = *height * 1e3;
            return made;
        },
        requests.take());
}

}  // namespace beamcam::scenes
