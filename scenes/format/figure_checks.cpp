// What the keys of figures for print ask of each other and of the scene.
#include <fmt/format.h>

#include <algorithm>

#include "render/draw/markup.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/figures/sweeps.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/suggest.hpp"

namespace beamcam::scenes {

void check_markup(ObjectReader& r, const std::string& key, const std::string& text) {
    try {
        render::parse_markup(text);
    } catch (const std::invalid_argument& error) {
        r.fail(r.place(key), key,
               fmt::format("{} = {}: {}; \\$ \\_ \\^ \\\\ stand for themselves", r.path(key), in_quotes(text),
                           error.what()));
    }
}

namespace {

void refuse_mixed_units(ObjectReader& r, const char* key, const std::vector<sim::Channel>& channels) {
    const sim::Problem& problem = r.context().scene.problem;
    for (const sim::Channel& channel : channels)
        if (std::string_view(unit(channel, problem)) != unit(channels.front(), problem))
            return r.fail(r.place(key), key,
                          fmt::format("{}: {} is measured in {}, {} in {}; one axis has one unit: use \"right\", or "
                                      "another panel",
                                      r.path(key), name(channel), unit(channel, problem), name(channels.front()),
                                      unit(channels.front(), problem)));
}

// The stretch that it shows. Events are where they are: only times can be judged here.
void check_stretch(ObjectReader& r, const FigureOutput& figure) {
    const SeriesKeys& series = figure.series;
    if (series.needs_events() || series.at) return;
    const double end = series.to.value_or(r.context().scene.end_time);
    if (!(series.from < end || (figure.figure == "strobe" && series.to && series.from == end)))
        r.fail(r.place("from"), "from",
               fmt::format("{} = {} s is not before the end, {} s", r.path("from"), series.from, end));
}

// Keys of the series that this figure does not have; the stretch and the windows of those that have them.
void check_other_figure(ObjectReader& r, const FigureOutput& figure, const Recipe* recipe) {
    const SeriesKeys& series = figure.series;
    const bool stretch = recipe && recipe->takes_interval, windows = recipe && recipe->takes_channel;
    if (stretch) check_stretch(r, figure);
    for (const std::string_view key : {"channels", "panels", "x", "x_low", "x_high", "from", "to", "impacts", "compare",
                                       "comparison", "residuals", "notes"})
        if (r.has(key) && !(stretch && (key == "from" || key == "to")) && !(windows && key == "channels"))
            r.fail(r.place(key), std::string(key), fmt::format("{} belongs to the figure \"series\"", r.path(key)));
    if (windows && series.panels.front().channels.size() > 1)
        r.fail(r.place("channels"), "channels",
               fmt::format("{}: a {} shows one channel", r.path("channels"), figure.figure));
    const double length = series.to.value_or(r.context().scene.end_time) - series.from;
    if (windows && series.window && !series.needs_events() && !(2 * *series.window <= length))
        r.fail(r.place("window"), "window",
               fmt::format("{} = {:g} s is more than half of the {:g} s that it moves along", r.path("window"),
                           *series.window, length));
}

// Keys that belong to some figures alone.
void check_own_keys(ObjectReader& r, const FigureOutput& figure, const Recipe* recipe) {
    if (r.has("value") && recipe && !recipe->takes_value)
        r.fail(r.place("value"), "value",
               fmt::format("{} belongs to the figures \"bifurcation\", \"map\" and \"basins\"", r.path("value")));
    const std::pair<const char*, const char*> owners[] = {
        {"collision", "collision"}, {"window", "spectrogram"}, {"highest", "spectrogram"}, {"at", "strobe"}};
    for (const auto& [key, owner] : owners)
        if (r.has(key) && figure.figure != owner)
            r.fail(r.place(key), key, fmt::format("{} belongs to the figure \"{}\"", r.path(key), owner));
}

void check_abscissa(ObjectReader& r, const SeriesKeys& series) {
    if (series.x_low && series.x_high && !(*series.x_low < *series.x_high))
        r.fail(r.place("x_high"), "x_high", fmt::format("{} must be above \"x_low\"", r.path("x_high")));
    if ((series.against == "turns" || series.against == "phase") && !r.context().scene.problem.cam &&
        series.compare.empty())
        r.fail(r.place("x"), "x", fmt::format("{} = \"{}\": the scene has no cam", r.path("x"), series.against));
    const bool over_time = series.against == "t" || series.against == "turns";
    if (series.impacts && !over_time)
        r.fail(r.place("impacts"), "impacts",
               fmt::format("{}: impacts are lines over \"t\" or \"turns\" alone", r.path("impacts")));
    if (!series.notes.empty() && !over_time)
        r.fail(r.place("notes"), "notes", fmt::format("{} are lines over \"t\" or \"turns\" alone", r.path("notes")));
}

bool shows(const SeriesPanel& panel, const Measurement& data) {
    const auto holds = [&](const sim::Channel& channel) { return data.find(channel) != nullptr; };
    return std::ranges::any_of(panel.channels, holds) || std::ranges::any_of(panel.right, holds);
}

// Data of channels that the panels show, but not of what these are drawn against.
void warn_of_undrawn_data(ObjectReader& r, const SeriesKeys& series) {
    const auto along = sim::channel_named(series.against);
    if (!along || along->kind == sim::ChannelKind::t || along->kind == sim::ChannelKind::cam_angle) return;
    for (const Measurement& data : r.context().scene.data)
        if (!data.find(*along) &&
            std::ranges::any_of(series.panels, [&](const SeriesPanel& panel) { return shows(panel, data); }))
            r.diagnostics().warning(r.place("x").place,
                                    fmt::format("{} = \"{}\": the data {} do not hold {}; they are not drawn",
                                                r.path("x"), series.against, in_quotes(data.label), series.against));
}

void check_residuals(ObjectReader& r, const SeriesKeys& series) {
    if (!series.residuals) return;
    const auto measured = [&](const SeriesPanel& panel) {
        return std::ranges::any_of(panel.channels, [&](const sim::Channel& channel) {
            return std::ranges::any_of(r.context().scene.data,
                                       [&](const Measurement& m) { return m.find(channel) != nullptr; });
        });
    };
    if (series.against != "t" && series.against != "turns")
        r.fail(r.place("residuals"), "residuals",
               fmt::format("{}: differences are drawn against \"t\" or \"turns\" alone", r.path("residuals")));
    else if (!r.diagnostics().failed("data") && std::ranges::none_of(series.panels, measured))
        r.fail(r.place("residuals"), "residuals",
               fmt::format("{}: the scene has no \"data\" of what the panels show", r.path("residuals")));
}

void check_comparison(ObjectReader& r, SeriesKeys& series) {
    if (series.apart && series.compare.empty())
        r.fail(r.place("comparison"), "comparison",
               fmt::format("{} = \"panels\" needs motions: \"compare\"", r.path("comparison")));
    for (std::size_t i = 0; i < series.compare.size(); ++i) {
        std::string& label = series.compare[i].label;
        if (label.empty()) label = std::to_string(i + 1);
        check_markup(r, "compare", label);
    }
}

void check_series(ObjectReader& r, FigureOutput& figure) {
    SeriesKeys& series = figure.series;
    if (series.panels.empty() && !r.diagnostics().any())
        r.fail(*r.node(), "channels",
               fmt::format("{} shows nothing; name \"channels\", for example [\"theta\", \"contact_force\"]",
                           r.object_name()));
    // Lines of a spectrum differ by orders of magnitude; panels of one's own say their scale.
    if (series.against == "frequency" && r.has("channels"))
        for (SeriesPanel& panel : series.panels) panel.logarithmic = true;
    check_stretch(r, figure);
    check_abscissa(r, series);
    check_residuals(r, series);
    check_comparison(r, series);
    warn_of_undrawn_data(r, series);
}

}  // namespace

std::string problem_with_value(std::string_view diagram, const std::string& value, const Scene& scene) {
    const std::vector<std::string> known = diagram_values(diagram, scene);
    if (value.empty() || std::ranges::find(known, value) != known.end()) return "";
    return fmt::format("the samples have no column {}{}", in_quotes(value), suggestion_or_list(value, known));
}

void check_series_panel(ObjectReader& r, const SeriesPanel& panel) {
    refuse_mixed_units(r, "channels", panel.channels);
    refuse_mixed_units(r, "right", panel.right);
    std::vector<sim::Channel> summed = panel.channels;
    for (const SeriesSum& sum : panel.sums)
        for (const auto* channels : {&sum.plus, &sum.minus})
            summed.insert(summed.end(), channels->begin(), channels->end());
    if (!panel.sums.empty()) refuse_mixed_units(r, "sums", summed);
    check_markup(r, "title", panel.title);
    check_markup(r, "label", panel.label);
    if (panel.low && panel.high && !(*panel.low < *panel.high))
        r.fail(r.place("high"), "high", fmt::format("{} must be above \"low\"", r.path("high")));
    if (panel.logarithmic && panel.low && !(*panel.low > 0))
        r.fail(r.place("low"), "low", fmt::format("{}: a logarithmic axis begins above 0", r.path("low")));
}

void check_figure(ObjectReader& r, FigureOutput& figure) {
    if (figure.file.empty()) figure.file = figure.figure + ".pdf";
    const Recipe* recipe = recipe_named(figure.figure);
    if (figure.figure != "series") check_other_figure(r, figure, recipe);
    check_own_keys(r, figure, recipe);
    if (figure.figure == "series") check_series(r, figure);
    if (!r.has("figure") || r.diagnostics().any()) return;  // judged when the physics is known
    const Scene& scene = r.context().scene;
    if (const auto refusal = refusal_of(*recipe, scene))
        return r.fail(r.place("figure"), "figure",
                      fmt::format("{} = \"{}\": {}", r.path("figure"), figure.figure, *refusal));
    if (const std::string problem = recipe->of_sweep ? problem_with_value(recipe->name, figure.value, scene) : "";
        !problem.empty())
        r.fail(r.place("value"), "value", fmt::format("{}: {}", r.path("value"), problem));
}

}  // namespace beamcam::scenes
