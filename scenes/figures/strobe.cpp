// The beam at several instants and the cam at both ends, in lines.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/mechanism/cam_outline.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "render/mechanism/mechanism.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/sketch.hpp"

namespace beamcam::scenes {
namespace {

using sim::Vec2;

constexpr int kShownPoses = 6, kPoseStations = 65;
constexpr const char* kStrobeTitle = "The beam at equally spaced instants, from pale to dark";

// The cam, and the line to its mark from the centre of a disc, or from the axis.
void add_cam(const sim::Pose& pose, const sim::Problem& problem, render::Color color, Sketch& to,
             render::Bounds& extent) {
    constexpr int kPoints = 240;
    constexpr double kWidth = 0.9;  // [pt]
    Vec2 from = pose.cam_centre, mark;
    if (problem.cam->profile) {
        std::vector<Vec2> outline = render::placed_outline(problem, pose, kPoints);
        mark = outline.front();
        for (const Vec2 p : outline) extent.add(p);
        to.add({.kind = Sketch::Kind::line, .points = std::move(outline), .color = color, .width = kWidth});
    } else {
        from = pose.disc_centre;
        mark = from + problem.cam->radius * sim::unit(pose.cam_angle);
        extent.add(from, problem.cam->radius);
        to.circle(from, problem.cam->radius, color, kWidth);
    }
    to.line(from, mark, color, 0.6);
}

void add_beam(const sim::Pose& pose, render::Color color, Sketch& to, render::Bounds& extent) {
    for (const Vec2 p : pose.centreline) extent.add(p);
    to.add({.kind = Sketch::Kind::line, .points = pose.centreline, .color = color, .width = 1.6});
}

// The speed of the tip at the last instant as a share of the largest shown, unless the beam rests.
void add_speed(const std::vector<sim::Pose>& poses, Sketch& to, render::Bounds& extent) {
    constexpr double kLongest = 0.15, kRest = 0.05;  // in lengths of the beam; of the largest speed
    double fastest = 0;
    for (const sim::Pose& pose : poses) fastest = std::max(fastest, std::abs(pose.theta_dot));
    const sim::Pose& last = poses.back();
    if (std::abs(last.theta_dot) <= kRest * fastest) return;
    const Vec2 tip = last.centreline.back(),
               way = kLongest * norm(tip) * last.theta_dot / fastest * sim::perp(sim::unit(last.theta));
    to.arrow(tip, tip + way, Sketch::kInk, 0.9);
    extent.add(tip + way);
}

// The instants beyond the tips, together those of beams that are close to each other.
void label_instants(const std::vector<sim::Pose>& poses, Sketch& to) {
    constexpr double kWide = 0.3, kHigh = 0.06;  // of a label, in lengths of the beam
    std::vector<std::vector<const sim::Pose*>> labels;
    for (const sim::Pose& pose : poses) {
        const Vec2 tip = pose.centreline.back();
        const auto at = std::ranges::find_if(labels, [&](const auto& label) {
            const Vec2 away = tip - label.front()->centreline.back();
            return std::abs(away.x) < kWide * norm(tip) && std::abs(away.y) < kHigh * norm(tip);
        });
        (at == labels.end() ? labels.emplace_back() : *at).push_back(&pose);
    }
    const int decimals = render::decimals_of(poses[1].t - poses[0].t) + 1;
    for (const auto& label : labels) {
        const Vec2 tip = label.front()->centreline.back(), along = sim::unit(label.front()->theta);
        std::vector<std::string> instants;
        for (const sim::Pose* pose : label) instants.push_back(render::fixed(pose->t, decimals));
        const bool successive = instants.size() > 2 && label.front() + instants.size() - 1 == label.back();
        if (successive) instants = {instants.front() + " … " + instants.back()};
        to.add({.kind = Sketch::Kind::label,
                .points = {tip + 0.04 * norm(tip) * along},
                .markup = fmt::format("{} s", fmt::join(instants, ", ")),
                .align = along.x < 0 ? render::HAlign::right : render::HAlign::left});
    }
}

// Below the drawing, the direction of gravity, and a length of 1, 2 or 5 times a power of ten, about a fifth of the
// beam's.
void add_scale(const sim::Problem& problem, render::Bounds& extent, Sketch& to) {
    const double length = render::round_down_125(problem.beam.length / 5);
    const double y = extent.y0 - 0.14 * problem.beam.length, tick = 0.012 * problem.beam.length;
    Vec2 a{extent.x0, y};
    extent.add(a);
    if (problem.gravity != 0) {
        const Vec2 down{0, std::copysign(0.06 * problem.beam.length, -problem.gravity)};
        to.arrow(a - down, a + down, Sketch::kInk, 0.9);
        to.label(a, "$g$", {0.8, 0});
        a.x += 0.12 * problem.beam.length;
    }
    const Vec2 b = a + Vec2{length, 0};
    to.line(a, b, Sketch::kInk, 0.8);
    for (const Vec2 end : {a, b}) to.line(end - Vec2{0, tick}, end + Vec2{0, tick}, Sketch::kInk, 0.8);
    to.add({.kind = Sketch::Kind::label,
            .points = {b},
            .markup = render::quantity(length, "m"),
            .shift = {0.4, 0},
            .align = render::HAlign::left});
}

Panel strobe_panel(const std::vector<sim::Pose>& poses, const sim::Problem& problem, render::Bounds& extent) {
    Sketch sketch;
    const double hub = std::abs(problem.hub.radius);
    for (std::size_t k = 0; k < poses.size(); ++k) {
        const double share = 0.15 + 0.85 * static_cast<double>(k) / static_cast<double>(poses.size() - 1);
        const render::Color color = render::figure::map_color(share);
        add_beam(poses[k], color, sketch, extent);
        if (problem.cam && (k == 0 || k + 1 == poses.size())) add_cam(poses[k], problem, color, sketch, extent);
    }
    extent.add({0, 0}, hub);
    if (problem.cam && problem.cam->speed != 0) {
        const double radius = 1.15 * render::cam_reach(problem);
        sketch.rotation(problem.cam->centre, radius, -0.5 * std::numbers::pi, problem.cam->speed);
        extent.add(problem.cam->centre, radius);
    }
    add_speed(poses, sketch, extent);
    sketch.disc({0, 0}, hub, Sketch::kSteel, 0.8);
    sketch.dot({0, 0}, Sketch::kInk, 1.2);
    if (problem.cam) sketch.dot(problem.cam->centre);
    label_instants(poses, sketch);
    add_scale(problem, extent, sketch);
    return {.shapes = sketch.take()};
}

FigureDrawing prepare_strobe(const Scene& scene, const FigureOutput& how, MotionRequests& requests) {
    const ShownPoses shown = request_poses(scene, how, kShownPoses, kPoseStations, requests);
    // The speed at the last instant is that before an impulse.
    requests.request(shown.motion).poses[shown.poses].times.back() *= 1 - 1e-9;
    const auto draw = [=](const Subject& subject, const sim::Result& result) -> Figure {
        render::Bounds extent;
        Panel panel = strobe_panel(result.poses[shown.poses], subject.problem, extent);
        // The shapes with a margin and room for labels.
        const double aspect =
            std::clamp(0.1 + 0.85 * (extent.y1 - extent.y0) / std::max(extent.x1 - extent.x0, 1e-12), 0.3, 1.1);
        return {.title = fmt::format("{}{}; deflection to scale; the arrow at a tip is its speed at the last instant, "
                                     "relative to its largest at these instants",
                                     kStrobeTitle, subject.problem.cam ? ", and the cam at both ends" : ""),
                .panels = {std::move(panel)},
                .aspect = aspect};
    };
    return figure_of_motion(shown.motion, draw);
}

}  // namespace

extern const FigureType kStrobe{.name = "strobe",
                                .title = kStrobeTitle,
                                .refusal = no_refusal,
                                .maker = prepare_strobe,
                                .keys = {"from", "to"},
                                .ends = Instant{.kind = Instant::Kind::impact}};

}  // namespace beamcam::scenes
