// The mechanism at several instants, or a still picture of it at one, in lines.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "render/mechanism/cam_outline.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "render/mechanism/mechanism.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/sketch.hpp"

namespace beamcam::scenes {
namespace {

using sim::Vec2;

constexpr int kShownPoses = 9, kPoseStations = 65;
constexpr int kDigits = 6;  // of the instant of a still

// The cam, and the line to its mark from the centre of a disc, or from the axis.
void add_outline(const sim::Pose& pose, const sim::Problem& problem, std::optional<render::Color> fill,
                 render::Color color, double width, Sketch& to, render::Bounds& extent) {
    constexpr int kPoints = 240;
    const double radius = problem.cam->radius;
    Vec2 from = pose.cam_centre, mark;
    if (problem.cam->profile) {
        std::vector<Vec2> outline = render::placed_outline(problem, pose, kPoints);
        mark = outline.front();
        for (const Vec2 p : outline) extent.add(p);
        if (fill) to.add({.kind = Sketch::Kind::area, .points = outline, .color = *fill});
        to.add({.kind = Sketch::Kind::line, .points = std::move(outline), .color = color, .width = width});
    } else {
        from = pose.disc_centre;
        mark = from + radius * sim::unit(pose.cam_angle);
        extent.add(from, radius);
        fill ? to.disc(from, radius, *fill, width) : to.circle(from, radius, color, width);
    }
    to.line(from, mark, color, 0.6);
}

void add_pose(const sim::Pose& pose, const sim::Problem& problem, render::Color color, Sketch& to,
              render::Bounds& extent) {
    for (const Vec2 p : pose.centreline) extent.add(p);
    to.add({.kind = Sketch::Kind::line, .points = pose.centreline, .color = color, .width = 1.6});
    if (problem.cam) add_outline(pose, problem, {}, color, 0.9, to, extent);
}

// One instant: bodies to scale, and the force between them.
void add_bodies(const sim::Pose& pose, const sim::Problem& problem, Sketch& to, render::Bounds& extent) {
    constexpr double kOutline = 0.8;
    constexpr render::Color kSteel = render::rgb(0xE4E6EB);
    if (problem.cam) {
        add_outline(pose, problem, kSteel, Sketch::kInk, kOutline, to, extent);
    }
    const render::DrawnBeam beam = render::drawn_beam(problem, pose, 1, beam_depth(problem.beam));
    std::vector<Vec2> outline;
    for (std::size_t i = 0; i < beam.line.size(); ++i) outline.push_back(beam.face(i));
    for (std::size_t i = beam.line.size(); i-- > 0;) outline.push_back(beam.back(i));
    for (const Vec2 p : outline) extent.add(p);
    to.add({.kind = Sketch::Kind::area, .points = outline, .color = kSteel});
    outline.push_back(outline.front());
    to.add({.kind = Sketch::Kind::line, .points = outline, .color = Sketch::kInk, .width = kOutline});
    const double hub = std::max(std::abs(problem.hub.radius), render::root_radius(problem));
    to.disc({0, 0}, hub, kSteel, kOutline);
    extent.add({0, 0}, hub);
    if (!pose.nearest || !(pose.nearest->force > 0)) return;
    // On the beam, from the disc.
    const Vec2 at = pose.nearest->point, tip = at + 0.2 * problem.beam.length * pose.nearest->normal;
    extent.add(tip);
    to.arrow(at, tip, Sketch::kRed, 1);
    to.add({.kind = Sketch::Kind::label,
            .points = {tip},
            .color = Sketch::kRed,
            .markup = "$F$ = " + render::quantity(pose.nearest->force, "N"),
            .shift = {-0.4, 0.2},
            .align = render::HAlign::right});
}

bool is_level(const Vec2& along) { return std::abs(along.x) > 0.5; }

// Beyond the tip, where no other beam is drawn.
void add_instant(const sim::Pose& pose, std::string instant, Sketch& to) {
    const Vec2 along = sim::unit(pose.theta);
    const bool level = is_level(along);
    using render::VAlign;
    to.add({.kind = Sketch::Kind::label,
            .points = {pose.centreline.back()},
            .color = Sketch::kInk,
            .markup = std::move(instant),
            .shift = along * 0.5,
            .align = !level         ? render::HAlign::centre
                     : along.x >= 0 ? render::HAlign::left
                                    : render::HAlign::right,
            .valign = level         ? VAlign::middle
                      : along.y > 0 ? VAlign::bottom
                                    : VAlign::top});
}

// Writes instants that are equally spaced with the same decimals, exactly if a few are enough, without zeros at the
// end.
class InstantText {
  public:
    explicit InstantText(const std::vector<sim::Pose>& poses) {
        const double step = poses[1].t - poses[0].t;
        const int few = render::decimals_of(step);
        const auto is_exact = [&](const sim::Pose& pose) {
            return std::abs(pose.t - std::round(pose.t * render::ten_to(decimals_)) / render::ten_to(decimals_)) <
                   1e-6 * step;
        };
        while (decimals_ < few + 3 && !std::ranges::all_of(poses, is_exact)) ++decimals_;
        if (!std::ranges::all_of(poses, is_exact)) decimals_ = few + 2;
    }
    std::string operator()(const sim::Pose& pose) const {
        std::string text = render::fixed(pose.t, decimals_);
        if (decimals_ > 0) text.erase(text.find_last_not_of('0') + 1);
        if (text.ends_with('.')) text.pop_back();
        return text + " s";
    }

  private:
    int decimals_ = 0;
};

// First and last, in one label where two would overlap.
void label_instants(const std::vector<sim::Pose>& poses, Sketch& to) {
    if (poses.size() == 1) return add_instant(poses.front(), number(poses.front().t, kDigits) + " s", to);
    const InstantText text_of(poses);
    const sim::Pose &first = poses.front(), &last = poses.back();
    constexpr double kHeight = 0.05, kWidth = 0.15;  // about those of a label; level beams have labels below each other
    const double room = is_level(sim::unit(first.theta)) ? kHeight : kWidth;
    const bool joined = std::abs(std::remainder(last.theta - first.theta, 2 * std::numbers::pi)) <= room;
    add_instant(first, joined ? text_of(first) + ", " + text_of(last) : text_of(first), to);
    if (!joined) add_instant(last, text_of(last), to);
}

Panel strobe_panel(const std::vector<sim::Pose>& poses, const sim::Problem& problem, render::Bounds& extent) {
    Sketch sketch;
    const bool one = poses.size() == 1;
    if (one) add_bodies(poses.front(), problem, sketch, extent);
    for (std::size_t k = 0; k < poses.size() && !one; ++k) {
        const double share = 0.15 + 0.85 * static_cast<double>(k) / static_cast<double>(poses.size() - 1);
        add_pose(poses[k], problem, render::figure::map_color(share), sketch, extent);
    }
    sketch.dot({0, 0}, Sketch::kInk, 2);
    if (problem.hub.radius > 0 && !one) sketch.circle({0, 0}, problem.hub.radius, Sketch::kInk, 0.9);
    if (problem.cam) sketch.dot(problem.cam->centre);
    label_instants(poses, sketch);
    return {.shapes = sketch.take()};
}

// At the instant of a touch the gap is zero but for rounding, and so is the force.
void drop_rounding(sim::Pose& pose, const sim::Problem& problem, const sim::Result& result) {
    constexpr double kForceRounding = 1e-9;  // of the largest force, which is at least the weight
    double largest = problem.beam.line_density() * problem.beam.length * std::abs(problem.gravity);
    for (const sim::Impact& impact : result.impacts) largest = std::max(largest, impact.force_peak.value_or(0));
    if (pose.nearest && pose.nearest->force < kForceRounding * largest) pose.nearest->force = 0;
}

FigureDrawing prepare_strobe(const Scene& scene, const FigureOutput& how, MotionRequests& requests) {
    const bool one = how.series.to && *how.series.to == how.series.from;
    const ShownPoses shown = request_poses(scene, how, one ? 2 : kShownPoses, kPoseStations, requests);
    const auto draw = [=](const Subject& subject, const sim::Result& result) -> Figure {
        std::vector<sim::Pose> poses = result.poses[shown.poses];
        if (one) poses.resize(1);
        for (sim::Pose& pose : poses) drop_rounding(pose, subject.problem, result);
        render::Bounds extent;
        Panel panel = strobe_panel(poses, subject.problem, extent);
        // The shapes with a margin and room for labels.
        const double aspect =
            std::clamp(0.1 + 0.85 * (extent.y1 - extent.y0) / std::max(extent.x1 - extent.x0, 1e-12), 0.3, 1.1);
        return {
            .title = one ? fmt::format("The mechanism at {} s, deflection to scale", number(shown.from, kDigits)) : "",
            .panels = {std::move(panel)},
            .aspect = aspect};
    };
    return figure_of_motion(shown.motion, draw);
}

}  // namespace

extern const FigureType kStrobe{
    .name = "strobe",
    .title = "The mechanism at equally spaced instants, from pale to dark, deflection to scale",
    .refusal = no_refusal,
    .maker = prepare_strobe,
    .keys = {"from", "to", "at"}};

}  // namespace beamcam::scenes
