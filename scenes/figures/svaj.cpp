// Displacement, velocity, acceleration and jerk of the straight lever that follows the cam, over a turn of the cam;
// over the first two those of the beam's hub in the last whole turn of the scene, if it is slow. MODEL.md (S106).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "sim/cam/lever.hpp"

namespace beamcam::scenes {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kTurnRows = 2001;  // of the beam's motion
constexpr double kSlow = 3;  // speeds of the lever: a faster hub, which rings or flies, would hide the lever's curve
constexpr const char* kLeverTitle = "The straight lever's angle on the cam and its derivatives by the turn of the cam";

// States over a turn from φ = 0. Where a derivative jumps there are two at the same turn.
std::vector<sim::Lever::State> turn_of(const sim::Lever& lever) {
    constexpr int kSamples = 24;       // between the ends of smooth intervals
    constexpr double kInside = 1e-12;  // of an interval: its last sample does not belong to the next one
    const double start = lever.at(0).alpha;
    std::vector<double> ends{start, start + sim::kFullTurn};
    for (const double end : lever.shape().intervals()) {
        const double later = end + sim::kFullTurn * std::ceil((start - end) / sim::kFullTurn);
        if (later > start && later < ends[1]) ends.push_back(later);
    }
    std::ranges::sort(ends);
    std::vector<sim::Lever::State> states;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        for (int k = 0; k <= kSamples; ++k)
            states.push_back(lever.at_normal(ends[i] + (ends[i + 1] - ends[i]) * (1 - kInside) * k / kSamples));
    return states;
}

// The times between which the cam makes the last whole turn from φ = 0 of the scene; nothing if it makes none.
std::optional<std::pair<double, double>> last_turn(const Scene& scene) {
    const sim::Cam& cam = *scene.problem.cam;
    if (cam.speed == 0) return std::nullopt;
    const double period = cam_period(scene.problem), begun = -cam.phase / sim::kFullTurn * (cam.speed > 0 ? 1 : -1);
    const double turns = std::floor(scene.end_time / period + begun + 1e-9), end = (turns - begun) * period;
    if (end - period < -1e-9 * period) return std::nullopt;
    return std::pair{std::max(0.0, end - period), std::min(end, scene.end_time)};
}

// The beam's curves over the turn from 0° to 360°.
void add_beam(const sim::Problem& problem, const sim::Table& table, double angle_factor, Lang lang, Panel& angle,
              Panel& velocity) {
    const bool bends = problem.beam.model != sim::ModelKind::rigid;
    Series theta{.label = phrase(lang, bends ? "hub of the bent beam" : "beam"), .look = 1, .weight = 0.8},
        rate = theta;
    const auto &psi = column(table, ChannelKind::cam_angle), &at = column(table, ChannelKind::theta),
               &speed = column(table, ChannelKind::theta_dot);
    const double turn = std::round(-std::max(psi.front(), psi.back()) / sim::kFullTurn);
    for (std::size_t i = 0; i < psi.size(); ++i) {
        const double phi = (-psi[i] / sim::kFullTurn - turn) * 360;
        theta.add(phi, at[i] * angle_factor);
        rate.add(phi, speed[i] / problem.cam->speed);
    }
    angle.series.push_back(std::move(theta));
    if (largest_magnitude(rate.y) < kSlow * largest_magnitude(velocity.series.front().y))
        velocity.series.push_back(std::move(rate));
}

Figure svaj_figure(const Subject& subject, const sim::Result* result, std::size_t table) {
    const auto& [problem, units, lang, end] = subject;
    const Measure angle = measure_in(units, "rad");
    const std::pair<std::string, double sim::LeverMotion::*> quantities[] = {
        {axis_label("$θ$", angle.unit), &sim::LeverMotion::theta},
        {"d$θ$/d$φ$", &sim::LeverMotion::velocity},
        {"d^{2}$θ$/d$φ$^{2}", &sim::LeverMotion::acceleration},
        {"d^{3}$θ$/d$φ$^{3}", &sim::LeverMotion::jerk}};
    const char* names[] = {"displacement", "velocity", "acceleration", "jerk"};
    std::vector<Panel> panels;
    const std::vector<sim::Lever::State> states = turn_of(sim::Lever(problem));
    for (const auto& [label, quantity] : quantities) {
        Series curve{.label = phrase(lang, "straight lever"), .name = names[panels.size()]};
        const double factor = panels.empty() ? angle.factor : 1;
        for (const sim::Lever::State& s : states) curve.add(s.phi * kDegrees, s.motion.*quantity * factor);
        panels.push_back({.title = phrase(lang, names[panels.size()]),
                          .x = {.label = "$φ$ / °", .from = 0, .to = 360, .tight = true},
                          .y = {.label = label},
                          .series = {std::move(curve)},
                          .legend = result && panels.empty(),
                          .name = names[panels.size()]});
        if (panels.size() > 1) panels.back().rules = {{.at = 0}};
    }
    if (result) add_beam(problem, result->tables[table], angle.factor, lang, panels[0], panels[1]);
    Figure figure{
        .title = kLeverTitle, .panels = lettered(std::move(panels)), .stack = true, .share_x = true, .aspect = 1.7};
    if (result) figure.title += "; dashed: the hub of the beam in the last whole turn";
    if (result)
        add_caption(figure, {{&problem, result}}, units);
    else
        add_caption(figure, std::vector{problem}, units);
    return figure;
}

FigureDrawing prepare_svaj(const Scene& scene, const FigureOutput&, MotionRequests& requests) {
    const sim::Problem& problem = scene.problem;
    const auto turn = last_turn(scene);
    if (!turn) return [](const Subject& subject, const MotionResults&) { return svaj_figure(subject, nullptr, 0); };
    const std::size_t motion = requests.motion(problem, scene.end_time);
    const std::size_t table =
        requests.curve(motion, {turn->first, turn->second, kTurnRows}, {}, sim::Channel{ChannelKind::theta},
                       {sim::Channel{ChannelKind::theta_dot}, sim::Channel{ChannelKind::cam_angle}});
    return [motion, table](const Subject& subject, const MotionResults& results) {
        return svaj_figure(subject, results[motion], table);
    };
}

std::optional<std::string> needs_lever(const Scene& scene) {
    if (auto why = needs_cam(scene)) return why;
    if (std::isfinite(sim::Lever(scene.problem).summary().rho_min_phi)) return std::nullopt;
    return "no straight lever from the hub's axis can follow a cam so near to it; move the cam away or reduce "
           "contact.offset";
}

}  // namespace

extern const FigureType kSvaj{"svaj", kLeverTitle, needs_lever, prepare_svaj};

}  // namespace beamcam::scenes
