// Rules between the keys of figures, and between figures and the scene.
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
        r.fail(key, fmt::format("{} = {}: {}; write \\$ \\_ \\^ \\\\ for the characters themselves", r.path(key),
                                in_quotes(text), error.what()));
    }
}

namespace {

void require_one_unit(ObjectReader& r, const char* key, const std::vector<sim::Channel>& channels) {
    const sim::Problem& problem = r.context().scene.problem;
    for (const sim::Channel& channel : channels)
        if (std::string_view(unit(channel, problem)) != unit(channels.front(), problem))
            return r.fail(key,
                          fmt::format("{}: {} is measured in {}, but {} in {}; an axis has one unit: use \"right\" or "
                                      "another panel",
                                      r.path(key), name(channel), unit(channel, problem), name(channels.front()),
                                      unit(channels.front(), problem)));
}

// The interval that it shows. The times of events are unknown here.
void check_interval(ObjectReader& r, const FigureOutput& figure) {
    const SeriesKeys& series = figure.series;
    if (series.needs_events() || series.at) return;
    const double end = series.to.value_or(r.context().scene.end_time);
    if (!(series.from < end || (figure.figure == "strobe" && series.to && series.from == end)))
        r.fail("from", fmt::format("{} = {} s is not before the end, {} s; reduce it, or increase \"to\"",
                                   r.path("from"), series.from, end));
}

// A figure other than "series": keys that it does not have, its interval and its window.
void check_other_figure(ObjectReader& r, const FigureOutput& figure, const Recipe* recipe) {
    const SeriesKeys& series = figure.series;
    const bool interval = recipe && recipe->takes_interval, windows = recipe && recipe->takes_channel;
    if (interval) check_interval(r, figure);
    for (const std::string_view key : {"channels", "panels", "x", "x_low", "x_high", "from", "to", "impacts", "compare",
                                       "comparison", "residuals", "notes"})
        if (r.has(key) && !(interval && (key == "from" || key == "to")) && !(windows && key == "channels"))
            r.fail(key, fmt::format("{} belongs to the figure \"series\"; remove it", r.path(key)));
    if (windows && series.panels.front().channels.size() > 1)
        r.fail("channels", fmt::format("{}: a {} shows one channel; name only one", r.path("channels"), figure.figure));
    const double length = series.to.value_or(r.context().scene.end_time) - series.from;
    if (windows && series.window && !series.needs_events() && !(2 * *series.window <= length))
        r.fail("window", fmt::format("{} = {:g} s is more than half of the interval of {:g} s; reduce it",
                                     r.path("window"), *series.window, length));
}

// Keys that only some figures have.
void check_own_keys(ObjectReader& r, const FigureOutput& figure, const Recipe* recipe) {
    if (r.has("value") && recipe && !recipe->takes_value)
        r.fail("value",
               fmt::format("{} belongs to the figures \"bifurcation\", \"map\" and \"basins\"", r.path("value")));
    const std::pair<const char*, const char*> owners[] = {
        {"collision", "collision"}, {"window", "spectrogram"}, {"highest", "spectrogram"}, {"at", "strobe"}};
    for (const auto& [key, owner] : owners)
        if (r.has(key) && figure.figure != owner)
            r.fail(key, fmt::format("{} belongs to the figure \"{}\"", r.path(key), owner));
}

void check_abscissa(ObjectReader& r, const SeriesKeys& series) {
    if (series.x_low && series.x_high && !(*series.x_low < *series.x_high))
        r.fail("x_high", fmt::format("{} must be above \"x_low\"", r.path("x_high")));
    if ((series.against == "turns" || series.against == "phase") && !r.context().scene.problem.cam &&
        series.compare.empty())
        r.fail("x", fmt::format("{} = \"{}\": the scene has no cam", r.path("x"), series.against));
    const bool over_time = series.against == "t" || series.against == "turns";
    if (series.impacts && !over_time)
        r.fail("impacts", fmt::format("{}: lines at impacts need \"x\": \"t\" or \"turns\"", r.path("impacts")));
    if (!series.notes.empty() && !over_time)
        r.fail("notes", fmt::format("{} need \"x\": \"t\" or \"turns\"", r.path("notes")));
}

bool shows(const SeriesPanel& panel, const Measurement& data) {
    const auto holds = [&](const sim::Channel& channel) { return data.find(channel) != nullptr; };
    return std::ranges::any_of(panel.channels, holds) || std::ranges::any_of(panel.right, holds);
}

// Warns about data that have channels of the panels but not the channel of the abscissa.
void warn_of_undrawn_data(ObjectReader& r, const SeriesKeys& series) {
    const auto along = sim::channel_named(series.against);
    if (!along || along->kind == sim::ChannelKind::t || along->kind == sim::ChannelKind::cam_angle) return;
    for (const Measurement& data : r.context().scene.data)
        if (!data.find(*along) &&
            std::ranges::any_of(series.panels, [&](const SeriesPanel& panel) { return shows(panel, data); }))
            r.warn("x", fmt::format("{} = \"{}\": the data {} have no {}; they are not drawn", r.path("x"),
                                    series.against, in_quotes(data.label), series.against));
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
        r.fail("residuals", fmt::format("{}: differences need \"x\": \"t\" or \"turns\"", r.path("residuals")));
    else if (!r.diagnostics().failed("data") && std::ranges::none_of(series.panels, measured))
        r.fail("residuals",
               fmt::format("{}: the scene has no \"data\" of the channels of the panels", r.path("residuals")));
}

void check_comparison(ObjectReader& r, SeriesKeys& series) {
    if (series.apart && series.compare.empty())
        r.fail("comparison",
               fmt::format("{} = \"panels\" needs several motions; add \"compare\"", r.path("comparison")));
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
    // Lines of a spectrum differ by orders of magnitude. Explicit panels choose their own scale.
    if (series.against == "frequency" && r.has("channels"))
        for (SeriesPanel& panel : series.panels) panel.logarithmic = true;
    check_interval(r, figure);
    check_abscissa(r, series);
    check_residuals(r, series);
    check_comparison(r, series);
    warn_of_undrawn_data(r, series);
}

}  // namespace

std::string problem_with_value(std::string_view diagram, const std::string& value, const Scene& scene) {
    const std::vector<std::string> known = diagram_values(diagram, scene);
    if (value.empty() || std::ranges::find(known, value) != known.end()) return "";
    return fmt::format("the samples of the sweep have no column {}{}", in_quotes(value),
                       suggestion_or_list(value, known));
}

void check_series_panel(ObjectReader& r, const SeriesPanel& panel) {
    require_one_unit(r, "channels", panel.channels);
    require_one_unit(r, "right", panel.right);
    std::vector<sim::Channel> summed = panel.channels;
    for (const SeriesSum& sum : panel.sums)
        for (const auto* channels : {&sum.plus, &sum.minus})
            summed.insert(summed.end(), channels->begin(), channels->end());
    if (!panel.sums.empty()) require_one_unit(r, "sums", summed);
    check_markup(r, "title", panel.title);
    check_markup(r, "label", panel.label);
    if (panel.low && panel.high && !(*panel.low < *panel.high))
        r.fail("high", fmt::format("{} must be above \"low\"", r.path("high")));
    if (panel.logarithmic && panel.low && !(*panel.low > 0))
        r.fail("low", fmt::format("{}: the lower end of a logarithmic axis must be positive", r.path("low")));
}

void check_figure(ObjectReader& r, FigureOutput& figure) {
    if (figure.file.empty()) figure.file = figure.figure + ".pdf";
    const Recipe* recipe = recipe_named(figure.figure);
    if (figure.figure != "series") check_other_figure(r, figure, recipe);
    check_own_keys(r, figure, recipe);
    if (figure.figure == "series") check_series(r, figure);
    if (!r.has("figure") || r.diagnostics().any()) return;  // the next rules need a valid scene
    const Scene& scene = r.context().scene;
    if (const auto refusal = refusal_of(*recipe, scene))
        return r.fail("figure", fmt::format("{} = \"{}\": {}", r.path("figure"), figure.figure, *refusal));
    if (const std::string problem = recipe->of_sweep ? problem_with_value(recipe->name, figure.value, scene) : "";
        !problem.empty())
        r.fail("value", fmt::format("{}: {}", r.path("value"), problem));
}

}  // namespace beamcam::scenes
