// Impacts as maps and as histograms: restitution, successive speeds, and the phase of the cam at impact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {
namespace {

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
void add_point(Panel& panel, double x, double y) {
    panel.series.front().x.push_back(x), panel.series.front().y.push_back(y);
}

template <class Touch>
bool is_shown(const sim::Problem& problem, const Touch& touch, double from, double to) {
    return touch.t_start >= from && touch.t_start <= to && strikes(problem, touch);
}

// The phase of the cam in turns, 0…1.
double phase_of(const sim::Impact& hit) {
    const double turns = hit.cam_angle / (2 * std::numbers::pi);
    return turns - std::floor(turns);
}
const char* phase_label(bool en) { return en ? "phase of the cam / (2π)" : "凸轮相位 / (2π)"; }

// A logarithmic axis for ratios of very different size: a slow touch can leave much faster than it came.
void spread_ratios(Panel& panel) {
    constexpr double kSpread = 30;  // the largest by the smallest
    const std::vector<double>& ratios = panel.series.front().y;
    if (ratios.empty()) return;
    const auto [least, most] = std::ranges::minmax(ratios);
    if (!(least > 0 && most > kSpread * least)) return;
    panel.y.scale = render::Scale::logarithmic;
    panel.y.from.reset();
}

// Restitution against speed, each collision against the next, and two speeds of each impact against the cam's phase.
struct ImpactMaps {
    Panel loss, next, phase, hub;
};
ImpactMaps impact_maps(const sim::Problem& problem, const sim::Result& result, double from, double to, Lang lang) {
    const bool en = lang == Lang::en;
    const auto speed = [&](const char* which) { return axis_label(kApproachSpeed.in(lang) + which, "m/s"); };
    ImpactMaps out{map_panel(speed(""), en ? "coefficient of restitution" : "恢复系数"),
                   map_panel(speed(" $k$"), speed(" $k$ + 1")), map_panel(phase_label(en), speed("")),
                   map_panel(phase_label(en), "$\\dot{θ}$ / (rad s^{−1})")};
    const auto shown = [&](const auto& touch) { return is_shown(problem, touch, from, to); };
    for (const sim::Impact& hit : result.impacts) {
        if (!shown(hit)) continue;
        if (hit.restitution) add_point(out.loss, std::abs(hit.v_n_before), *hit.restitution);
        add_point(out.phase, phase_of(hit), std::abs(hit.v_n_before));
        if (hit.at_touch) add_point(out.hub, phase_of(hit), hit.at_touch->theta_dot);
    }
    const std::vector<sim::Collision>& all = result.collisions;
    for (std::size_t k = 0; k + 1 < all.size(); ++k)
        if (shown(all[k]) && shown(all[k + 1]))
            add_point(out.next, std::abs(all[k].v_n_before), std::abs(all[k + 1].v_n_before));
    out.phase.x.to = out.hub.x.to = 1;
    out.hub.y.from.reset();
    spread_ratios(out.loss);
    return out;
}

FigureMaker prepare_maps(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const double from = how.series.from, to = how.series.to.value_or(scene.end_time);
    const std::size_t study = studies.of(scene.problem, to, "impact-maps");
    return [=, problem = scene.problem, lang = how.lang](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[study];
        ImpactMaps maps = impact_maps(problem, result, from, to, lang);
        Figure figure;
        std::string words;
        const std::pair<Panel*, Translated> panels[] = {
            {&maps.loss,
             {"coefficient of restitution of each impact (the ratio of its normal speeds after and before) against its "
              "approach speed",
              "各次冲击的恢复系数（分离速度与接近速度之比）与接近速度"}},
            {&maps.next,
             {"approach speed of each collision, $k$ + 1, against that of the one before, $k$",
              "相邻碰撞（第 $k$、$k$ + 1 次）的接近速度"}},
            {&maps.phase,
             {"approach speed of each impact against the phase of the cam", "各次冲击的接近速度与凸轮相位"}},
            {&maps.hub,
             {"hub speed $\\dot{θ}$ at the touch against the phase of the cam",
              "接触时的角速度 $\\dot{θ}$ 与凸轮相位"}}};
        for (const auto& [panel, what] : panels) {
            if (panel->series.front().x.empty()) continue;
            panel->letter = std::string(1, static_cast<char>('a' + figure.panels.size()));
            words += fmt::format("{}({}) {}", words.empty() ? "" : en ? "; " : "；", panel->letter, what.in(lang));
            figure.panels.push_back(std::move(*panel));
        }
        if (figure.panels.empty())
            throw render::PictureError(fmt::format(
                "figure impact-maps: nothing strikes the cam from {:g} s to {:g} s; raise time.end", from, to));
        figure.aspect = 0.6 * static_cast<double>(figure.panels.size());
        figure.caption = words + (en ? ". " : "。") + facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

// Counts the values in equal intervals from 0 to `end`, which the last one includes.
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
            if (!is_shown(problem, hit, from, to)) continue;
            speeds.push_back(std::abs(hit.v_n_before)), phases.push_back(phase_of(hit));
        }
        constexpr std::size_t kFewest = 5;
        if (speeds.size() < kFewest)
            throw render::PictureError(fmt::format(
                "figure impact-histograms: {} impacts from {:g} s to {:g} s are too few for a histogram; raise "
                "time.end, or see impact-maps",
                speeds.size(), from, to));
        Figure figure;
        figure.panels = {
            histogram(axis_label(kApproachSpeed.in(lang), "m/s"), speeds, *std::ranges::max_element(speeds)),
            histogram(phase_label(en), phases, 1)};
        for (std::size_t k = 0; k < 2; ++k) {
            figure.panels[k].letter = std::string(1, static_cast<char>('a' + k));
            figure.panels[k].y.label = en ? "impacts" : "冲击次数";
        }
        figure.aspect = 1.2;
        const double bins = static_cast<double>(figure.panels[0].series[0].x.size()) / 2;
        figure.caption = filled(
            en ? "Histograms of the {} impacts from {} s to {} s: (a) approach speed, in intervals of {} m s^{{−1}}; "
                 "(b) phase of the cam, in intervals of {}. "
               : "{} 次冲击（{} s 至 {} s）：(a) 接近速度（区间宽 {} m s^{{−1}}）、(b) 凸轮相位（区间宽 {}）的次数。",
            speeds.size(), number(from, 4), number(to, 4), number(figure.panels[0].series[0].x.back() / bins, 2),
            number(1 / bins, 2));
        figure.caption += facts(problem, lang);
        figure.accuracy = accuracy({{&problem, results[study]}}, lang);
        return figure;
    };
}

}  // namespace

const Recipe kImpactMaps{"impact-maps", {"Maps of the impacts", "冲击映射"}, needs_cam, prepare_maps, true};
const Recipe kImpactHistograms{"impact-histograms",
                               {"Histograms of impact speed and phase", "冲击速度与相位的直方图"},
                               needs_cam,
                               prepare_histograms,
                               true};

}  // namespace beamcam::scenes
