// Impacts as maps: restitution, successive speeds, and the phase of the cam at impact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

// Panel of points from zero on.
Panel map_panel(std::string title, std::string caption, std::string x_label, std::string y_label) {
    return {.title = std::move(title),
            .caption = std::move(caption),
            .x = {.label = std::move(x_label), .from = 0},
            .y = {.label = std::move(y_label), .from = 0},
            .series = {{.line = false, .every_point = true}},
            .legend = false};
}

// Ratios above the first have a logarithmic axis: a slow touch can leave much faster than it came. So have speeds whose
// ratio is above the second: most impacts of a collision are slow.
constexpr double kLargestLinearRatio = 3, kLargestLinearSpread = 50;

void spread(const std::vector<double>& speeds, std::initializer_list<render::Axis*> axes) {
    if (speeds.empty()) return;
    const auto [least, most] = std::ranges::minmax(speeds);
    if (!(least > 0 && most > kLargestLinearSpread * least)) return;
    for (render::Axis* axis : axes) {
        axis->scale = render::Scale::logarithmic;
        axis->from.reset();
    }
}

// Restitution against speed, and the speed of each impact against the cam's phase; in a second row each collision
// against the next, if there are enough, and the hub's speed.
std::vector<Panel> impact_maps(const Subject& subject, const sim::Result& result, double from, double to) {
    const auto& [problem, units, lang, end] = subject;
    const auto speed = [](const char* of) { return axis_label(of, "m/s"); };
    const Measure turning = measure_in(units, "rad/s");
    const double law = problem.contact.restitution;
    const std::string turn = phrase(lang, "cam phase / turn");
    Panel loss = map_panel(phrase(lang, "restitution"),
                           "restitution $c$ of the point of contact, dashed: the contact law's " + number(law, 3) +
                               ", and 1, above which the vibration or the cam adds speed",
                           speed("$v$"), "$c$"),
          next = map_panel(phrase(lang, "next collision"), "approach speeds of successive collisions, grey: equal ones",
                           speed("$v_{k}$"), speed("$v_{k+1}$")),
          phase =
              map_panel(phrase(lang, "approach speed"), "approach speed by the phase of the cam", turn, speed("$v$")),
          hub = map_panel(phrase(lang, "hub speed"), "hub speed", turn, axis_label("$\\dot{θ}$", turning.unit));
    for (const sim::Impact& hit : strikes(problem, result.impacts, from, to)) {
        if (hit.restitution) loss.series[0].add(std::abs(hit.v_n_before), *hit.restitution);
        const double at = std::fmod(hit.t_start / sim::cam_period(problem), 1);
        phase.series[0].add(at, std::abs(hit.v_n_before));
        if (hit.at_touch) hub.series[0].add(at, turning.factor * hit.at_touch->theta_dot);
    }
    const std::vector<sim::Collision> all = strikes(problem, result.collisions, from, to);
    for (std::size_t k = 0; k + 1 < all.size(); ++k)
        next.series[0].add(std::abs(all[k].v_n_before), std::abs(all[k + 1].v_n_before));
    loss.rules = {{.at = 1}, {.at = law}};
    const double largest = loss.series[0].y.empty() ? 1 : std::max(1.0, std::ranges::max(loss.series[0].y));
    loss.y.to = 1.05 * largest;
    if (largest > kLargestLinearRatio) loss.y.scale = render::Scale::logarithmic, loss.y.from.reset();
    spread(loss.series[0].x, {&loss.x}), spread(phase.series[0].y, {&phase.y});
    phase.x.to = hub.x.to = 1;
    hub.y.from.reset();
    std::vector<Panel> panels{loss};
    const bool turns = problem.cam->speed != 0;  // else all impacts have one phase
    if (turns) panels.push_back(phase);
    constexpr std::size_t kFewest = 3;  // collisions that are followed by another
    if (next.series[0].x.size() < kFewest) return panels;
    const auto [slowest, fastest] = std::ranges::minmax(next.series[0].x);
    spread(next.series[0].x, {&next.x, &next.y});
    const double first = next.x.from ? 0 : slowest;
    next.series.push_back(
        {.x = {first, fastest}, .y = {first, fastest}, .solid = true, .weight = 0.5, .color = render::rgb(0x777777)});
    panels.push_back(next);
    if (turns) panels.push_back(hub);
    return panels;
}

FigureDrawing prepare_maps(const Scene& scene, const FigureOutput& how, MotionRequests& requests) {
    const double from = how.series.from, to = how.series.to.value_or(scene.end_time);
    const std::size_t motion = requests.motion(scene.problem, to);
    const auto draw = [=](const Subject& subject, const sim::Result& result) -> Figure {
        constexpr std::size_t kFewest = 5;
        const std::size_t count = strikes(subject.problem, result.impacts, from, to).size();
        if (count < kFewest)
            throw render::PictureError(
                fmt::format("figure impact-maps: only {} from {:g} s to {:g} s, too few for a map; raise time.end",
                            counted(count, "impact"), from, to));
        std::vector<Panel> panels = impact_maps(subject, result, from, to);
        const double aspect = 0.8 * static_cast<double>(panels.size());
        return {.panels = lettered(std::move(panels)), .in_pairs = true, .aspect = aspect};
    };
    return figure_of_motion(motion, draw);
}

}  // namespace

extern const FigureType kImpactMaps{
    .name = "impact-maps", .title = "Impacts", .refusal = needs_cam, .maker = prepare_maps, .keys = {"from", "to"}};

}  // namespace beamcam::scenes
