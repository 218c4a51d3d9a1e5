// The paper's trial method (S49): which point of the falling beam reaches the cam first. The trial, its refinement and
// the curves use one simulation of the fall.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "sim/problem/problem.hpp"
#include "sim/studies/paper.hpp"

namespace beamcam::scenes {
namespace {

// Instants of the fall: a quarter of a millisecond apart, or nearer in a short scene.
int fall_rows(double end) { return static_cast<int>(std::clamp(end / 2.5e-4, 4e3, 4e4)) + 1; }
constexpr int kTrial = 5;     // points of the first round: 0.21 … 0.25 m in the paper
constexpr int kRefined = 8;   // intervals between two trial points in the second round
constexpr double kShown = 4;  // before the touch, of the time between the zeros; after it half as much
constexpr const char* kDistanceTitle = "Points of the freely falling beam near the first touch of the cam";
constexpr double kNever = std::numeric_limits<double>::infinity();

// Places on the beam at the paper's spacing of L/100, as far as the touch may be from where the rigid beam at the
// cam's first phase would touch, x₁: the cam turns meanwhile, and the face that it meets may be off the centre line.
struct Stations {
    std::vector<double> x;
    std::size_t middle = 0;  // nearest to x₁
};
Stations stations(const sim::Problem& p) {
    constexpr int kNeighbours = 16, kLast = 100;
    const double x1 = sim::tangent_distance(*p.cam, p.cam->phase, sim::Printing::corrected) - p.hub.radius;
    const double spacing = p.beam.length / kLast;
    const int middle = std::clamp(static_cast<int>(std::round(x1 / spacing)), 2, kLast - 2);
    const int first = std::max(0, middle - kNeighbours), last = std::min(kLast, middle + kNeighbours);
    Stations out;
    for (int k = first; k <= last; ++k) out.x.push_back(k * spacing);
    out.middle = static_cast<std::size_t>(middle - first);
    return out;
}

struct DistanceHistory {
    std::vector<double> t, x;                   // instants, arc positions
    std::vector<std::vector<double>> distance;  // [m], by position, then instant
};

// The weights of four values in the cubic through them, at `at`.
std::array<double, 4> cubic_weights(const std::array<double, 4>& nodes, double at) {
    std::array<double, 4> weights{1, 1, 1, 1};
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
            if (b != a) weights[a] *= (at - nodes[b]) / (nodes[a] - nodes[b]);
    return weights;
}

// The distance of a point from the cam's surface over the instants `t` [m]. `place` counts stations; between them the
// position is interpolated by a cubic through the four around it.
std::vector<double> distance(const sim::Result& fall, const std::vector<std::size_t>& stations, double place,
                             const std::vector<double>& t, const sim::Problem& problem) {
    const std::size_t first = std::clamp<std::size_t>(static_cast<std::size_t>(place), 1, stations.size() - 3) - 1;
    const std::array<double, 4> weights = cubic_weights({0, 1, 2, 3}, place - static_cast<double>(first));
    std::vector<double> out;
    for (std::size_t i = 0; i < t.size(); ++i) {
        sim::Vec2 at;
        for (std::size_t a = 0; a < 4; ++a) at = at + weights[a] * fall.points[stations[first + a]][i];
        out.push_back(norm(at - disc_centre(*problem.cam, t[i])) - problem.cam->radius - contact_offset(problem));
    }
    return out;
}

// First zero of a falling distance, by a cubic through the four samples around it.
double arrival(const std::vector<double>& t, const std::vector<double>& d) {
    for (std::size_t i = 1; i < d.size(); ++i) {
        if (!(d[i - 1] > 0 && d[i] <= 0)) continue;
        const std::size_t k = std::clamp<std::size_t>(i, 2, d.size() - 2) - 2;
        const auto cubic = [&](double at) {
            const std::array<double, 4> weights = cubic_weights({t[k], t[k + 1], t[k + 2], t[k + 3]}, at);
            double sum = 0;
            for (std::size_t a = 0; a < 4; ++a) sum += weights[a] * d[k + a];
            return sum;
        };
        // Halving the sample's width 60 times leaves rounding.
        double low = t[i - 1], high = t[i];
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = 0.5 * (low + high);
            (cubic(middle) > 0 ? low : high) = middle;
        }
        return high;
    }
    return kNever;
}

// The first of the trial points among the stations: they are centred on x₁, unless the earliest zero is at their edge
// or beyond it.
template <class ArrivalAt>
std::size_t trial_begin(const Stations& searched, const ArrivalAt& arrival_at) {
    constexpr std::size_t kMiddle = kTrial / 2;
    std::size_t middle = searched.middle;
    double earliest = kNever;
    for (std::size_t k = 0; k < searched.x.size(); ++k)
        if (const double t = arrival_at(static_cast<double>(k)); t < earliest) earliest = t, middle = k;
    const std::size_t away = std::max(middle, searched.middle) - std::min(middle, searched.middle);
    if (away < kMiddle) middle = searched.middle;
    return std::clamp<std::size_t>(middle, kMiddle, searched.x.size() - 1 - kMiddle) - kMiddle;
}

// The trial points in both rounds, with when each reaches the cam.
struct Trial {
    DistanceHistory history;
    std::vector<double> when;                // [s], as history.x; kNever: not within the scene
    std::size_t first = 0, first_trial = 0;  // of all the earliest, and of the first round's

    // Of the k-th point, if it is of the first round.
    static int look(std::size_t k) { return static_cast<int>(k) / kRefined; }
};
Trial try_points(const sim::Result& fall, const Stations& searched, const std::vector<std::size_t>& where,
                 std::vector<double> times, const sim::Problem& problem) {
    Trial out;
    DistanceHistory& f = out.history;
    f.t = std::move(times);
    const auto arrival_at = [&](double place) { return arrival(f.t, distance(fall, where, place, f.t, problem)); };
    const std::size_t begin = trial_begin(searched, arrival_at);
    const double spacing = searched.x[1] - searched.x[0];
    for (int k = 0; k <= (kTrial - 1) * kRefined; ++k) {
        const double place = static_cast<double>(begin) + static_cast<double>(k) / kRefined;
        f.x.push_back(searched.x.front() + place * spacing);
        f.distance.push_back(distance(fall, where, place, f.t, problem));
        out.when.push_back(arrival(f.t, f.distance.back()));
    }
    out.first = static_cast<std::size_t>(std::ranges::min_element(out.when) - out.when.begin());
    for (std::size_t k = 0; k < out.when.size(); k += kRefined)
        if (out.when[k] < out.when[out.first_trial]) out.first_trial = k;
    if (out.when[out.first] == kNever)
        throw render::PictureError(
            fmt::format("figure distance: no point of the beam between {:g} and {:g} m reaches the "
                        "cam before {:g} s; raise time.end",
                        searched.x.front(), searched.x.back(), f.t.back()));
    return out;
}

Panel distance_panel(const Trial& trial) {
    const DistanceHistory& f = trial.history;
    const double touch = trial.when[trial.first], last = std::ranges::max(trial.when);  // or kNever
    const double shown = std::clamp(kShown * (last - touch), 0.01 * touch, 0.25 * touch);
    const auto is_shown = [&](double t) { return t >= touch - shown && t <= touch + 0.5 * shown; };
    double farthest = 0;  // [m]
    for (std::size_t k = 0; k < f.x.size(); k += kRefined)
        for (std::size_t i = 0; i < f.t.size(); ++i)
            if (is_shown(f.t[i])) farthest = std::max(farthest, std::abs(f.distance[k][i]));
    const Measure time = measure_of("s", touch), length = measure_of("m", farthest);
    Panel panel{.caption = "their distance $D$′ from the cam",
                .x = {.label = axis_label("$t$", time.unit), .tight = true},
                .y = {.label = axis_label("$D$′", length.unit)},
                .rules = {{.at = 0}}};
    for (std::size_t k = 0; k < f.x.size(); k += kRefined) {
        Series& s = panel.series.emplace_back();
        s.label = (k == 0 ? "$x$ = " : "") + length_text(f.x[k]);
        s.look = Trial::look(k);
        for (std::size_t i = 0; i < f.t.size(); ++i)
            if (is_shown(f.t[i])) s.add(f.t[i] * time.factor, f.distance[k][i] * length.factor);
    }
    return panel;
}

// When each point reaches the cam: the first round as points, the refinement beside its earliest as a line.
Panel arrivals_panel(const Trial& trial, const sim::Result& strikes, Lang lang) {
    const Measure time = measure_of("s", trial.when[trial.first]);
    Panel panel{.caption = "when it is zero, with the refinement of the trial as a line",
                .x = {.label = "$x$ / m"},
                .y = {.label = axis_label("$t_{0}$", time.unit)},
                .series = {{.weight = 0.6, .color = render::figure::kMuted}},
                .legend = false};
    for (std::size_t k = 0; k < trial.when.size(); ++k) {
        if (trial.when[k] == kNever) continue;
        const double x = trial.history.x[k], t = trial.when[k] * time.factor;
        if (k + kRefined >= trial.first_trial && k <= trial.first_trial + kRefined) panel.series.front().add(x, t);
        if (k % kRefined == 0)
            panel.series.push_back({.x = {x}, .y = {t}, .look = Trial::look(k), .line = false, .every_point = true});
    }
    if (strikes.impacts.empty()) return panel;
    const sim::Impact& touch = strikes.impacts.front();
    panel.caption +=
        fmt::format(", and the located touch at $x$ = {} m after {} s", number(touch.x, 4), grouped(touch.t_start, 6));
    panel.rules.push_back({.at = touch.x, .vertical = true, .label = phrase(lang, "located")});
    return panel;
}

FigureDrawing prepare_distance(const Scene& scene, const FigureOutput&, MotionRequests& requests) {
    const sim::Problem falling = without_cam(scene.problem);
    const Instants all{0, scene.end_time, fall_rows(scene.end_time)};
    const std::size_t fall = requests.motion(falling, scene.end_time);
    const Stations searched = stations(scene.problem);
    std::vector<std::size_t> where;
    for (const double x : searched.x) where.push_back(requests.point(fall, x, all));
    const std::size_t touching = requests.motion(scene.problem, scene.end_time);
    return [=](const Subject& subject, const MotionResults& results) -> Figure {
        const auto& [problem, units, lang, end] = subject;
        const sim::Result &falls = *results[fall], &strikes = *results[touching];
        const Trial trial = try_points(falls, searched, where, instants(all), problem);
        Figure figure{.title = kDistanceTitle,
                      .panels = lettered({distance_panel(trial), arrivals_panel(trial, strikes, lang)}),
                      .aspect = 1.25};
        add_caption(figure, {{&problem, &strikes}}, units);
        return figure;
    };
}

std::optional<std::string> needs_tangent(const Scene& scene) {
    if (auto no_cam = needs_cam(scene)) return no_cam;
    if (auto resting = needs_start_off_the_cam(scene)) return resting;
    const sim::Cam& cam = *scene.problem.cam;
    if (cam.profile) return "it is drawn for a disc: leave out cam.profile";
    const double distance = norm(cam.centre);
    if (distance - cam.eccentricity <= cam.radius) return "the cam reaches the hinge, so no tangent to it exists";
    return refusal_of_variants({without_cam(scene.problem)});
}

}  // namespace

extern const FigureType kDistance{"distance", kDistanceTitle, needs_tangent, prepare_distance};

}  // namespace beamcam::scenes
