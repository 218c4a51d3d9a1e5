// Rules between the keys of figures, and between figures and the scene.
#include <fmt/format.h>

#include <algorithm>

#include "render/draw/markup.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/series_data.hpp"
#include "scenes/figures/sweeps.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/motions/identity.hpp"

namespace beamcam::scenes {

void check_markup(ObjectReader& r, const std::string& key, const std::string& text) {
    try {
        render::parse_markup(text);
    } catch (const std::invalid_argument& error) {
        r.reject(key, " = {}: {}; write \\$ \\_ \\^ \\\\ for the characters themselves", in_quotes(text), error.what());
    }
}

namespace {

void require_one_unit(ObjectReader& r, const char* key, const std::vector<sim::Channel>& channels) {
    const sim::Problem& problem = r.context().scene.problem;
    for (const sim::Channel& channel : channels)
        if (std::string_view(unit(channel, problem)) != unit(channels.front(), problem))
            return r.reject(key, ": {} is measured in {}, but {} in {}; a panel has one unit; use another panel",
                            name(channel), unit(channel, problem), name(channels.front()),
                            unit(channels.front(), problem));
}

// The interval that it shows. The times of events are unknown here.
void check_interval(ObjectReader& r, const FigureOutput& figure) {
    const SeriesKeys& series = figure.series;
    if (series.to) check_end(r, "to", *series.to);
    const sim::Problem& first = series.compare.empty() ? r.context().scene.problem : series.compare.front().problem;
    for (const auto& [key, event] : {std::pair{"from", series.from_event}, std::pair{"to", series.to_event}})
        if (event && event->kind != Instant::Kind::apex && !first.cam)
            return r.reject(key, " = {}: the scene has no cam (\"cam\": null); give it one",
                            in_quotes(name_of(*event)));
    if (series.needs_events()) return;
    const double end = series.to.value_or(r.context().scene.end_time);
    if (!(series.from < end))
        r.reject("from", " = {} s is not before the end, {} s; choose an earlier start, or a later end", series.from,
                 end);
}

// Keys that only other figures have.
void check_own_keys(ObjectReader& r, const FigureType& type) {
    for (const std::string_view key : keys_of_figures())
        if (const auto misplaced = type.misplaced(key); misplaced && r.has(key)) r.reject(key, " {}", *misplaced);
}

// A figure that moves windows along one channel.
void check_windows(ObjectReader& r, const FigureOutput& figure) {
    const SeriesKeys& series = figure.series;
    if (series.panels.front().channels.size() > 1)
        r.reject("channels", ": a {} shows one channel; name only one", figure.figure);
    const double length = series.to.value_or(r.context().scene.end_time) - series.from;
    if (series.window && !series.needs_events() && !(2 * *series.window <= length))
        r.reject("window", " = {:g} s is more than half of the interval of {:g} s; reduce it", *series.window, length);
}

void check_abscissa(ObjectReader& r, const SeriesKeys& series) {
    if (series.x_low && series.x_high && !(*series.x_low < *series.x_high))
        r.reject("x_high", " must be above \"x_low\"");
    if ((series.against == "turns" || series.against == "phase") && !r.context().scene.problem.cam &&
        series.compare.empty())
        r.reject("x", " = \"{}\": the scene has no cam", series.against);
    const bool over_time = series.against == "t" || series.against == "turns";
    if (series.impacts && !over_time) r.reject("impacts", ": lines at impacts need \"x\": \"t\" or \"turns\"");
    if (!series.notes.empty() && !over_time) r.reject("notes", " need \"x\": \"t\" or \"turns\"");
}

bool shows(const SeriesPanel& panel, const Measurement& data) {
    const auto holds = [&](const sim::Channel& channel) { return data.find(channel) != nullptr; };
    return std::ranges::any_of(panel.channels, holds);
}

// Warns about data that have channels of the panels but not the channel of the abscissa, or no spectrum.
void warn_of_undrawn_data(ObjectReader& r, const SeriesKeys& series) {
    for (const Measurement& data : r.context().scene.data)
        if (series.against == "frequency" && !equally_spaced(data.times) &&
            std::ranges::any_of(series.panels, [&](const SeriesPanel& panel) { return shows(panel, data); }))
            r.warn(
                "x",
                " = \"frequency\": the instants of the data {} are too few or not equally spaced; they are not drawn",
                in_quotes(data.label));
    const auto along = sim::channel_named(series.against);
    if (!along || along->kind == sim::ChannelKind::t || along->kind == sim::ChannelKind::cam_angle) return;
    for (const Measurement& data : r.context().scene.data)
        if (!data.find(*along) &&
            std::ranges::any_of(series.panels, [&](const SeriesPanel& panel) { return shows(panel, data); }))
            r.warn("x", " = \"{}\": the data {} have no {}; they are not drawn", series.against, in_quotes(data.label),
                   series.against);
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
        r.reject("residuals", ": differences need \"x\": \"t\" or \"turns\"");
    else if (!r.diagnostics().failed("data") && std::ranges::none_of(series.panels, measured))
        r.reject("residuals", ": the scene has no \"data\" of the channels of the panels");
}

void check_comparison(ObjectReader& r, const SeriesKeys& series) {
    if (series.apart && series.compare.empty())
        r.reject("comparison", " = \"panels\" needs several motions; add \"compare\"");
    for (const Compared& motion : series.compare) check_markup(r, "compare", motion.label);
    const auto key = [](sim::Problem problem) {
        problem.beam.modes = 0;  // a rigid beam has none
        return motion_key(problem);
    };
    const auto is_first_rigid = [&](const Compared& motion) {
        return motion.problem.beam.model == sim::ModelKind::rigid &&
               key(motion.problem) == key(series.compare[0].problem);
    };
    if (series.compare.size() > 1 && std::ranges::all_of(series.compare, is_first_rigid))
        r.reject("compare", ": all motions are the same; a rigid beam has no modes");
}

bool some(const Scene& scene, const SeriesKeys& series, bool (*what)(const sim::Problem&)) {
    return series.compare.empty() ? what(scene.problem) : std::ranges::any_of(series.compare, what, &Compared::problem);
}
bool bends(const sim::Problem& problem) { return problem.beam.model != sim::ModelKind::rigid; }
bool turns(const sim::Problem& problem) {
    const auto* drive = std::get_if<sim::ConstantSpeed>(&problem.hub.drive);
    return !drive || drive->speed != 0;
}

void check_series(ObjectReader& r, FigureOutput& figure) {
    SeriesKeys& series = figure.series;
    if (series.panels.empty() && !r.diagnostics().any())
        r.reject_object("channels",
                        " shows nothing; name \"channels\", for example [\"theta\", \"contact_force\"], or "
                        "another \"figure\" than \"series\"");
    // Lines of a spectrum differ by orders of magnitude. Explicit panels choose their own scale.
    if (series.against == "frequency" && r.has("channels"))
        for (SeriesPanel& panel : series.panels) panel.logarithmic = true;
    check_abscissa(r, series);
    check_markup(r, "x_label", series.x_label);
    check_residuals(r, series);
    check_comparison(r, series);
    const auto shows_only = [&](sim::ChannelKind kind) {
        return !series.panels.empty() && std::ranges::all_of(series.panels, [&](const SeriesPanel& panel) {
            return panel.channels == std::vector{sim::Channel{kind}};
        });
    };
    const Scene& scene = r.context().scene;
    if (shows_only(sim::ChannelKind::tip_deflection) && !some(scene, series, bends))
        r.reject_object("channels", ": tip_deflection: a rigid beam does not bend; choose another beam.model");
    if (shows_only(sim::ChannelKind::theta) && !some(scene, series, turns))
        r.reject_object("channels", ": the hub is held at its initial angle; choose another hub.drive");
    warn_of_undrawn_data(r, series);
}

}  // namespace

std::string problem_with_value(std::string_view diagram, const std::string& value, const Scene& scene) {
    const std::vector<std::string> known = diagram_values(diagram, scene);
    if (value == "exponent" && scene.sweep && !scene.sweep->sampling.exponents)
        return "the sweep computes no exponents; add \"exponents\": true to it (sweep --exponents)";
    if (value.empty() || std::ranges::find(known, value) != known.end()) return "";
    for (const sim::SampleColumnInfo& column : sim::sample_columns())
        if (column.name == value && column.is_of(sim::SampleKind::peaks))
            return fmt::format("{} is a column of peaks; add \"sample\": \"peaks\" (sweep --sample peaks)", value);
    return fmt::format("the samples of the sweep have no column {}{}", in_quotes(value),
                       suggestion_or_list(value, known));
}

void check_series_panel(ObjectReader& r, const SeriesPanel& panel) {
    require_one_unit(r, "channels", panel.channels);
    std::vector<sim::Channel> summed = panel.channels;
    for (const SeriesSum& sum : panel.sums)
        for (const auto* channels : {&sum.plus, &sum.minus})
            summed.insert(summed.end(), channels->begin(), channels->end());
    if (!panel.sums.empty()) require_one_unit(r, "sums", summed);
    check_markup(r, "title", panel.title);
    check_markup(r, "label", panel.label);
    if (panel.low && panel.high && !(*panel.low < *panel.high)) r.reject("high", " must be above \"low\"");
    for (const auto& [key, end] : {std::pair{"low", panel.low}, std::pair{"high", panel.high}})
        if (panel.logarithmic && end && !(*end > 0))
            r.reject_value(r.place(key), key, ": the ends of a logarithmic axis must be positive");
}

void check_figure(ObjectReader& r, FigureOutput& figure) {
    if (figure.file.empty()) figure.file = figure.figure + ".pdf";
    const FigureType* type = figure_type(figure.figure);
    if (!type) return;
    check_own_keys(r, *type);
    if (figure.figure == "series") check_series(r, figure);
    if (type->takes("table") && !r.has("table"))
        r.reject_object("table",
                        " needs \"table\", for example {{\"file\": \"peaks.csv\", \"x\": \"cam.speed\", "
                        "\"y\": [\"force_peak\"]}}");
    if (type->takes("from")) check_interval(r, figure);
    if (type->takes("window")) check_windows(r, figure);
    if (!r.has("figure") || r.diagnostics().any()) return;  // the next rules need a valid scene
    const Scene& scene = r.context().scene;
    if (const auto refusal = type->refusal(scene)) return r.reject("figure", " = \"{}\": {}", figure.figure, *refusal);
    if (type->of_sweep()) r.reject_if("value", problem_with_value(type->name, figure.value, scene));
}

}  // namespace beamcam::scenes
