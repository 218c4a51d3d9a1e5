// The static deflection of the supported beam by the paper's eq. (5), as printed and corrected.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "scenes/figures/recipes.hpp"
#include "sim/paper.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using sim::Printing;

constexpr int kPerSpan = 201;
constexpr std::array kSupports{0.25, 0.4, 0.55};  // of the horizontal length

// The rod that just touches the disc: its angle above the horizontal, or the initial one without a cam.
double angle_of(const sim::Problem& p) {
    if (!p.cam) return p.initial.angle;
    const double distance = norm(p.cam->centre);
    return std::asin(std::min(0.95, p.cam->radius / distance)) + std::atan2(p.cam->centre.y, p.cam->centre.x);
}

FigureMaker prepare(const Scene& scene, Lang lang, Studies&) {
    return [problem = scene.problem, lang](const Results&) {
        const bool en = lang == Lang::en;
        const double angle = angle_of(problem), reach = problem.beam.length * std::cos(angle);
        Figure figure;
        figure.name = "deflection";
        figure.title = en ? "Static deflection for several contact points" : "不同接触点的静挠度";
        Panel shape, slope;
        shape.letter = "a";
        slope.letter = "b";
        shape.x.label = slope.x.label = "$x$ / m";
        shape.y.label = "$w$ / mm";
        slope.y.label = "d$w$/d$x$ / 10^{−3}";
        shape.legend = Legend::box;
        slope.legend = Legend::box;
        double largest_jump = 0;
        int look = 0;
        for (const double share : kSupports) {
            const double support = share * reach;
            for (const Printing printing : {Printing::corrected, Printing::printed}) {
                const bool printed = printing == Printing::printed;
                Series w, d;
                for (const bool overhang : {false, true}) {
                    const double from = overhang ? support : 0, to = overhang ? reach : support;
                    for (int k = 0; k < kPerSpan; ++k) {
                        const double x = from + (to - from) * k / (kPerSpan - 1);
                        const sim::StaticDeflection s =
                            sim::supported_beam(problem, angle, support, x, printing, overhang);
                        w.x.push_back(x);
                        w.y.push_back(s.w * 1e3);
                        d.x.push_back(x);
                        d.y.push_back(s.slope * 1e3);
                    }
                }
                if (printed) largest_jump = std::max(largest_jump, std::abs(d.y[kPerSpan] - d.y[kPerSpan - 1]));
                w.look = d.look = look;
                w.solid = d.solid = !printed;
                w.color = d.color = render::figure::look(look).color;
                if (printed) w.look = d.look = 1, w.weight = d.weight = 0.9;
                if (!printed) w.label = fmt::format("$l_{{1}}$ = {} m", number(support, 3));
                shape.series.push_back(std::move(w));
                slope.series.push_back(std::move(d));
            }
            shape.marks.push_back({.x = support, .y = 0, .look = look});
            ++look;
        }
        // The key to solid and dashed, in black.
        for (const bool printed : {false, true}) {
            Series key;
            key.label = printed ? (en ? "as printed" : "原文公式") : (en ? "corrected" : "修正后");
            key.color = render::rgb(0x000000);
            key.look = 1;
            key.solid = !printed;
            slope.series.push_back(std::move(key));
        }
        shape.rules.push_back({.at = 0});
        slope.rules.push_back({.at = 0});
        figure.panels = {shape, slope};
        figure.share_x = true;
        figure.aspect = 1.15;
        figure.caption = filled(
            en ? "Static deflection $w$ (a) and slope (b) of the beam inclined by {}° ({}), supported at the hinge and "
                 "at "
                 "the horizontal distance $l_{{1}}$, by eq. (5) of the paper: as printed (dashed) and corrected "
                 "(solid). "
                 "As printed, the overhanging span lacks a term in each constant, so that its slope jumps at the "
                 "support, by up to {} × 10^{{−3}} here; and along the inclined rod the deflection is 1/cos^{{2}} $θ$ "
                 "larger. "
               : "倾角 {}°（{}）的梁支承于铰和水平距离 $l_{{1}}$ 处的静挠度 $w$ (a) 与斜率 (b)，按原文式 "
                 "(5)：原文公式（虚线）与修正后（实线）。"
                 "原文悬伸段两个常数各缺一项，支承处斜率发生跳变（此处最大 {} × 10^{{−3}}）；且沿倾斜梁的挠度应大 "
                 "1/cos^{{2}} $θ$ 倍。",
            number(angle * 180 / M_PI, 4),
            problem.cam ? (en ? "tangent to the centred disc" : "与对心圆盘相切")
                        : (en ? "the initial angle" : "初始角"),
            number(largest_jump, 3));
        figure.caption += assumptions(problem, lang);
        figure.accuracy = accuracy({}, lang);
        return figure;
    };
}

std::optional<std::string> refusal(const Scene& scene) {
    const double angle = angle_of(scene.problem);
    if (std::abs(std::cos(angle)) > 0.02) return std::nullopt;
    return fmt::format("eq. (5) of the paper measures along the horizontal; a beam at {:.3g}° has none",
                       angle * 180 / M_PI);
}

}  // namespace

const Recipe kDeflection{
    "deflection", {"Static deflection for several contact points", "不同接触点的静挠度"}, refusal, prepare};

}  // namespace beamcam::scenes
