// The places of contact on beam and cam.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "render/plot/ticks.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

// Points in time, coloured by a value; a strong one is drawn last, on top.
struct Places {
    Series points{.line = false, .every_point = true};
    Measure measure = {};
    double strongest = 0;

    void add(double t, double place, double value) {
        points.add(t, place), points.value.push_back(value);
        strongest = std::max(strongest, value);
    }
    void sort_by_value() {
        std::vector<std::size_t> order(points.x.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, {}, [&](std::size_t i) { return points.value[i]; });
        const Series before = points;
        for (std::size_t i = 0; i < order.size(); ++i) {
            points.x[i] = before.x[order[i]];
            points.y[i] = before.y[order[i]];
            points.value[i] = before.value[order[i]];
        }
    }
    // Writes lengths in the unit that suits them.
    void measure_lengths() {
        measure = measure_of("m", largest_magnitude(points.y));
        points.y = scaled(std::move(points.y), measure.factor);
    }
    std::string beam_label() const { return "$x_{\\r{c}}$ / " + measure.unit; }
};

Panel places_panel(const Places& places, double end, std::string y_label, std::string bar_label) {
    return {.x = {.label = "$t$ / s", .from = 0, .to = end, .tight = true},
            .y = {.label = std::move(y_label)},
            .series = {places.points},
            .color_bar = render::figure::ColorBar{.label = std::move(bar_label), .from = 0, .to = places.strongest},
            .legend = false};
}

// The first collision alone: in the whole plot its place moves by less than a mark.
std::optional<Panel> first_collision(const sim::Collision& c, double end, const sim::Table& t, double factor,
                                     const Panel& whole, Lang lang) {
    constexpr double kBrief = 0.1;  // of the time shown: a longer one is seen in the whole
    const double last = c.t_end.value_or(end);
    if (last - c.t_start > kBrief * end) return std::nullopt;
    const Measure duration = measure_of("s", last - c.t_start);
    const auto &time = column(t, ChannelKind::t), &force = column(t, ChannelKind::contact_force),
               &x = column(t, ChannelKind::contact_x);
    Series s{.line = false, .every_point = true};
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (time[i] < c.t_start || time[i] > last || !(force[i] > 0) || !std::isfinite(x[i])) continue;
        const double since = (time[i] - c.t_start) * duration.factor;
        // The end of a step is sampled again as the beginning of the next one.
        if (!s.x.empty() && s.x.back() == since) continue;
        s.add(since, x[i] * factor);
        s.value.push_back(force[i]);
    }
    if (s.x.size() < 2) return std::nullopt;
    Panel panel{.title = phrase(lang, "first collision"),
                .x = {.label = axis_label("($t$ − $t_{1}$)", duration.unit)},
                .series = {std::move(s)},
                .color_bar = whole.color_bar,
                .legend = false};
    panel.y.label = whole.y.label;
    return panel;
}

// Impulsive contact: a point for each impact, coloured by its impulse.
Figure impulsive_places(const Subject& subject, const sim::Result& result) {
    const auto& [problem, units, lang, end] = subject;
    if (result.impacts.empty())
        throw render::PictureError(
            fmt::format("figure contact-places: nothing strikes the cam before {:g} s; raise time.end", end));
    Places places;
    for (const sim::Impact& hit : result.impacts) places.add(hit.t_start, hit.x, hit.impulse_n);
    const render::Prefix prefix = render::prefix_for(places.strongest);
    places.points.value = scaled(std::move(places.points.value), 1 / prefix.factor);
    places.strongest /= prefix.factor;
    places.measure_lengths();
    return {.title = "Impacts on the beam, measured from its root, coloured by their normal impulse",
            .panels = {places_panel(places, end, places.beam_label(), fmt::format("$J$ / ({}N s)", prefix.symbol))}};
}

// The place of contact at each instant, coloured by the force.
Figure forceful_places(const Subject& subject, const sim::Result& result, const sim::Table& t) {
    const auto& [problem, units, lang, end] = subject;
    const auto &time = column(t, ChannelKind::t), &n = column(t, ChannelKind::contact_force),
               &x = column(t, ChannelKind::contact_x), &s = column(t, ChannelKind::contact_s);
    Places on_beam, on_cam;
    // As an angle on a disc, else as a length.
    const bool disc = !problem.cam->profile;
    const double share = disc ? 180 / std::numbers::pi / problem.cam->radius : 1;
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (!(n[i] > 0) || !std::isfinite(x[i] + s[i])) continue;
        // The end of a step is sampled again as the beginning of the next one.
        if (!on_beam.points.x.empty() && on_beam.points.x.back() == time[i]) continue;
        on_beam.add(time[i], x[i], n[i]);
        on_cam.add(time[i], s[i] * share, n[i]);
    }
    if (on_beam.points.x.empty())
        throw render::PictureError(
            fmt::format("figure contact-places: the beam does not touch the cam before {:g} s; raise time.end", end));
    on_beam.measure_lengths();
    if (!disc) on_cam.measure_lengths();
    on_beam.sort_by_value(), on_cam.sort_by_value();
    std::vector<Panel> panels{
        places_panel(on_beam, end, on_beam.beam_label(), "$F$ / N"),
        places_panel(on_cam, end, disc ? "$s_{\\r{c}}$/$R$ / °" : "$s_{\\r{c}}$ / " + on_cam.measure.unit, "$F$ / N")};
    panels[0].title = phrase(lang, "on the beam"), panels[1].title = phrase(lang, "on the cam");
    if (const sim::Collision* first = collision_of(problem, result, 1))
        if (auto alone = first_collision(*first, end, t, on_beam.measure.factor, panels[0], lang))
            panels.push_back(std::move(*alone));
    const double aspect = panels.size() > 2 ? 1.7 : 1.15;
    return {.panels = lettered(std::move(panels)), .stack = true, .aspect = aspect};
}

FigureDrawing prepare_places(const Scene& scene, const FigureOutput&, MotionRequests& requests) {
    const std::size_t motion = requests.motion(scene.problem, scene.end_time);
    if (scene.problem.contact.model != sim::ContactModel::compliant) return figure_of_motion(motion, impulsive_places);
    const std::size_t table =
        requests.curve(motion, {0, scene.end_time, contact_rows(scene.end_time)}, {}, {ChannelKind::contact_force, 0},
                       {sim::Channel{ChannelKind::contact_x}, sim::Channel{ChannelKind::contact_s}});
    return figure_of_motion(motion, [table](const Subject& subject, const sim::Result& result) {
        return forceful_places(subject, result, result.tables[table]);
    });
}

}  // namespace

extern const FigureType kContactPlaces{"contact-places",
                                       "Contact point on the beam from its root, and on the cam from the ray $C$$B$, "
                                       "coloured by the normal force; $t_{1}$: the "
                                       "first touch",
                                       needs_cam, prepare_places};

}  // namespace beamcam::scenes
