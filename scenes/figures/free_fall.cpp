// Falling without a cam: the hub angle of the flexible and the rigid beam.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "sim/studies/paper.hpp"

namespace beamcam::scenes {
namespace {

constexpr const char* kFallTitle = "Hub angle without the cam";
constexpr int kFallPoints = 2001;  // points: a column of print has fewer dots
constexpr double kAround = 12e-6;  // half of the enlarged interval about the rigid crossing [s]

// The time that the close-up enlarges: only the hinged rod released at rest has a closed form for it.
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
    std::optional<std::size_t> close = {};  // in close-up

    std::optional<double> zero(const MotionResults& results) const {
        const std::vector<sim::ZeroCrossing>& all = results[motion]->theta_zero;
        return all.empty() ? std::nullopt : std::optional(all.front().t);
    }
    Series curve(const MotionResults& results, std::size_t of, std::string name) const {
        const sim::Table& t = results[motion]->tables[of];
        return {
            .label = std::move(name), .x = column(t, ChannelKind::t), .y = column(t, ChannelKind::theta), .look = look};
    }
};

// The beams: the scene's own if it bends, the rigid one, and in the paper's fall the rod that takes its 0.262 s.
struct Falls {
    std::vector<Fall> shown;
    bool flexible = false, paper = false;
    std::optional<double> closely;  // when the rigid beam is level, if the close-up shows it [s]

    const Fall& rigid() const { return shown[flexible ? 1 : 0]; }
    void mark_zero(const Fall& fall, const MotionResults& results, bool hollow, Panel& panel) const {
        if (const auto zero = fall.zero(results))
            panel.marks.push_back({.x = *zero, .y = 0, .look = fall.look, .hollow = hollow});
    }
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
    if (out.flexible && exact && *exact + kAround < end) out.closely = exact;
    if (out.flexible) out.shown.push_back({"flexible", 0, own});
    out.shown.push_back({"rigid", 1, stiff});
    if (out.paper) out.shown.push_back({"rigid, factor 2", 2, doubled});
    for (Fall& fall : out.shown) {
        fall.motion = requests.motion(fall.problem, end);
        requests.zero_crossings(fall.motion);
        fall.table = requests.table(fall.motion, {0, end, kFallPoints}, {ChannelKind::t, ChannelKind::theta});
        if (out.closely && fall.look < 2)
            fall.close = requests.table(fall.motion, {*out.closely - kAround, *out.closely + kAround, 241},
                                        {ChannelKind::t, ChannelKind::theta});
    }
    return out;
}

// Microseconds about the closed form, microradians about zero, if both beams cross there.
std::optional<Panel> close_up(const Falls& falls, const MotionResults& results) {
    const double exact = *falls.closely;
    Panel panel{.x = {.label = fmt::format("($t$ − {} s) / µs", grouped(exact, 6)), .tight = true},
                .y = {.label = "$θ$ / µrad"},
                .rules = {{.at = 0}},
                .legend = false};
    for (const Fall& fall : falls.shown) {
        if (!fall.close) continue;
        const std::optional<double> zero = fall.zero(results);
        if (!zero || std::abs(*zero - exact) > 0.8 * kAround) return std::nullopt;
        Series s = fall.curve(results, *fall.close, "");
        for (double& t : s.x) t = (t - exact) * 1e6;
        s.y = scaled(s.y, 1e6);
        s.solid = fall.look == 0;
        panel.series.push_back(std::move(s));
        panel.marks.push_back({.x = (*zero - exact) * 1e6, .y = 0, .look = fall.look});
    }
    constexpr double kDistinct = 0.2;  // [µs]: closer crossings coincide in the close-up
    if (std::abs(panel.marks.front().x - panel.marks.back().x) < kDistinct) return std::nullopt;
    return panel;
}

Panel fall_panel(const Falls& falls, const MotionResults& results, const Subject& subject) {
    const Measure angle = measure_in(subject.units, "rad");
    Panel panel{
        .x = {.label = "$t$ / s", .tight = true}, .y = {.label = axis_label("$θ$", angle.unit)}, .rules = {{.at = 0}}};
    for (const Fall& fall : falls.shown) {
        panel.series.push_back(fall.curve(results, fall.table, phrase(subject.lang, fall.label)));
        panel.series.back().y = scaled(std::move(panel.series.back().y), angle.factor);
    }
    panel.series.front().solid = true;
    if (falls.paper) falls.mark_zero(falls.shown.back(), results, false, panel);
    if (falls.flexible) falls.mark_zero(falls.shown.front(), results, false, panel);
    falls.mark_zero(falls.rigid(), results, falls.flexible, panel);
    return panel;
}

FigureDrawing prepare_fall(const Scene& scene, const FigureOutput&, MotionRequests& requests) {
    return [falls = falls_of(scene, requests)](const Subject& subject, const MotionResults& results) -> Figure {
        std::vector<Panel> panels{fall_panel(falls, results, subject)};
        if (auto closer = falls.closely ? close_up(falls, results) : std::nullopt) panels.push_back(std::move(*closer));
        const double aspect = panels.size() > 1 ? 1.25 : 0.74;
        Figure figure{.title = kFallTitle, .panels = lettered(std::move(panels)), .aspect = aspect};
        Runs runs;
        for (const Fall& fall : falls.shown) {
            runs.emplace_back(&fall.problem, results[fall.motion]);
            if (const auto zero = fall.zero(results))
                figure.title += fmt::format("; {}: zero after {} s", fall.label, grouped(*zero, 6));
        }
        if (falls.paper) figure.title += "; factor 2: between torque and inertia";
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
