// A motion at a glance: the deflection along the beam in time, the mechanism at several instants, impacts as maps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/mechanism/exaggeration.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/key_label.hpp"
#include "scenes/figures/recipes.hpp"
#include "sim/beam/modes.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using render::figure::Shape;
using sim::Vec2;

constexpr int kColumns = 600, kStations = 65;  // of a kymograph: a printed column resolves no more
constexpr int kMostLooks = 16;                 // at a column
constexpr int kShownPoses = 9;

// The stretch of the scene that a figure shows, and its poses.
struct Stretch {
    double from, to;
    std::size_t study, poses;
};
Stretch stretch(const Scene& scene, const FigureOutput& how, const char* name, int count, int stations,
                Studies& studies) {
    Stretch out{how.series.from, how.series.to.value_or(scene.end_time), 0, 0};
    out.study = studies.of(scene.problem, out.to, name);
    std::vector<sim::PoseRequest>& poses = studies.request(out.study).poses;
    out.poses = poses.size();
    poses.push_back({.times = instants({out.from, out.to, count}), .stations = stations});
    return out;
}

// ---- deflection along the beam in time --------------------------------------------------------------

// How often a column is looked at, so that vibrations that are faster than columns are not mistaken for slow ones.
std::size_t looks_at_column(const sim::Problem& problem, double column) {
    const std::vector<sim::Mode> modes = sim::natural_modes(problem, std::nullopt);
    if (modes.empty() || !(modes.front().omega > 0)) return 1;
    const double periods = column * modes.front().omega / (2 * std::numbers::pi);
    return periods < 0.25 ? 1 : static_cast<std::size_t>(std::clamp(std::ceil(8 * periods), 2.0, double(kMostLooks)));
}

// Of each column and station the value that is farthest from none.
std::vector<double> extremes(const std::vector<sim::Pose>& poses, std::size_t looks) {
    std::vector<double> out(kColumns * kStations, 0);
    for (std::size_t row = 0; row < poses.size(); ++row) {
        const std::vector<double> v = sim::deflection(poses[row]);
        for (std::size_t i = 0; i < kStations; ++i)
            if (double& most = out[row / looks * kStations + i]; row % looks == 0 || std::abs(v[i]) > std::abs(most))
                most = v[i];
    }
    return out;
}

FigureMaker prepare_kymograph(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const double column = (how.series.to.value_or(scene.end_time) - how.series.from) / kColumns;
    const std::size_t looks = looks_at_column(scene.problem, column);
    const Stretch shown = stretch(scene, how, "kymograph", kColumns * static_cast<int>(looks), kStations, studies);
    return [=, problem = scene.problem, lang = how.lang](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[shown.study];
        const std::vector<double> v = extremes(result.poses[shown.poses], looks);
        const auto [least, most] = std::ranges::minmax(v);
        const render::Prefix prefix = render::prefix_for(std::max(-least, most));
        const double range = most > least ? most - least : 1;
        Panel panel;
        panel.x.label = "$t$ / s";
        panel.y.label = "$x$ / m";
        panel.y.tight = true;
        panel.legend = Legend::none;
        panel.color_bar = render::figure::ColorBar{.label = fmt::format("$v$($x$, $t$) / {}m", prefix.symbol),
                                                   .from = least / prefix.factor,
                                                   .to = (least + range) / prefix.factor};
        render::figure::Cells cells;
        for (int k = 0; k <= kColumns; ++k) cells.x.push_back(shown.from + (shown.to - shown.from) * k / kColumns);
        for (int i = 0; i <= kStations; ++i) cells.y.push_back(problem.beam.length * i / kStations);
        for (std::size_t i = 0; i < kStations; ++i)
            for (std::size_t k = 0; k < kColumns; ++k)
                cells.colors.push_back(render::figure::map_color((v[k * kStations + i] - least) / range)),
                    cells.values.push_back(v[k * kStations + i] / prefix.factor);
        panel.cells.push_back(std::move(cells));
        int hits = 0;
        for (const sim::Impact& hit : result.impacts)
            if (hit.t_start >= shown.from && hit.t_start <= shown.to && strikes(problem, hit))
                panel.marks.push_back({.x = hit.t_start, .y = hit.x, .look = 1, .hollow = true}), ++hits;
        Figure figure;
        figure.name = "kymograph";
        figure.title = en ? "Deflection along the beam in time" : "梁挠度的时空图";
        figure.panels.push_back(std::move(panel));
        figure.caption = filled(en ? "Deflection $v$($x$, $t$) from the tangent at the root, along the beam and in "
                                     "time, a column each {} s. "
                                   : "相对根部切线的挠度 $v$($x$, $t$) 沿梁长与时间的分布，每列 {} s。",
                                number((shown.to - shown.from) / (kColumns - 1), 2));
        if (looks > 1)
            figure.caption += filled(en ? "The beam vibrates within a column, which has the largest deflection of {} "
                                          "instants. "
                                        : "一列之内梁多次振动，取 {} 个时刻中的最大挠度。",
                                     looks);
        if (hits > 0) figure.caption += en ? "Marks: impacts. " : "标记：冲击。";
        figure.caption += facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

// ---- the mechanism at several instants --------------------------------------------------------------

void add_pose(const sim::Pose& pose, const sim::Problem& problem, render::Color color, std::vector<Shape>& out,
              render::Bounds& extent) {
    for (const Vec2 p : pose.centreline) extent.add(p);
    if (problem.cam) extent.add(pose.disc_centre, problem.cam->radius);
    out.push_back({.kind = Shape::Kind::line, .points = pose.centreline, .color = color, .width = 1.6});
    if (!problem.cam) return;
    out.push_back({.kind = Shape::Kind::circle,
                   .centre = pose.disc_centre,
                   .radius = problem.cam->radius,
                   .color = color,
                   .width = 0.9});
    const Vec2 rim = pose.disc_centre + problem.cam->radius * sim::unit(pose.cam_angle);
    out.push_back({.kind = Shape::Kind::line, .points = {pose.disc_centre, rim}, .color = color, .width = 0.6});
}

// One instant: bodies to scale, and the force between them.
void add_bodies(const sim::Pose& pose, const sim::Problem& problem, std::vector<Shape>& out, render::Bounds& extent) {
    const render::Color ink = render::rgb(0x000000), steel = render::rgb(0xE4E6EB), red = render::rgb(0xD55E00);
    const auto body = [&](Shape shape) {
        shape.color = steel;
        out.push_back(shape);
        shape.kind = shape.kind == Shape::Kind::area ? Shape::Kind::line : Shape::Kind::circle;
        if (!shape.points.empty()) shape.points.push_back(shape.points.front());
        shape.color = ink, shape.width = 0.8;
        out.push_back(std::move(shape));
    };
    if (problem.cam) {
        extent.add(pose.disc_centre, problem.cam->radius);
        body({.kind = Shape::Kind::disc, .centre = pose.disc_centre, .radius = problem.cam->radius});
        const Vec2 rim = pose.disc_centre + problem.cam->radius * sim::unit(pose.cam_angle);
        out.push_back({.kind = Shape::Kind::line, .points = {pose.disc_centre, rim}, .color = ink, .width = 0.6});
    }
    if (problem.hub.radius > 0) body({.kind = Shape::Kind::disc, .radius = problem.hub.radius});
    const render::DrawnBeam beam = render::drawn_beam(problem, pose, 1, problem.beam.depth);
    Shape outline{.kind = Shape::Kind::area};
    for (std::size_t i = 0; i < beam.line.size(); ++i) outline.points.push_back(beam.face(i));
    for (std::size_t i = beam.line.size(); i-- > 0;) outline.points.push_back(beam.back(i));
    for (const Vec2 p : outline.points) extent.add(p);
    body(std::move(outline));
    if (!pose.nearest || !(pose.nearest->force > 0)) return;
    // On the beam, from the disc.
    const Vec2 at = pose.nearest->point, tip = at + 0.2 * problem.beam.length * pose.nearest->normal;
    extent.add(tip);
    out.push_back({.kind = Shape::Kind::arrow, .points = {at, tip}, .color = red, .width = 1});
    out.push_back({.kind = Shape::Kind::label,
                   .points = {tip},
                   .color = red,
                   .markup = "$F$ = " + render::quantity(pose.nearest->force, "N"),
                   .shift = {-0.4, 0.2},
                   .align = render::HAlign::right});
}

// Beyond the tip, where no other beam comes.
void add_instant(const sim::Pose& pose, std::vector<Shape>& out) {
    const Vec2 along = sim::unit(pose.theta);
    const bool level = std::abs(along.x) > 0.5;
    using render::figure::VAlign;
    out.push_back({.kind = Shape::Kind::label,
                   .points = {pose.centreline.back()},
                   .color = render::rgb(0x000000),
                   .markup = number(pose.t, 3) + " s",
                   .shift = along * 0.5,
                   .align = !level         ? render::HAlign::centre
                            : along.x >= 0 ? render::HAlign::left
                                           : render::HAlign::right,
                   .valign = level         ? VAlign::middle
                             : along.y > 0 ? VAlign::bottom
                                           : VAlign::top});
}

FigureMaker prepare_strobe(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const bool one = how.series.to && *how.series.to == how.series.from;
    const Stretch shown = stretch(scene, how, "strobe", one ? 2 : kShownPoses, kStations, studies);
    return [=, problem = scene.problem, lang = how.lang](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[shown.study];
        std::vector<sim::Pose> poses = result.poses[shown.poses];
        if (one) poses.resize(1);
        Panel panel;
        render::Bounds extent;
        if (one) add_bodies(poses.front(), problem, panel.shapes, extent);
        for (std::size_t k = 0; k < poses.size() && !one; ++k) {
            const double share = 0.15 + 0.85 * static_cast<double>(k) / static_cast<double>(poses.size() - 1);
            add_pose(poses[k], problem, render::figure::map_color(share), panel.shapes, extent);
        }
        const render::Color ink = render::rgb(0x000000);
        panel.shapes.push_back({.kind = Shape::Kind::disc, .radius_points = 2, .color = ink});
        if (problem.hub.radius > 0 && !one)
            panel.shapes.push_back(
                {.kind = Shape::Kind::circle, .radius = problem.hub.radius, .color = ink, .width = 0.9});
        if (problem.cam)
            panel.shapes.push_back(
                {.kind = Shape::Kind::disc, .centre = problem.cam->centre, .radius_points = 1.5, .color = ink});
        // First and last; together they would stand on each other.
        add_instant(poses.front(), panel.shapes);
        constexpr double kApart = 0.12;  // [rad]
        if (std::abs(poses.back().theta - poses.front().theta) > kApart) add_instant(poses.back(), panel.shapes);
        Figure figure;
        figure.name = "strobe";
        figure.title = en ? "The mechanism at several instants" : "机构的多时刻叠加";
        figure.panels.push_back(std::move(panel));
        // As the shapes need it, with the room around them and for words beside them.
        figure.aspect =
            std::clamp(0.1 + 0.85 * (extent.y1 - extent.y0) / std::max(extent.x1 - extent.x0, 1e-12), 0.3, 1.1);
        figure.caption =
            one ? filled(en ? "The mechanism at {} s, deflection to scale. " : "{} s 时的机构，挠度按比例。",
                         number(shown.from, 4))
                : filled(
                      en ? "The mechanism at {} instants from {} s (pale) to {} s (dark), equally spaced, deflection "
                           "to scale. "
                         : "机构在 {} 个等距时刻的位置，自 {} s（浅）至 {} s（深），挠度按比例。",
                      poses.size(), number(shown.from, 4), number(shown.to, 4));
        figure.caption += facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

// ---- impacts as maps --------------------------------------------------------------------------------

Panel map_panel(std::string x_label, std::string y_label) {
    Panel panel;
    panel.legend = Legend::none;
    panel.x.label = std::move(x_label), panel.y.label = std::move(y_label);
    panel.x.tight = false;
    panel.x.from = panel.y.from = 0;
    Series& points = panel.series.emplace_back();
    points.line = false, points.every_point = true;
    return panel;
}
void add(Panel& panel, double x, double y) { panel.series.front().x.push_back(x), panel.series.front().y.push_back(y); }

FigureMaker prepare_maps(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const double from = how.series.from, to = how.series.to.value_or(scene.end_time);
    const std::size_t study = studies.of(scene.problem, to, "impact-maps");
    return [=, problem = scene.problem, lang = how.lang](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[study];
        const auto speed = [&](const char* which, const char* zh) {
            return axis_label(kApproachSpeed.in(lang) + (en ? which : zh), "m/s");
        };
        Panel loss = map_panel(speed("", ""), en ? "rebound / approach speed" : "分离速度 / 接近速度"),
              next = map_panel(speed(" $k$", " $k$"), speed(" $k$ + 1", " $k$ + 1")),
              phase = map_panel(en ? "phase of the cam / (2π)" : "凸轮相位 / (2π)", speed("", ""));
        const auto shown = [&](const auto& touch) {
            return touch.t_start >= from && touch.t_start <= to && strikes(problem, touch);
        };
        for (const sim::Impact& hit : result.impacts) {
            if (!shown(hit)) continue;
            if (hit.restitution) add(loss, std::abs(hit.v_n_before), *hit.restitution);
            const double turns = hit.cam_angle / (2 * std::numbers::pi);
            add(phase, turns - std::floor(turns), std::abs(hit.v_n_before));
        }
        const std::vector<sim::Collision>& all = result.collisions;
        for (std::size_t k = 0; k + 1 < all.size(); ++k)
            if (shown(all[k]) && shown(all[k + 1]))
                add(next, std::abs(all[k].v_n_before), std::abs(all[k + 1].v_n_before));
        phase.x.to = 1;
        Figure figure;
        figure.name = "impact-maps";
        figure.title = en ? "Maps of the impacts" : "冲击映射";
        std::string words;
        const std::pair<Panel*, Words> panels[] = {
            {&loss,
             {"ratio of the normal speeds after and before each impact against its approach speed",
              "各次冲击的恢复比与接近速度"}},
            {&next,
             {"approach speed of each collision, $k$ + 1, against that of the one before, $k$",
              "相邻碰撞（第 $k$、$k$ + 1 次）的接近速度"}},
            {&phase, {"approach speed of each impact against the phase of the cam", "各次冲击的接近速度与凸轮相位"}}};
        for (const auto& [panel, what] : panels) {
            if (panel->series.front().x.empty()) continue;
            panel->letter = std::string(1, static_cast<char>('a' + figure.panels.size()));
            words += fmt::format("{}({}) {}", words.empty() ? "" : en ? "; " : "；", panel->letter, what.in(lang));
            figure.panels.push_back(std::move(*panel));
        }
        if (figure.panels.empty())
            throw render::PictureError(fmt::format(
                "figure impact-maps: nothing strikes the cam from {:g} s to {:g} s; raise time.end", from, to));
        figure.aspect = 0.7 * static_cast<double>(figure.panels.size());
        figure.caption = words + (en ? ". " : "。") + facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

// ---- how often ----------------------------------------------------------------------------------------

// How many of the values fall into each of equal intervals from 0 on; the last one holds `end`.
Panel histogram(std::string label, const std::vector<double>& values, double end) {
    const auto bins =
        static_cast<std::size_t>(std::clamp(std::ceil(std::sqrt(static_cast<double>(values.size()))), 6.0, 36.0));
    std::vector<double> counts(bins, 0);
    for (const double v : values)
        ++counts[std::min(bins - 1, static_cast<std::size_t>(v / end * static_cast<double>(bins)))];
    Panel panel;
    panel.legend = Legend::none;
    panel.x.label = std::move(label);
    panel.y.with_zero = panel.y.counts = true;
    Series steps;
    render::figure::Band area;
    for (std::size_t k = 0; k < bins; ++k)
        for (const std::size_t edge : {k, k + 1}) {
            steps.x.push_back(end * static_cast<double>(edge) / static_cast<double>(bins));
            steps.y.push_back(counts[k]);
        }
    area.x = steps.x, area.high = steps.y, area.low.assign(steps.x.size(), 0);
    panel.bands.push_back(std::move(area));
    panel.series.push_back(std::move(steps));
    return panel;
}

FigureMaker prepare_histograms(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const double from = how.series.from, to = how.series.to.value_or(scene.end_time);
    const std::size_t study = studies.of(scene.problem, to, "impact-histograms");
    return [=, problem = scene.problem, lang = how.lang](const Results& results) {
        const bool en = lang == Lang::en;
        std::vector<double> speeds, phases;
        for (const sim::Impact& hit : results[study]->impacts) {
            if (hit.t_start < from || hit.t_start > to || !strikes(problem, hit)) continue;
            const double turns = hit.cam_angle / (2 * std::numbers::pi);
            speeds.push_back(std::abs(hit.v_n_before)), phases.push_back(turns - std::floor(turns));
        }
        constexpr std::size_t kFewest = 5;
        if (speeds.size() < kFewest)
            throw render::PictureError(fmt::format(
                "figure impact-histograms: {} impacts from {:g} s to {:g} s are too few to be counted; raise "
                "time.end, or see impact-maps",
                speeds.size(), from, to));
        Figure figure;
        figure.name = "impact-histograms";
        figure.title = en ? "How often impacts have which speed and phase" : "冲击速度与相位的直方图";
        figure.panels = {
            histogram(axis_label(kApproachSpeed.in(lang), "m/s"), speeds, *std::ranges::max_element(speeds)),
            histogram(en ? "phase of the cam / (2π)" : "凸轮相位 / (2π)", phases, 1)};
        for (std::size_t k = 0; k < 2; ++k) {
            figure.panels[k].letter = std::string(1, static_cast<char>('a' + k));
            figure.panels[k].y.label = en ? "impacts" : "冲击次数";
        }
        figure.aspect = 1.2;
        const double bins = static_cast<double>(figure.panels[0].series[0].x.size()) / 2;
        figure.caption = filled(
            en ? "The {} impacts from {} s to {} s: how many have (a) which approach speed, in intervals of {} m "
                 "s^{{−1}}, (b) which phase of the cam, in intervals of {}. "
               : "{} 次冲击（{} s 至 {} s）：(a) 接近速度（区间宽 {} m s^{{−1}}）、(b) 凸轮相位（区间宽 {}）的次数。",
            speeds.size(), number(from, 4), number(to, 4), number(figure.panels[0].series[0].x.back() / bins, 2),
            number(1 / bins, 2));
        figure.caption += facts(problem, lang);
        figure.accuracy = accuracy({{&problem, results[study]}}, lang);
        return figure;
    };
}

std::optional<std::string> needs_bending(const Scene& scene) {
    if (scene.problem.beam.model != sim::ModelKind::rigid) return std::nullopt;
    return "a rigid beam does not bend; choose another beam.model";
}

}  // namespace

const Recipe kKymograph{
    "kymograph", {"Deflection along the beam in time", "梁挠度的时空图"}, needs_bending, prepare_kymograph, true};
const Recipe kStrobe{
    "strobe", {"The mechanism at several instants", "机构的多时刻叠加"}, no_refusal, prepare_strobe, true};
const Recipe kImpactMaps{"impact-maps", {"Maps of the impacts", "冲击映射"}, needs_cam, prepare_maps, true};
const Recipe kImpactHistograms{"impact-histograms",
                               {"How often impacts have which speed and phase", "冲击速度与相位的直方图"},
                               needs_cam,
                               prepare_histograms,
                               true};

}  // namespace beamcam::scenes
