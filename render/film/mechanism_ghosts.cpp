// Other motions in the panel of the first one, and beams at measured angles.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "render/film/mechanism_marks.hpp"
#include "render/mechanism/cam_outline.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;

struct Outline {
    std::vector<Vec2> edge, foot;  // [px]
};

// `edge`: along the face and back, from where the beam leaves the hub; `foot`: along the hub, which is in front.
Outline ghost_outline(const MechanismScene& s, const DrawnBeam& beam) {
    const auto outside = [&](const auto& point) {
        std::vector<Vec2> line;
        for (std::size_t i = 0; i < beam.line.size(); ++i) {
            const Vec2 p = s.at.px(point(i));
            if (norm(p - s.shape.hinge) < s.shape.hub) continue;
            if (line.empty() && i > 0) {  // intersection with the hub's edge
                Vec2 in = s.at.px(point(i - 1)), out = p;
                for (int pass = 0; pass < 40; ++pass) {
                    const Vec2 middle = (in + out) * 0.5;
                    (norm(middle - s.shape.hinge) < s.shape.hub ? in : out) = middle;
                }
                line.push_back(out);
            }
            line.push_back(p);
        }
        return line;
    };
    Outline all{outside([&](std::size_t i) { return beam.face(i); }), {}};
    const std::vector<Vec2> back = outside([&](std::size_t i) { return beam.back(i); });
    all.edge.insert(all.edge.end(), back.rbegin(), back.rend());
    if (all.edge.empty()) return all;
    const Vec2 from = all.edge.back() - s.shape.hinge, to = all.edge.front() - s.shape.hinge;
    const double begin = std::atan2(from.y, from.x), radius = norm(from);
    const double turn = std::remainder(std::atan2(to.y, to.x) - begin, 2 * pi);
    const int pieces = 1 + static_cast<int>(std::abs(turn) * std::sqrt(radius));  // within 1/8 px of the circle
    for (int i = 1; i < pieces; ++i) {
        const double a = begin + turn * i / pieces;
        all.foot.push_back(s.shape.hinge + Vec2{std::cos(a), std::sin(a)} * radius);
    }
    for (std::vector<Vec2>* line : {&all.edge, &all.foot})
        for (Vec2& p : *line) p = s.on(p);
    return all;
}

// The outline of a cam with a profile; else empty.
std::vector<Vec2> cam_edge(const MechanismScene& s, const sim::Problem& problem, const sim::Pose& pose) {
    std::vector<Vec2> edge;
    if (problem.cam && problem.cam->profile)
        for (const Vec2 p : placed_outline(problem, pose, outline_points(200))) edge.push_back(s.on(s.at.px(p)));
    return edge;
}

bool is_near(const Vec2& a, const Vec2& b) { return norm(a - b) <= 0.5; }  // [px]

}  // namespace

// Cams are drawn only where they differ from the first motion's.
void draw_ghost_outlines(const MechanismScene& s) {
    for (int m = 0; m < s.at.context.members(); ++m) {
        if (m == s.at.member) continue;
        const DrawnBeam other = s.at.beam_of(m, s.frame);
        const Color color = s.at.context.member_color(m);
        const sim::Pose& pose = s.at.context.pose(m, s.frame);
        const std::optional<sim::Cam>& cam = s.at.context.motion(m).problem.cam;
        const std::vector<Vec2> edge = cam_edge(s, s.at.context.motion(m).problem, pose);
        if (!edge.empty() && !std::ranges::equal(edge, cam_edge(s, s.at.problem(), s.pose), is_near)) {
            s.canvas.polyline(edge);
            s.canvas.stroke({color.faded(0.8), 2 * s.at.unit, {8 * s.at.unit, 6 * s.at.unit}, Cap::butt});
        }
        if (cam && !cam->profile && (!s.shape.disc || norm(s.at.px(pose.disc_centre) - s.shape.disc->centre) > 0.5)) {
            s.arc(s.at.px(pose.disc_centre), cam->radius * s.at.look.camera.scale, 0, 2 * pi);
            s.canvas.stroke({color.faded(0.8), 2 * s.at.unit, {8 * s.at.unit, 6 * s.at.unit}, Cap::butt});
        }
        s.canvas.polyline(ghost_outline(s, other).edge);
        const std::vector<double> dash = dashes(FilmContext::dash_of(static_cast<std::size_t>(m)), s.at.unit);
        s.canvas.stroke({color, 2.2 * s.at.unit, dash, dash.empty() ? Cap::round : Cap::butt});
    }
}

void draw_ghost_bodies(const MechanismScene& s) {
    for (int m = 0; m < s.at.context.members(); ++m) {
        if (m == s.at.member) continue;
        const Outline outline = ghost_outline(s, s.at.beam_of(m, s.frame));
        s.canvas.polyline(outline.edge);
        for (const Vec2& p : outline.foot) s.canvas.line_to(p);
        s.canvas.fill(s.at.context.member_color(m).faded(0.16));
    }
}

std::optional<DrawnBeam> measured_beam(const MechanismView& at, std::size_t data, sim::Pose pose,
                                       const DrawnBeam& like) {
    const double angle = at.context.measured_angle(data, pose.t);
    if (std::isnan(angle)) return std::nullopt;
    pose.theta = angle;
    pose.nearest.reset();
    const sim::Problem& problem = at.problem();
    const std::size_t last = pose.centreline.size() - 1;
    for (std::size_t i = 0; i <= last; ++i)
        pose.centreline[i] = sim::unit(angle) * (problem.hub.radius + problem.beam.length * static_cast<double>(i) /
                                                                          static_cast<double>(last));
    DrawnBeam beam = drawn_beam(problem, pose, 1, at.look.depth);
    beam.side = like.side, beam.low = like.low, beam.high = like.high;  // placed as the beam's section
    return beam;
}

void draw_measured_beams(const MechanismScene& s) {
    for (std::size_t k = 0; k < s.at.context.setup->data.size(); ++k)
        if (const auto beam = measured_beam(s.at, k, s.pose, s.beam)) {
            s.canvas.polyline(ghost_outline(s, *beam).edge);
            s.canvas.stroke({s.at.context.data_color(k), 2.2 * s.at.unit, {9 * s.at.unit, 5 * s.at.unit}, Cap::butt});
        }
}

}  // namespace beamcam::render
