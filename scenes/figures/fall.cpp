// Falling without a cam: the hub angle of the flexible and the rigid beam, and the vibration of the free end.
#include <fmt/format.h>

#include <cmath>

#include "scenes/figures/recipes.hpp"
#include "sim/paper.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using sim::ChannelKind;

constexpr int kCurve = 2001;  // points: a column of print has fewer dots
constexpr int kVibration = 12001;
constexpr double kAround = 12e-6;  // the enlarged stretch about the rigid crossing [s]

// Where the inset looks: only the hinged rod at rest has the closed form that tells beforehand.
std::optional<double> closed_form(const sim::Problem& p) {
    const bool plain = std::holds_alternative<sim::FreeDrive>(p.hub.drive) && p.hub.radius == 0 && p.hub.inertia == 0 &&
                       p.initial.angular_velocity == 0 && p.initial.shape == sim::InitialShape::straight &&
                       p.initial.angle > 0 && p.initial.angle < 1.57 && p.gravity > 0;
    if (!plain) return std::nullopt;
    return sim::rod_fall_time(p.beam.length, p.gravity, p.initial.angle, 1);
}

struct Fall {
    std::size_t study = 0, table = 0;
    std::optional<std::size_t> close;
};

Series curve(const sim::Table& t, std::string label, int look) {
    Series s;
    s.label = std::move(label);
    s.look = look;
    s.x = column(t, ChannelKind::t);
    s.y = column(t, ChannelKind::theta);
    return s;
}

void mark_zero(Panel& panel, const sim::Result& result, int look, bool hollow) {
    if (!result.theta_zero.empty())
        panel.marks.push_back({.x = result.theta_zero.front().t, .y = 0, .look = look, .hollow = hollow});
}

// The curve's name and the time of its zero, which the mark shows.
std::string with_zero(const std::string& name, const sim::Result& result, int decimals) {
    return result.theta_zero.empty() ? name : name + ": " + grouped(result.theta_zero.front().t, decimals) + " s";
}

FigureMaker prepare_fall(const Scene& scene, Lang lang, Studies& studies) {
    const double end = scene.end_time;
    const sim::Problem flexible = without_cam(scene.problem), stiff = rigid(flexible);
    sim::Problem doubled = stiff;
    doubled.gravity *= 2;
    const std::optional<double> exact = closed_form(flexible);
    const bool close = exact && *exact + kAround < end;
    const auto want = [&](const sim::Problem& p, bool enlarged) {
        Fall fall;
        fall.study = studies.of(p, end, "free-fall");
        studies.turning_points(fall.study);
        fall.table = studies.table(fall.study, {0, end, kCurve}, {ChannelKind::t, ChannelKind::theta});
        if (enlarged)
            fall.close = studies.table(fall.study, {*exact - kAround, *exact + kAround, 241},
                                       {ChannelKind::t, ChannelKind::theta});
        return fall;
    };
    const Fall f = want(flexible, close), r = want(stiff, close), d = want(doubled, false);
    return [=](const Results& results) {
        const bool en = lang == Lang::en;
        Figure figure;
        figure.name = "free-fall";
        figure.title = en ? "Hub angle of the free fall" : "自由下落的转角";
        Panel panel;
        panel.x.label = "$t$ / s";
        panel.y.label = "$θ$ / rad";
        panel.legend = Legend::box;
        // Room above the curves for the legend.
        panel.y.to = 1.75 * std::abs(flexible.initial.angle) + 0.01;
        const sim::Result &flex = *results[f.study], &rod = *results[r.study], &twice = *results[d.study];
        panel.rules.push_back({.at = 0});
        panel.series.push_back(curve(flex.tables[f.table], with_zero(en ? "flexible" : "柔性梁", flex, 9), 0));
        panel.series.push_back(curve(rod.tables[r.table], with_zero(en ? "rigid" : "刚性杆", rod, 9), 1));
        panel.series.push_back(
            curve(twice.tables[d.table], with_zero(en ? "rigid, torque doubled" : "刚性杆，力矩加倍", twice, 6), 2));
        panel.series[0].solid = true;
        mark_zero(panel, twice, 2, false);
        if (f.close) {
            // Microseconds about the closed form, microradians about zero.
            Panel close_up;
            close_up.x.label = filled("($t$ − {} s) / µs", grouped(*exact, 6));
            close_up.y.label = "$θ$ / µrad";
            close_up.legend = Legend::none;
            close_up.rules.push_back({.at = 0});
            for (const auto& [fall, result, look] : {std::tuple{&f, &flex, 0}, std::tuple{&r, &rod, 1}}) {
                Series s = curve(result->tables[*fall->close], "", look);
                for (double& t : s.x) t = (t - *exact) * 1e6;
                s.y = scaled(s.y, 1e6);
                s.solid = look == 0;
                close_up.series.push_back(std::move(s));
                if (!result->theta_zero.empty()) {
                    const double t = result->theta_zero.front().t;
                    close_up.marks.push_back({.x = (t - *exact) * 1e6, .y = 0, .look = look});
                }
            }
            const double slope = rod.theta_zero.empty() ? 5 : std::abs(rod.theta_zero.front().theta_dot);
            panel.insets.push_back({.panel = {close_up},
                                    .width = 0.36,
                                    .height = 0.34,
                                    .source = render::figure::Inset::Source{*exact - kAround, *exact + kAround,
                                                                            -slope * kAround, slope * kAround}});
        } else {
            mark_zero(panel, flex, 0, false);
            mark_zero(panel, rod, 1, true);
        }
        figure.panels.push_back(std::move(panel));
        figure.aspect = 0.74;
        const auto zero = [&](const sim::Result& x) {
            return x.theta_zero.empty() ? std::string("–") : grouped(x.theta_zero.front().t, 9) + " s";
        };
        figure.caption = filled(
            en ? "Hub angle of the free fall from rest without a cam: flexible beam, exact rigid rod, and the rigid "
                 "rod "
                 "under twice its gravity torque, which alone gives the 0.262 s that the paper prints for the rigid "
                 "rod. $θ$ = 0, marked, is reached at {} (flexible), {} (rigid), {} (torque doubled): the flexible "
                 "beam falls "
                 "like the rigid rod. "
               : "无凸轮时由静止自由下落的转角：柔性梁、精确刚性杆，以及重力矩加倍的刚性杆（只有后者给出原文所列刚性杆"
                 "的 0.262 s）。到达 "
                 "$θ$ = 0 的时刻：柔性梁 {}，刚性杆 {}，力矩加倍 {}；柔性梁与刚性杆的下落几乎一致。",
            zero(flex), zero(rod), zero(twice));
        figure.caption += assumptions(flexible, lang);
        figure.accuracy = accuracy({{&flexible, &flex}, {&stiff, &rod}}, lang);
        return figure;
    };
}

FigureMaker prepare_tip(const Scene& scene, Lang lang, Studies& studies) {
    const double end = scene.end_time;
    const std::size_t study = studies.of(scene.problem, end, "tip-vibration");
    const std::size_t table = studies.table(study, {0, end, kVibration}, {ChannelKind::t, ChannelKind::tip_deflection});
    return [=, problem = scene.problem](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[study];
        Figure figure;
        figure.name = "tip-vibration";
        figure.title = en ? "Transverse vibration of the free end" : "自由端的横向振动";
        Panel panel;
        panel.x.label = "$t$ / s";
        Series s;
        s.x = column(result.tables[table], ChannelKind::t);
        s.y = column(result.tables[table], ChannelKind::tip_deflection);
        double largest = 0;
        for (const double v : s.y)
            if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
        // Millimetres, or micrometres where those would be hundredths.
        const bool micro = largest < 5e-4;
        s.y = scaled(s.y, micro ? 1e6 : 1e3);
        panel.y.label = micro ? "$v$($L$, $t$) / µm" : "$v$($L$, $t$) / mm";
        s.weight = 0.75;
        panel.rules.push_back({.at = 0});
        panel.series.push_back(std::move(s));
        figure.panels.push_back(std::move(panel));
        figure.aspect = 0.55;
        figure.caption = filled(en ? "Transverse deflection of the free end from the tangent at the root{}. "
                                   : "自由端相对根部切线的横向挠度{}。",
                                problem.cam ? "" : (en ? " during the free fall" : "（自由下落过程）"));
        figure.caption += stated(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

std::optional<std::string> needs_flexible(const Scene& scene) {
    if (scene.problem.beam.model != sim::ModelKind::rigid) return std::nullopt;
    return "a rigid beam does not vibrate; choose another beam.model";
}

}  // namespace

const Recipe kFreeFall{"free-fall", {"Hub angle of the free fall", "自由下落的转角"}, needs_free_hub, prepare_fall};
const Recipe kTipVibration{
    "tip-vibration", {"Transverse vibration of the free end", "自由端的横向振动"}, needs_flexible, prepare_tip};

}  // namespace beamcam::scenes
