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

// Points in time, coloured by a value; the highest is drawn last, on top.
struct Places {
    std::vector<double> t, place, value;

    void add(double at, double where, double colour) {
        // The end of a step is sampled again as the beginning of the next one.
        if (!t.empty() && t.back() == at) return;
        t.push_back(at), place.push_back(where), value.push_back(colour);
    }
    // Leaves one sample, the largest, of each collision shorter than `brief`: its marks would cover each other.
    void thin(const std::vector<sim::Collision>& collisions, double brief) {
        for (const sim::Collision& c : collisions) {
            const double end = c.t_end.value_or(t.back());
            if (end - c.t_start > brief) continue;
            const auto index = [&](auto at) { return at - t.begin(); };
            const auto from = index(std::ranges::lower_bound(t, c.t_start)),
                       to = index(std::ranges::upper_bound(t, end));
            if (from == to) continue;
            const auto kept = std::max_element(value.begin() + from, value.begin() + to) - value.begin();
            for (auto* all : {&t, &place, &value}) {
                (*all)[static_cast<std::size_t>(from)] = (*all)[static_cast<std::size_t>(kept)];
                all->erase(all->begin() + from + 1, all->begin() + to);
            }
        }
    }
    double largest() const { return largest_magnitude(value); }
    Measure measure() const { return measure_of("m", largest_magnitude(place)); }
    // From this instant on, in these units.
    Series points(double origin, double per_second, double per_metre) const {
        std::vector<std::size_t> order(t.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, {}, [&](std::size_t i) { return value[i]; });
        Series s{.line = false, .every_point = true};
        for (const std::size_t i : order) {
            s.add((t[i] - origin) * per_second, place[i] * per_metre);
            s.value.push_back(value[i]);
        }
        return s;
    }
};

std::string beam_label(const Measure& measure) { return axis_label("$x_{\\r{c}}$", measure.unit); }

Panel places_panel(Series points, const render::figure::ColorBar& bar, std::string y_label) {
    return {.x = {.label = "$t$ / s"},
            .y = {.label = std::move(y_label)},
            .series = {std::move(points)},
            .color_bar = bar,
            .legend = false};
}

// The first collision alone: in the whole plot its place moves by less than a mark.
std::optional<Panel> first_collision(const sim::Collision& c, const Subject& subject, const Places& whole,
                                     const render::figure::ColorBar& bar) {
    constexpr double kBrief = 0.1;  // of the time shown: a longer one is seen in the whole
    const double last = c.t_end.value_or(subject.end_time);
    if (last - c.t_start > kBrief * (whole.t.back() - whole.t.front())) return std::nullopt;
    Places during;
    for (std::size_t i = 0; i < whole.t.size(); ++i)
        if (whole.t[i] >= c.t_start && whole.t[i] <= last) during.add(whole.t[i], whole.place[i], whole.value[i]);
    if (during.t.size() < 2) return std::nullopt;
    const Measure time = measure_of("s", last - c.t_start), length = whole.measure();
    Panel panel = places_panel(during.points(c.t_start, time.factor, length.factor), bar, beam_label(length));
    panel.x.label = axis_label("($t$ − $t_{1}$)", time.unit);
    panel.title = phrase(subject.lang, "first collision");
    panel.caption = "that of the first collision on the beam from its touch at $t_{1}$";
    return panel;
}

// Impulsive contact: a point for each impact that ends, coloured by its impulse.
Figure impulsive_places(const Subject& subject, const sim::Result& result) {
    Places places;
    for (const sim::Impact& hit : result.impacts)
        if (hit.t_end) places.add(hit.t_start, hit.x, hit.impulse_n);
    if (places.t.empty())
        throw render::PictureError(fmt::format(
            "figure contact-places: nothing strikes the cam before {:g} s; raise time.end", subject.end_time));
    const render::Prefix prefix = render::prefix_for(places.largest());
    for (double& value : places.value) value /= prefix.factor;
    const Measure length = places.measure();
    return {.title = "Impacts on the beam, measured from its root, coloured by their normal impulse $J$",
            .panels = {
                places_panel(places.points(0, 1, length.factor),
                             {.label = fmt::format("$J$ / ({}N s)", prefix.symbol), .from = 0, .to = places.largest()},
                             beam_label(length))}};
}

// The place of contact at each instant, coloured by the force; of a brief collision that of the largest force.
Figure forceful_places(const Subject& subject, const sim::Result& result, const sim::Table& t) {
    const auto& [problem, units, lang, end] = subject;
    const auto &time = column(t, ChannelKind::t), &n = column(t, ChannelKind::contact_force),
               &x = column(t, ChannelKind::contact_x), &s = column(t, ChannelKind::contact_s);
    Places on_beam, on_cam;
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (!(n[i] > 0) || !std::isfinite(x[i] + s[i])) continue;
        on_beam.add(time[i], x[i], n[i]);
        on_cam.add(time[i], s[i], n[i]);
    }
    if (on_beam.t.empty())
        throw render::PictureError(
            fmt::format("figure contact-places: the beam does not touch the cam before {:g} s; raise time.end", end));
    const render::figure::ColorBar bar{.label = "$F$ / N", .from = 0, .to = on_beam.largest()};
    // As an angle on a disc, else as a length.
    const bool disc = !problem.cam->profile;
    const Places whole = on_beam;
    constexpr double kBrief = 0.03;  // of the time shown: about the width of a mark
    for (Places* each : {&on_beam, &on_cam}) each->thin(result.collisions, kBrief * (whole.t.back() - whole.t.front()));
    const Measure length = on_beam.measure(),
                  around = disc ? Measure{180 / std::numbers::pi / problem.cam->radius, "°"} : on_cam.measure();
    std::vector<Panel> panels{places_panel(on_beam.points(0, 1, length.factor), bar, beam_label(length)),
                              places_panel(on_cam.points(0, 1, around.factor), bar,
                                           axis_label(disc ? "$s_{\\r{c}}$/$R$" : "$s_{\\r{c}}$", around.unit))};
    panels[0].title = phrase(lang, "on the beam"), panels[1].title = phrase(lang, "on the cam");
    panels[0].caption = "on the beam, from its root, in brief collisions at the largest force";
    panels[1].caption = disc ? "on the cam, from the ray $C$$B$" : "along the outline of the cam";
    if (const sim::Collision* first = collision_of(problem, result, 1))
        if (auto alone = first_collision(*first, subject, whole, bar)) panels.push_back(std::move(*alone));
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

extern const FigureType kContactPlaces{"contact-places", "Contact point, coloured by the normal force $F$", needs_cam,
                                       prepare_places};

}  // namespace beamcam::scenes
