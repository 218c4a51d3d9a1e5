// Output "figure": a figure for print, made by its recipe.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/plot/style.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/figure_times.hpp"
#include "scenes/plan/planner.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::between, sim::required;

static void visit(SceneVisitor& v, SeriesSum& sum) {
    v.text("label", sum.label, "Its name in the legend; $θ$ is set as mathematics.");
    v.value(sim::required("plus", "[\"energy_elastic\", \"energy_contact\"]"), channels_format(sum.plus),
            "Channels that are added.");
    v.value("minus", channels_format(sum.minus), "Channels that are subtracted; the curve is then drawn in black.");
    v.check([&sum](ObjectReader& r) { check_markup(r, "label", sum.label); });
}

static void visit(SceneVisitor& v, SeriesPanel& panel) {
    v.value(sim::required("channels", "[\"theta\"]"), channels_format(panel.channels), "Curves of one unit.");
    v.value("right", channels_format(panel.right), "Curves of another unit, on an axis at the right.");
    List sums = SceneVisitor::items_of(panel.sums);
    sums.most = 12, sums.of = "sums";
    sums.example = "[{\"label\": \"stored\", \"plus\": [\"energy_elastic\", \"energy_contact\"]}]";
    v.list("sums", sums, "Curves that are sums of channels, instead of \"channels\", whose unit they have.");
    v.choice("scale", panel.logarithmic, {{false, "linear"}, {true, "log"}}, "Of the axis at the left.");
    v.number("low", panel.low, sim::kPlainNumber, sim::kAny, "Lower end of the axis at the left, in SI units.");
    v.number("high", panel.high, sim::kPlainNumber, sim::kAny, "Its upper end.");
    v.numbers("lines", panel.lines, sim::kPlainNumber, sim::kAny, {}, "Lines across it, at these values of that axis.");
    v.text("label", panel.label,
           "Of the axis at the left, its unit follows; the channels' symbols when left out; $v_{1}$ is mathematics.");
    v.text("title", panel.title, "Above the panel; $θ$ is set as mathematics.");
    v.check([&panel](ObjectReader& r) { check_series_panel(r, panel); });
}

static void visit(SceneVisitor& v, SeriesNote& note) {
    v.value(sim::required("at", "\"impact:1\""), instant_format(note.at), "When.");
    v.text("text", note.text, "Beside the line, in the first panel; $θ$ is set as mathematics.");
    v.check([&note](ObjectReader& r) { check_markup(r, "text", note.text); });
}

// Only some figures take the keys "from" and "to", one those of windows, only "series" the others.
static const std::string& restriction() {
    static const std::string kText = [] {
        std::vector<std::string> names, windows;
        for (const Recipe& recipe : recipes()) {
            if (recipe.takes_interval) names.push_back(fmt::format("\"{}\"", recipe.name));
            if (recipe.takes_channel) windows.push_back(fmt::format("\"{}\"", recipe.name));
        }
        return fmt::format(R"({{"if": {{"properties": {{"figure": {{"const": "series"}}}}, "required": ["figure"]}},
        "then": {{"anyOf": [{{"required": ["channels"]}}, {{"required": ["panels"]}}],
                  "properties": {{"window": false, "highest": false}}}},
        "dependentSchemas": {{"at": {{"properties": {{"figure": {{"const": "strobe"}}}}}}}},
        "else": {{"properties": {{"panels": false, "x": false, "x_low": false, "x_high": false,
                                  "impacts": false, "compare": false, "comparison": false,
                                  "residuals": false, "notes": false}},
                  "if": {{"properties": {{"figure": {{"enum": [{}]}}}}, "required": ["figure"]}},
                  "then": {{"properties": {{"channels": {{"maxItems": 1}}}}}},
                  "else": {{"properties": {{"channels": false, "window": false, "highest": false}},
                            "if": {{"properties": {{"figure": {{"enum": [{}]}}}}, "required": ["figure"]}},
                            "else": {{"properties": {{"from": false, "to": false}}}}}}}}}})",
                           fmt::join(windows, ", "), fmt::join(names, ", "));
    }();
    return kText;
}

// Of the figure "series"; others have content of their own.
static void visit_series(SceneVisitor& v, SeriesKeys& series, const std::string& figure) {
    const bool is_series = figure == "series";
    const Recipe* recipe = recipe_named(figure);
    const bool stretch = is_series || (recipe && recipe->takes_interval);
    const bool windows = recipe && recipe->takes_channel;
    const auto key = [is_series](const char* name) { return sim::written_if(is_series, name); };
    if (windows && series.panels.empty()) series.panels.emplace_back();
    v.value("channels",
            windows ? channels_format(series.panels.front().channels) : grouped_channels_format(series.panels),
            "Of the figure \"series\": what it shows, a panel for each unit; or \"panels\". Of \"spectrogram\": one.");
    List panels = SceneVisitor::items_of(series.panels);
    panels.most = 8, panels.of = "panels";
    panels.example = "[{\"channels\": [\"theta\"], \"right\": [\"contact_force\"]}, {\"channels\": [\"gap\"]}]";
    v.list(key("panels"), panels, "Of \"series\": its panels, above each other.");
    v.exclusive("channels", "panels");
    v.value(
        key("x"), abscissa_format(series.against),
        "Of \"series\": what the curves are drawn against: \"t\", \"turns\" of the cam, its \"phase\" (turns less the "
        "whole ones), \"frequency\" (amplitudes, by Hann's window), or a channel.");
    v.number(key("x_low"), series.x_low, sim::kPlainNumber, sim::kAny,
             "Of \"series\": lower end of that axis, in SI units.");
    v.number(key("x_high"), series.x_high, sim::kPlainNumber, sim::kAny, "Its upper end.");
    v.value(
        sim::written_if(stretch && !series.at, "from"), bound_format(series.from, series.from_event),
        "Of \"series\", \"kymograph\", \"spectrogram\", \"strobe\", \"impact-maps\" and \"impact-histograms\": when "
        "what they show begins. Events are those of the first motion that it shows.");
    v.value(sim::written_if(stretch && !series.at, "to"), bound_format(series.to, series.to_event),
            "When it ends; with the scene when left out.");
    v.value(sim::written_if(figure == "strobe", "at"), instant_format(series.at),
            "Of \"strobe\": the one instant that it shows, the bodies to scale and the force between them; in place of "
            "\"from\" and \"to\". It is the still picture as lines, for print.");
    v.exclusive("at", "from");
    v.exclusive("at", "to");
    v.boolean(key("impacts"), series.impacts, "Of \"series\": lines where impacts begin.");
    v.number(sim::written_if(windows, "window"), series.window, dim::kTime, sim::kPositive,
             "Of \"spectrogram\": length of its windows, which becomes a power of two of samples.");
    v.number(sim::written_if(windows, "highest"), series.highest, dim::kFrequency, sim::kPositive,
             "Of \"spectrogram\": the highest frequency that it shows.");
    List notes = SceneVisitor::items_of(series.notes);
    notes.most = 12, notes.of = "notes", notes.example = "[{\"at\": \"impact:1\", \"text\": \"first touch\"}]";
    v.list(key("notes"), notes, "Of \"series\": lines at instants, with words.");
    List compare = SceneVisitor::items_of(series.compare);
    compare.least = 2, compare.most = kMostCompared, compare.of = "motions";
    compare.example = "[{\"label\": \"flexible\"}, {\"label\": \"rigid\", \"set\": {\"beam.model\": \"rigid\"}}]";
    v.constrain_schema(restriction().c_str());
    v.list(key("compare"), compare, "Of \"series\": the motions whose curves it shows, as pictures compare them.");
    v.choice(key("comparison"), series.apart, {{false, "overlay"}, {true, "panels"}},
             "Of \"series\": overlay: all of them in each panel; panels: each in panels of its own, of one scale.");
    v.boolean(key("residuals"), series.residuals,
              "Of \"series\": below each panel with measured data another with what they differ by.");
}

void FigureOutput::visit(SceneVisitor& v) {
    v.value("file", file_format(file, kFigureEndings), "Name of the file; the figure's name with .pdf when left out.");
    v.choice(required("figure", "\"free-fall\""), figure, recipe_names(), "Its name.");
    v.choice("column", column, render::figure::column_names(),
             "The journal's column that it fits: width and size of letters.");
    v.number("dpi", dpi, sim::kPlainNumber, between(50, 2400),
             "Dots per inch of a .png, .tif or .tiff; 300 or, of .tif, 600 when left out.");
    v.choice("text", editable, {{false, "outlines"}, {true, "editable"}},
             "Of an .svg: letters as outlines, the same everywhere, or as text in the reader's fonts.");
    v.choice("font", serif, {{false, "sans"}, {true, "serif"}},
             "Letters: Liberation Sans, as Arial, or Liberation Serif, as the Times of LaTeX.");
    v.choice("theme", dark, {{false, "light"}, {true, "dark"}}, "Colours: of white paper, or of a dark slide.");
    v.choice("lang", lang, {{Lang::en, "en"}, {Lang::zh, "zh"}}, "Language of labels and caption.");
    v.number("width", width, dim::kLength,
             between(0.03, 1, "is outside 30 … 1000 mm; a plain number is in metres, \"90 mm\" says its unit"),
             "Another width than the column's.");
    v.number("height", series.height, dim::kLength,
             between(0.02, 1, "is outside 20 … 1000 mm; a plain number is in metres, \"60 mm\" says its unit"),
             "Its height; what suits its panels when left out.");
    v.value("caption", file_format(caption_file, {".txt", ".md", ".tex"}),
            "A file for its caption: plain and as LaTeX, .tex as LaTeX alone; none when left out.");
    v.value("data", file_format(data_file, {".csv"}), "A file for the numbers that it shows; none when left out.");
    visit_series(v, series, figure);
    v.integer(sim::written_if(figure == "collision", "collision"), collision, 1, 100'000,
              "Of \"collision\": which one it shows, counted from 1.");
    const Recipe* recipe = recipe_named(figure);
    v.text(
        sim::written_if(recipe && recipe->takes_value, "value"), value,
        "Of \"bifurcation\": the column of the samples that it shows, \"v_n_before\" or \"theta\" when left out. Of "
        "\"map\" and \"basins\": \"class\", \"exponent\", \"impacts_per_period\", or a column, whose mean it shows.");
    v.check([this](ObjectReader& r) { check_figure(r, *this); });
}

void FigureOutput::plan(Planner& planner, std::size_t output) const {
    FigureFile planned{.output = output, .file = file, .figure = figure};
    planned.times_known = !series.needs_events();
    FigureOutput how = *this;
    if (planned.times_known) {
        how = with_event_times(std::move(how), {}, planner.scene().end_time);
    } else {  // the events may be anywhere in the scene
        planned.ends_at = series.at ? series.at : series.to_event;
        planner.find_events(series.to.value_or(planner.scene().end_time), !planned.ends_at);
        how = without_events(std::move(how));
    }
    prepare_figure(planned, planner.scene(), how);
    if (recipe_named(figure)->of_sweep) {
        if (planner.selection().shards > 1) return planner.skip(file, "a part has no diagram; collect the parts first");
        planner.require_sweep(file);
    }
    planner.add(std::move(planned));
}

}  // namespace beamcam::scenes
