#include "render/film/sight.hpp"

#include <algorithm>

#include "render/film/panel.hpp"
#include "render/mechanism/mechanism.hpp"

namespace beamcam::render {
namespace {

double margin(const Box& box, double unit) { return std::min(26 * unit, 0.08 * std::min(box.w, box.h)); }

}  // namespace

bool shows_force(const sim::Pose& pose, const DrawnBeam& beam) {
    return pose.nearest && pose.nearest->touching && pose.nearest->force > 0 && beam.contact;
}

bool is_small(const Box& box, double u) { return box.w < 420 * u || box.h < 300 * u; }

double push_length(double share, bool small, double u) { return (small ? 60 : 150) * u * share; }

double push_label(double length, double depth, double u) { return std::max(length, depth + 26 * u); }

// [m], with what is fixed in pixels at this scale [px/m]; 0: without.
Bounds Sight::shown(double scale, double u, bool small) const {
    Bounds all = beams;
    const double pixel = scale > 0 ? 1 / scale : 0;  // [m]
    double marks = 0;
    for (const sim::Problem* p : problems) {
        if (p->cam) {
            const double swept = p->cam->radius + p->cam->eccentricity;
            all.add(p->cam->centre, swept + (p->cam->speed != 0 && !small ? 34 * u * pixel : 0));
        }
        const double hub = scale > 0 ? hub_radius(*p, {scale, {}}, u) : 0;  // [px]
        const double own = mark_unit(*p, {scale, {}}, u);
        all.add({0, 0}, std::max(hub * pixel, p->hub.radius) + 12 * own * pixel);
        all.add({0, -support_reach(hub, own) * pixel});
        marks = std::max(marks, own);
    }
    if (!(scale > 0)) return all;
    for (const Push& push : pushes) {
        const double length = push_length(push.share, small, marks);
        all.add(push.foot + push.normal * (length * pixel), 4 * u * pixel);
        if (!small)
            all.add(push.foot + push.normal * (push_label(length, push.depth * scale, u) * pixel), 12 * u * pixel);
    }
    return all;
}

Camera Sight::camera(const Box& box, double u) const {
    const Box room = box.inset(margin(box, u));
    if (problems.empty()) return fit({0, 0, 1, 1}, room);
    Camera camera{0, {}};
    for (int pass = 0; pass < 4; ++pass)
        camera = fit(shown(camera.scale, u, is_small(box, u)), room);  // it settles at once
    return camera;
}

Vec2 Sight::room(const Box& box, double u) const {
    const double scale = camera(box, u).scale, around = 2 * margin(box, u);
    const Bounds all = problems.empty() ? Bounds{0, 0, 1, 1} : shown(scale, u, is_small(box, u));
    return {(all.x1 - all.x0) * scale + around, (all.y1 - all.y0) * scale + around};
}

Sight sight_of(const FilmFacts& facts, double least_depth) {
    Sight sight;
    const FilmSetup& setup = *facts.setup;
    const bool still = facts.frames() == 1, ghosts = facts.members() > 1 && setup.comparison == Comparison::ghosts;
    for (int m = 0; m < facts.members(); ++m) {
        const Motion& one = facts.motion(m);
        sight.problems.push_back(&one.problem);
        // Ghosts are drawn as deep as the first.
        const double depth = std::max((ghosts ? facts.motion(0) : one).problem.beam.depth, least_depth);
        const double factor = one.problem.beam.model == sim::ModelKind::rigid ? 1 : facts.factor;
        const auto show = [&](const sim::Pose& pose, bool tip_only) {
            const DrawnBeam beam = drawn_beam(one.problem, pose, factor, depth, facts.with(m));
            if (tip_only) return sight.beams.add(beam.line.back());
            std::vector<Vec2>& strip = sight.strips.emplace_back();
            for (std::size_t i = 0; i < beam.line.size(); i += (i + 5 < beam.line.size() ? 4 : 1))
                for (Vec2 p : {beam.face(i), beam.back(i)}) sight.beams.add(p), strip.push_back(p);
            if ((m == 0 || !ghosts) && shows_force(pose, beam))
                sight.pushes.push_back({beam.contact->on_disc, beam.contact->normal,
                                        std::min(1.0, pose.nearest->force / facts.arrow_scale), depth});
        };
        for (std::size_t k = 0; k < (still || one.exposures > 1 ? one.exposures : 0); ++k) show(one.pose(0, k), false);
        for (std::size_t k = 0; k < one.surveyed(); ++k) {
            if (still && !setup.view.tip_path) break;
            if (const sim::Pose pose = one.surveyed(k); !still || pose.t <= facts.at(m, 0)) show(pose, still);
        }
    }
    const sim::Problem& first = facts.motion(0).problem;
    for (std::size_t k = 0; k < setup.data.size(); ++k)
        for (const double t : setup.data[k].t)
            if (const double angle = facts.measured_angle(k, t);
                t >= facts.at(0, 0) && t <= facts.at(0, facts.frames() - 1) && !std::isnan(angle))
                sight.beams.add(sim::unit(angle) * (first.hub.radius + first.beam.length));
    return sight;
}

}  // namespace beamcam::render
