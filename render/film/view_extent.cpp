#include "render/film/view_extent.hpp"

#include <algorithm>
#include <cmath>

#include "render/film/panel.hpp"
#include "render/mechanism/cam_outline.hpp"
#include "render/mechanism/mechanism.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::render {
namespace {

double margin(const Box& box, double unit) { return std::min(26 * unit, 0.08 * std::min(box.w, box.h)); }

}  // namespace

bool shows_force(const sim::Pose& pose, const DrawnBeam& beam) {
    return pose.nearest && pose.nearest->touching && pose.nearest->force > 0 && beam.contact;
}

bool is_small(const Box& box, double u) { return box.w < 420 * u || box.h < 300 * u; }

bool has_names(const Box& box, double u) { return box.w >= 110 * u; }

double least_arc(double hub, double marks) { return hub + 22 * marks; }

double force_arrow_length(double share, bool small, double u) { return (small ? 60 : 150) * u * share; }

double force_label_distance(double length, double depth, double u) { return std::max(length, depth + 10 * u) + 18 * u; }

// [m], with the parts that have sizes in pixels at this scale [px/m]; scale 0: without them.
Bounds ViewExtent::shown(double scale, double u, bool small) const {
    Bounds all = beams;
    const double pixel = scale > 0 ? 1 / scale : 0;  // [m]
    double marks = 0;
    for (const sim::Problem* p : problems) {
        if (p->cam) {
            const double swept = cam_reach(*p);
            all.add(p->cam->centre, swept + (p->cam->speed != 0 && !small ? 34 * u * pixel : 0));
        }
        const double hub = scale > 0 ? hub_radius(*p, {scale, {}}, u) : 0;  // [px]
        const double own = mark_unit(*p, {scale, {}}, u);
        const double around = turned && !small ? least_arc(hub, own) + 40 * u - hub : 12 * own;
        const bool driven = !std::holds_alternative<sim::FreeDrive>(p->hub.drive) && !sim::is_prescribed(p->hub.drive);
        const double arrow = driven && !small ? torque_arrow_distance(u) + 34 * u : 0;
        all.add({0, 0}, std::max(hub * pixel, p->hub.radius) + std::max(around, arrow) * pixel);
        if (scale > 0) all.add({0, -floor_depth(*p, {scale, {}}, u) * pixel});
        marks = std::max(marks, own);
    }
    if (!(scale > 0)) return all;
    for (const ForceArrow& arrow : arrows) {
        const double length = force_arrow_length(arrow.share, small, marks);
        all.add(arrow.foot + arrow.normal * (length * pixel), 4 * u * pixel);
        if (!small)
            all.add(arrow.foot + arrow.normal * (force_label_distance(length, arrow.depth * scale, u) * pixel),
                    12 * u * pixel);
    }
    return all;
}

Camera ViewExtent::camera(const Box& box, double u) const {
    const Box room = box.inset(margin(box, u));
    if (problems.empty()) return fit({0, 0, 1, 1}, room);
    Camera camera{0, {}};
    for (int pass = 0; pass < 4; ++pass)
        camera = fit(shown(camera.scale, u, is_small(box, u)), room);  // converges quickly
    return camera;
}

ViewExtent view_extent_of(const FilmContext& context, double least_depth) {
    ViewExtent extent;
    const FilmSetup& setup = *context.setup;
    const bool ghosts = context.members() > 1 && setup.comparison == Comparison::ghosts;
    for (int m = 0; m < context.members(); ++m) {
        const Motion& one = context.motion(m);
        extent.problems.push_back(&one.problem);
        // Ghosts have the depth of the first beam.
        const double depth = std::max(beam_depth((ghosts ? context.motion(0) : one).problem.beam), least_depth);
        const double factor = one.problem.beam.model == sim::ModelKind::rigid ? 1 : context.scales.exaggeration;
        const auto show = [&](const sim::Pose& pose) {
            const DrawnBeam beam = drawn_beam(one.problem, pose, factor, depth, context.section_reference(m));
            std::vector<Vec2>& strip = extent.strips.emplace_back();
            for (std::size_t i = 0; i < beam.line.size(); i += (i + 5 < beam.line.size() ? 4 : 1))
                for (Vec2 p : {beam.face(i), beam.back(i)}) extent.beams.add(p), strip.push_back(p);
            extent.turned = extent.turned || std::abs(std::fmod(pose.theta, sim::kFullTurn)) > sim::kFullTurn / 4;
            if ((m == 0 || !ghosts) && shows_force(pose, beam))
                extent.arrows.push_back({beam.contact->on_disc, beam.contact->normal,
                                         std::min(1.0, pose.nearest->force / context.scales.arrow_force), depth});
        };
        for (std::size_t k = 0; k < one.surveyed(); ++k) show(one.surveyed(k));
    }
    const sim::Problem& first = context.motion(0).problem;
    for (std::size_t k = 0; k < setup.data.size(); ++k)
        for (const double t : setup.data[k].t)
            if (const double angle = context.measured_angle(k, t);
                t >= context.clock.at(0) && t <= context.clock.at(context.frames() - 1) && !std::isnan(angle))
                extent.beams.add(sim::unit(angle) * (first.hub.radius + first.beam.length));
    return extent;
}

}  // namespace beamcam::render
