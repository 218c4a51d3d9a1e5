// The static deflection of the beam on a support; in the paper's scenes also by its eq. (5), as printed and completed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <span>

#include "scenes/figures/figure_types.hpp"
#include "sim/studies/paper.hpp"

namespace beamcam::scenes {
namespace {

using sim::Printing;

constexpr int kPerSpan = 201;
constexpr double kLeastReach = 0.02;              // cos θ: below it the beam is nearly vertical
constexpr std::array kSupports{0.25, 0.4, 0.55};  // of the horizontal length

// The inclination of the beam that is drawn [rad].
struct Inclination {
    double angle = 0;
    bool tangent = false;  // to the disc as if it were centred
};

// The rod that is tangent to the disc, or the initial angle if there is no such rod.
Inclination inclination(const sim::Problem& p) {
    if (p.cam && !p.cam->profile) {
        const double distance = norm(p.cam->centre), radius = p.cam->radius;
        if (distance > radius && std::sqrt(distance * distance - radius * radius) < p.beam.length) {
            const double angle = std::asin(radius / distance) + std::atan2(p.cam->centre.y, p.cam->centre.x);
            if (std::cos(angle) > kLeastReach) return {angle, true};
        }
    }
    return {p.initial.angle, false};
}

struct Curves {
    Printing printing;
    const char* label;
    int look;  // the line style
};
constexpr std::array kCurves{Curves{Printing::corrected, "along the rod", 0},
                             Curves{Printing::completed, "eq. (5), completed", 2},
                             Curves{Printing::printed, "eq. (5), printed", 1}};

// Deflection [mm] and slope along the beam [10⁻³] over both spans.
struct DeflectionCurves {
    Series v, slope;
};
DeflectionCurves shape_of(const sim::Problem& problem, double angle, double support, std::size_t i, const Curves& c,
                          Lang lang) {
    const double reach = problem.beam.length * std::cos(angle);
    const bool first = c.printing == Printing::corrected;
    DeflectionCurves out;
    out.v = {.name = fmt::format("$l_{{1}}$ = {}, {}", length_text(support), phrase(lang, c.label)),
             .look = c.look,
             .solid = first,
             .weight = first ? 1 : 0.9,
             .color = render::figure::look(static_cast<int>(i)).color};
    out.slope = out.v;
    if (first) out.v.label = fmt::format("$l_{{1}}$ = {}", length_text(support));  // the key to the colours
    for (const bool overhang : {false, true}) {
        const double from = overhang ? support : 0, to = overhang ? reach : support;
        for (int k = 0; k < kPerSpan; ++k) {
            const double x = from + (to - from) * k / (kPerSpan - 1);
            const sim::StaticDeflection s = sim::supported_beam(problem, angle, support, x, c.printing, overhang);
            out.v.add(x, s.v * 1e3);
            out.slope.add(x, s.slope * std::cos(angle) * 1e3);  // dx/ds = cos θ
        }
    }
    return out;
}

Figure deflection_figure(const Subject& subject, const MotionResults&) {
    const auto& [problem, units, lang, end] = subject;
    const Inclination at = inclination(problem);
    const double reach = problem.beam.length * std::cos(at.angle);
    const std::span curves(kCurves.data(), is_of_the_paper(problem) ? kCurves.size() : 1);
    const bool several = curves.size() > 1;
    Panel shape{.x = {.label = phrase(lang, "horizontal distance $x$ from $O$ / m"), .tight = true},
                .y = {.label = "$v$ / mm"},
                .rules = {{.at = 0}}},
        slope{.x = shape.x, .y = {.label = "d$v$/d$s$ / 10^{−3}"}, .rules = {{.at = 0}}};
    std::vector<std::string> supports;
    for (std::size_t i = 0; i < kSupports.size(); ++i) {
        const double support = kSupports[i] * reach;
        for (const Curves& c : curves) {
            DeflectionCurves s = shape_of(problem, at.angle, support, i, c, lang);
            shape.series.push_back(std::move(s.v));
            slope.series.push_back(std::move(s.slope));
        }
        shape.marks.push_back({.x = support, .look = static_cast<int>(i)});
        supports.push_back(length_text(support));
    }
    // The key to the dashes, in black.
    for (std::size_t k = 0; several && k < curves.size(); ++k)
        shape.series.push_back({.label = phrase(lang, curves[k].label),
                                .look = curves[k].look,
                                .solid = curves[k].printing == Printing::corrected,
                                .color = render::rgb(0x000000)});
    shape.caption = "static deflection across the beam", slope.caption = "slope along it";
    Figure figure{
        .title = fmt::format("The beam at rest, inclined by {}°{}, hinged at "
                             "$O$, supported at the marks, $l_{{1}}$ = {}{}",
                             number(at.angle * 180 / M_PI, 4), at.tangent ? ", tangent to the centred disc" : "",
                             fmt::join(supports, ", "),
                             several ? "; eq. (5) is that of Acta Physica Sinica 65, 240502 (2016), as printed "
                                       "and with its missing terms"
                                     : ""),
        .panels = lettered({std::move(shape), std::move(slope)}),
        .share_x = true,
        .aspect = 1.15};
    add_caption(figure, std::vector{problem}, units);
    return figure;
}

FigureDrawing prepare_deflection(const Scene&, const FigureOutput&, MotionRequests&) { return deflection_figure; }

std::optional<std::string> needs_static_bending(const Scene& scene) {
    const sim::Problem& p = scene.problem;
    if (auto why = needs_bending(scene)) return why;
    if (p.gravity == 0) return "without gravity nothing bends the beam; set gravity";
    if (p.hub.radius != 0 || sim::is_prescribed(p.hub.drive))
        return "the supported beam is hinged at O; set hub.radius to 0 and hub.drive to {\"type\": \"free\"}";
    const double angle = inclination(p).angle;
    if (std::cos(angle) > kLeastReach) return std::nullopt;
    return fmt::format(
        "it measures along the horizontal to the right of O, where a beam at {:.3g}° does not reach; set "
        "initial.angle",
        angle * 180 / M_PI);
}

}  // namespace

extern const FigureType kDeflection{"deflection", "Static deflection for several contact points", needs_static_bending,
                                    prepare_deflection};

}  // namespace beamcam::scenes
