// Falling without a cam: the hub angle of the flexible and the rigid beam.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "sim/studies/paper.hpp"

namespace beamcam::scenes {
namespace {

constexpr const char* kFallTitle = "Hub angle without the cam";
constexpr int kFallPoints = 2001;  // points: a column of print has fewer dots

// When the rigid beam is level: only the hinged rod released at rest has a closed form for it.
std::optional<double> closed_form(const sim::Problem& p) {
    const bool plain = std::holds_alternative<sim::FreeDrive>(p.hub.drive) && p.hub.radius == 0 && p.hub.inertia == 0 &&
                       p.initial.angular_velocity == 0 && p.initial.shape == sim::InitialShape::straight &&
                       p.initial.angle > 0 && p.initial.angle < 1.57 && p.gravity > 0;
    if (!plain) return std::nullopt;
    return sim::rod_fall_time(p.beam.length, p.gravity, p.initial.angle, 1);
}

// A beam of the figure, with its motion and its tables of θ.
struct Fall {
    const char* label = "";
    int look = 0;
    sim::Problem problem = {};
    std::size_t motion = 0, table = 0;

    std::optional<double> zero(const MotionResults& results) const {
        const std::vector<sim::ZeroCrossing>& all = results[motion]->theta_zero;
        return all.empty() ? std::nullopt : std::optional(all.front().t);
    }
    Series curve(const MotionResults& results, double factor) const {
        const sim::Table& t = results[motion]->tables[table];
        return {.x = column(t, ChannelKind::t), .y = scaled(column(t, ChannelKind::theta), factor), .look = look};
    }
};

// The beams: the scene's own if it bends, the rigid one, and in the paper's fall the rod that takes its 0.262 s.
struct Falls {
    std::vector<Fall> shown;
    bool flexible = false, paper = false;
};

Falls falls_of(const Scene& scene, MotionRequests& requests) {
    Falls out;
    const sim::Problem own = without_cam(scene.problem), stiff = rigid(own);
    sim::Problem doubled = stiff;
    doubled.gravity *= 2;
    out.flexible = own.beam.model != sim::ModelKind::rigid;
    const std::optional<double> exact = closed_form(own);
    // Of a long scene the swings that follow are left out.
    const double end = exact ? std::min(scene.end_time, 2 * *exact) : scene.end_time;
    out.paper = exact && is_of_the_paper(scene.problem) && *exact < end;
    if (out.flexible) out.shown.push_back({"flexible", 0, own});
    out.shown.push_back({"rigid", 1, stiff});
    if (out.paper) out.shown.push_back({"rigid, factor 2", 2, doubled});
    for (Fall& fall : out.shown) {
        fall.motion = requests.motion(fall.problem, end);
        requests.zero_crossings(fall.motion);
        fall.table = requests.table(fall.motion, {0, end, kFallPoints}, {ChannelKind::t, ChannelKind::theta});
    }
    return out;
}

Panel fall_panel(const Falls& falls, const MotionResults& results, const Subject& subject) {
    const Measure angle = measure_in(subject.units, "rad");
    Panel panel{
        .x = {.label = "$t$ / s", .tight = true}, .y = {.label = axis_label("$θ$", angle.unit)}, .rules = {{.at = 0}}};
    for (const Fall& fall : falls.shown) {
        Series& curve = panel.series.emplace_back(fall.curve(results, angle.factor));
        curve.label = phrase(subject.lang, fall.label);
        // The zeros of both beams are nearer than a mark is wide.
        if (const auto zero = fall.zero(results); zero && !(falls.flexible && fall.look == 1))
            panel.marks.push_back({.x = *zero, .y = 0, .look = fall.look});
    }
    panel.series.front().solid = true;
    return panel;
}

// How far the flexible beam is from the rigid one.
Panel difference_panel(const Falls& falls, const MotionResults& results, const Subject& subject) {
    const Measure angle = measure_in(subject.units, "rad");
    Series difference = falls.shown[0].curve(results, angle.factor);
    const Series stiff = falls.shown[1].curve(results, angle.factor);
    for (std::size_t i = 0; i < stiff.y.size(); ++i) difference.y[i] -= stiff.y[i];
    return {.caption = "the flexible beam's angle minus the rigid one's",
            .x = {.label = "$t$ / s", .tight = true},
            .y = {.label = axis_label("Δ$θ$", angle.unit)},
            .series = {std::move(difference)},
            .rules = {{.at = 0}}};
}

FigureDrawing prepare_fall(const Scene& scene, const FigureOutput&, MotionRequests& requests) {
    return [falls = falls_of(scene, requests)](const Subject& subject, const MotionResults& results) -> Figure {
        std::vector<Panel> panels{fall_panel(falls, results, subject)};
        if (falls.flexible) panels.push_back(difference_panel(falls, results, subject));
        const double aspect = panels.size() > 1 ? 1.25 : 0.74;
        Figure figure{.title = kFallTitle, .panels = lettered(std::move(panels)), .share_x = true, .aspect = aspect};
        Runs runs;
        std::vector<std::string> notes;
        for (const Fall& fall : falls.shown) {
            runs.emplace_back(&fall.problem, results[fall.motion]);
            if (const auto zero = fall.zero(results))
                notes.push_back(fmt::format("{}: zero after {} s", fall.label, grouped(*zero, 6)));
        }
        if (falls.paper)
            notes.push_back("factor 2: twice the torque of gravity on the same inertia, which gives the paper's time");
        const std::string told = fmt::format("{}", fmt::join(notes, "; "));
        if (figure.panels.size() > 1)
            figure.panels.front().caption = told;
        else if (!told.empty())
            figure.title += "; " + told;
        add_caption(figure, runs, subject.units);
        return figure;
    };
}

std::optional<std::string> needs_fall(const Scene& scene) {
    if (auto why = needs_free_hub(scene)) return why;
    if (auto why = needs_start_off_the_cam(scene)) return why;
    const sim::Problem falling = without_cam(scene.problem);
    return refusal_of_variants({falling, rigid(falling)});
}

}  // namespace

extern const FigureType kFreeFall{"free-fall", kFallTitle, needs_fall, prepare_fall};

}  // namespace beamcam::scenes
