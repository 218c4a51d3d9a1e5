// Where on beam and cam contact happens.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "render/plot/ticks.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {
namespace {

// Of places on the beam.
Measure measure_of_places(const std::vector<double>& x) { return measure_of("m", largest_magnitude(x)); }
std::string places_label(const Measure& measure) { return "$x_{\\r{c}}$ / " + measure.unit; }

// The first collision alone: in the whole plot its place moves by less than a mark.
std::optional<render::figure::Inset> first_collision(const sim::Collision& c, double end,
                                                     const std::vector<double>& time, const std::vector<double>& force,
                                                     const std::vector<double>& x, double factor, const Panel& whole,
                                                     bool en) {
    Panel panel;
    panel.title = en ? "first collision" : "首次碰撞";
    panel.x.tight = false;
    panel.legend = Legend::none;
    panel.color_bar = whole.color_bar;
    panel.color_bar->hidden = true;
    Series s;
    s.weight = 1.8;
    constexpr double kBrief = 0.1;  // of the time shown: a longer one is seen in the whole
    const double last = c.t_end.value_or(end);
    if (last - c.t_start > kBrief * end) return std::nullopt;
    const Measure duration = measure_of("s", last - c.t_start);
    panel.x.label = axis_label("($t$ − $t_{1}$)", duration.unit);
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (time[i] < c.t_start || time[i] > last) continue;
        const bool touching = force[i] > 0 && std::isfinite(x[i]);
        s.x.push_back((time[i] - c.t_start) * duration.factor);
        s.y.push_back(touching ? x[i] * factor : std::nan(""));
        s.value.push_back(touching ? force[i] : std::nan(""));
    }
    if (std::count_if(s.y.begin(), s.y.end(), [](double v) { return std::isfinite(v); }) < 2) return std::nullopt;
    panel.series = {std::move(s)};
    return render::figure::Inset{.panel = {std::move(panel)}, .width = 0.36, .height = 0.29};
}

// Impulsive contact: a point for each impact, coloured by its impulse.
Figure impulsive_places(const sim::Problem& problem, const sim::Result& result, double end, Lang lang) {
    const bool en = lang == Lang::en;
    if (result.impacts.empty())
        throw render::PictureError(
            fmt::format("figure contact-places: nothing strikes the cam before {:g} s; raise time.end", end));
    Series s;
    s.line = false;
    s.every_point = true;
    for (const sim::Impact& hit : result.impacts) {
        s.x.push_back(hit.t_start);
        s.y.push_back(hit.x);
        s.value.push_back(hit.impulse_n);
    }
    const double strongest = *std::ranges::max_element(s.value);
    const render::Prefix prefix = render::prefix_for(strongest);
    s.value = scaled(std::move(s.value), 1 / prefix.factor);
    const Measure measure = measure_of_places(s.y);
    s.y = scaled(std::move(s.y), measure.factor);
    Panel panel;
    panel.x.label = "$t$ / s";
    panel.x.from = 0;
    panel.x.to = end;
    panel.y.label = places_label(measure);
    panel.legend = Legend::none;
    panel.color_bar = render::figure::ColorBar{
        .label = fmt::format("$J$ / ({}N s)", prefix.symbol), .from = 0, .to = strongest / prefix.factor};
    panel.series = {std::move(s)};
    Figure figure;
    figure.title = en ? "Contact point on the beam" : "梁上的接触点";
    figure.panels = {std::move(panel)};
    figure.caption =
        en ? "Place of the impacts on the beam, measured from its root, coloured by their normal impulse $J$. "
           : "各次冲击在梁上的位置（自根部量起），颜色表示法向冲量 $J$。";
    figure.caption += facts(problem, lang);
    figure.accuracy = accuracy({{&problem, &result}}, lang);
    return figure;
}

// The place of contact at each instant, coloured by the force.
struct Places {
    Series on_beam, on_cam;
    double strongest = 0;
    Measure measure = {};  // on the beam
};
Places places_of(const sim::Table& t, double radius) {
    const auto &time = column(t, ChannelKind::t), &n = column(t, ChannelKind::contact_force),
               &x = column(t, ChannelKind::contact_x), &s = column(t, ChannelKind::contact_s);
    Places out;
    out.on_beam.line = out.on_cam.line = false;
    out.on_beam.every_point = out.on_cam.every_point = true;
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (!(n[i] > 0) || !std::isfinite(x[i] + s[i])) continue;
        out.on_beam.x.push_back(time[i]);
        out.on_cam.x.push_back(time[i]);
        out.on_beam.y.push_back(x[i]);
        out.on_cam.y.push_back(s[i] / radius * 180 / std::numbers::pi);
        out.on_beam.value.push_back(n[i]);
        out.strongest = std::max(out.strongest, n[i]);
    }
    out.on_cam.value = out.on_beam.value;
    out.measure = measure_of_places(out.on_beam.y);
    out.on_beam.y = scaled(std::move(out.on_beam.y), out.measure.factor);
    return out;
}

// Strong contacts are drawn last, on top.
void sort_by_value(Series& series) {
    std::vector<std::size_t> order(series.x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return series.value[i]; });
    const Series before = series;
    for (std::size_t i = 0; i < order.size(); ++i) {
        series.x[i] = before.x[order[i]];
        series.y[i] = before.y[order[i]];
        series.value[i] = before.value[order[i]];
    }
}

Panel places_panel(Series places, double strongest, double end) {
    sort_by_value(places);
    Panel panel;
    panel.x.label = "$t$ / s";
    panel.x.from = 0;
    panel.x.to = end;
    panel.legend = Legend::none;
    panel.color_bar = render::figure::ColorBar{.label = "$F$ / N", .from = 0, .to = strongest};
    panel.series = {std::move(places)};
    return panel;
}

Figure forceful_places(const sim::Problem& problem, const sim::Result& result, const sim::Table& t, double end,
                       Lang lang) {
    const bool en = lang == Lang::en;
    Places places = places_of(t, problem.cam->radius);
    if (places.on_beam.x.empty())
        throw render::PictureError(
            fmt::format("figure contact-places: the beam does not touch the cam before {:g} s; raise time.end", end));
    Panel beam = places_panel(std::move(places.on_beam), places.strongest, end),
          cam = places_panel(std::move(places.on_cam), places.strongest, end);
    beam.letter = "a", cam.letter = "b";
    beam.title = en ? "on the beam" : "梁上", cam.title = en ? "on the cam" : "凸轮上";
    beam.y.label = places_label(places.measure), cam.y.label = "$s_{\\r{c}}$/$R$ / °";
    if (const sim::Collision* first = collision_of(problem, result, 1))
        if (auto inset = first_collision(*first, end, column(t, ChannelKind::t), column(t, ChannelKind::contact_force),
                                         column(t, ChannelKind::contact_x), places.measure.factor, beam, en))
            beam.insets = {std::move(*inset)};
    Figure figure;
    figure.panels = {std::move(beam), std::move(cam)};
    figure.stack = figure.share_x = true;
    figure.aspect = 1.1;
    figure.caption = en ? "Contact point (a) on the beam, measured from its root, and (b) on the cam, as the angle "
                          "from the mark of the disc (the ray from $C$ to $B$), coloured by the normal force. "
                        : "接触点 (a) 在梁上（自根部量起）和 (b) 在凸轮上（自圆盘标记，即射线 $C$$B$ "
                          "起的角度）的位置，颜色表示法向力。";
    figure.caption += facts(problem, lang);
    figure.accuracy = accuracy({{&problem, &result}}, lang);
    return figure;
}

FigureMaker prepare_places(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const Lang lang = how.lang;
    const double end = scene.end_time;
    const std::size_t study = studies.of(scene.problem, end, "contact-places");
    if (scene.problem.contact.model != sim::ContactModel::compliant)
        return [=, problem = scene.problem](const Results& results) {
            return impulsive_places(problem, *results[study], end, lang);
        };
    const std::size_t table =
        studies.curve(study, {0, end, contact_rows(end)}, {}, {ChannelKind::contact_force, 0},
                      {sim::Channel{ChannelKind::contact_x}, sim::Channel{ChannelKind::contact_s}});
    return [=, problem = scene.problem](const Results& results) {
        const sim::Result& result = *results[study];
        return forceful_places(problem, result, result.tables[table], end, lang);
    };
}

}  // namespace

const Recipe kContactPlaces{
    "contact-places", {"Contact point on beam and cam", "梁与凸轮上的接触点"}, needs_cam, prepare_places};

}  // namespace beamcam::scenes
