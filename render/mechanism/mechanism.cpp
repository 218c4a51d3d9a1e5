#include "render/mechanism/mechanism.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/mechanism/cam_outline.hpp"
#include "sim/cam/cam_shape.hpp"

namespace beamcam::render {
namespace {

DiscShape disc_shape(const sim::Problem& problem, const sim::Pose& pose, const Camera& camera, double unit) {
    const auto outline = sim::cam_shape(problem);
    DiscShape disc;
    disc.axis = camera.to_pixels(pose.cam_centre);
    disc.centre = outline->is_disc() ? camera.to_pixels(pose.disc_centre) : disc.axis;
    disc.radius = (outline->is_disc() ? problem.cam->radius : outline->largest_reach()) * camera.scale;
    disc.sharpest = outline->least_radius() * camera.scale;
    disc.angle = pose.cam_angle;
    // The bore stays inside the cam.
    const double marks = mark_unit(problem, camera, unit);
    disc.bore = std::min({0.16 * disc.radius, 12 * marks, 0.6 * outline->least_height() * camera.scale});
    disc.mark_radius = std::min(5.5 * marks, 0.09 * disc.radius);
    const Vec2 ray = sim::unit(pose.cam_angle);
    const double out = disc.radius - std::min(24 * marks, 0.24 * disc.radius);
    disc.mark = disc.centre + Vec2{ray.x, -ray.y} * out;
    if (outline->is_disc()) return disc;
    const CamOutline points = cam_outline(problem, outline_points(disc.radius));
    for (std::size_t i = 0; i < points.points.size(); ++i) {
        disc.outline.push_back(camera.to_pixels(on_cam(pose, points.points[i])));
        const Vec2 n = on_cam(pose, points.normals[i]) - pose.cam_centre;
        disc.outward.push_back({n.x, -n.y});
    }
    disc.mark = disc.rim(0, disc.radius - out);
    return disc;
}

void outline_path(Canvas& canvas, const DiscShape& disc, double inset) {
    if (disc.outline.empty()) return canvas.circle(disc.centre, disc.radius - inset);
    canvas.move_to(disc.rim(0, inset));
    for (std::size_t i = 1; i < disc.outline.size(); ++i) canvas.line_to(disc.outline[i] - disc.outward[i] * inset);
    canvas.close();
}

// The fill ends under the middle of the outline, so that it is not visible at its edges.
void draw_disc(Canvas& canvas, const DiscShape& disc, double unit, const Palette& p) {
    const double rim = std::min(2 * unit, disc.sharpest), bore = 1.6 * unit;
    outline_path(canvas, disc, rim / 2);
    canvas.move_to(disc.axis + Vec2{disc.bore, 0});
    canvas.arc(disc.axis, disc.bore, 0, 2 * std::numbers::pi);  // against the circle: it is cut out
    canvas.close();
    canvas.fill(p.steel);
    outline_path(canvas, disc, rim / 2);
    canvas.stroke({p.steel_edge, rim});
    canvas.circle(disc.axis, disc.bore);
    canvas.stroke({p.steel_edge, bore});
    canvas.circle(disc.mark, disc.mark_radius);
    canvas.fill(p.steel_edge);
}

// Number of colour steps between two stations: steps of two levels of 255 are not visible as bands.
int color_steps(const Color& a, const Color& b) {
    const double most = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
    return std::clamp(static_cast<int>(std::ceil(most * 255 / 2)), 1, 64);
}

// The section's two edges, root to tip.
struct Edges {
    std::vector<Vec2> face, back;  // [px]
};

// Moved inwards; the ends along the beam, at most half way to the next station.
Edges inset(const MechanismShape& s, double by) {
    Edges inner{s.face, s.back};
    const std::size_t n = s.face.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 across = s.back[i] - s.face[i], in = across * (by / norm(across));
        inner.face[i] = inner.face[i] + in;
        inner.back[i] = inner.back[i] - in;
    }
    const auto shorten = [&](std::vector<Vec2>& edge, std::size_t end, std::size_t next) {
        const Vec2 along = edge[next] - edge[end];
        const double length = norm(along);
        if (length > 0) edge[end] = edge[end] + along * std::min(by / length, 0.5);
    };
    for (std::vector<Vec2>* edge : {&inner.face, &inner.back}) {
        shorten(*edge, 0, 1);
        shorten(*edge, n - 1, n - 2);
    }
    return inner;
}

std::vector<Vec2> around(const Edges& edges) {
    std::vector<Vec2> corners = edges.face;
    corners.insert(corners.end(), edges.back.rbegin(), edges.back.rend());
    return corners;
}

// Colours are not antialiased between each other and end under the middle of the outline, whose outer edge is the true
// edge of the section.
void draw_beam(Canvas& canvas, const MechanismShape& s, double unit, const Palette& p) {
    const Edges middle = inset(s, unit);
    for (std::size_t i = 0; i + 1 < s.face.size(); ++i) {
        const int steps = color_steps(s.colors[i], s.colors[i + 1]);
        const auto at = [&](const std::vector<Vec2>& edge, int k) {
            const double way = double(k) / steps;
            return edge[i] * (1 - way) + edge[i + 1] * way;
        };
        for (int k = 0; k < steps; ++k)
            canvas.fill_piece(
                std::array{at(middle.face, k), at(middle.face, k + 1), at(middle.back, k + 1), at(middle.back, k)},
                mix(s.colors[i], s.colors[i + 1], (k + 0.5) / steps));
    }
    canvas.fill_between(around({s.face, s.back}), around(inset(s, 2 * unit)), p.steel_edge);
}

void draw_hub(Canvas& canvas, const MechanismShape& s, double unit, const Palette& p) {
    canvas.circle(s.hinge, s.hub - unit);
    canvas.fill_keeping_path(mix(p.paper, p.steel, 0.45));
    canvas.stroke({p.steel_edge, 2 * unit});
    canvas.circle(s.hinge, s.pin);
    canvas.fill(p.steel_edge);
}

// The corners of the beam's root would be visible outside a wide hub: extends the section inwards until both corners
// are inside the hub.
void continue_into_hub(MechanismShape& s) {
    if (s.face.size() < 2) return;
    const Vec2 along = s.face[0] - s.face[1], inwards = along * (1 / std::max(norm(along), 1e-300));
    const double radius = s.hub - 1;
    double by = 0;
    for (Vec2 corner : {s.face[0], s.back[0]}) {
        const Vec2 from = corner - s.hinge;
        const double outside = dot(from, from) - radius * radius, middle = -dot(from, inwards);
        if (outside <= 0) continue;
        if (middle <= 0 || middle * middle < outside)
            return;  // the beam passes beside the hub, or begins beyond its centre
        by = std::max(by, middle - std::sqrt(middle * middle - outside));
    }
    if (by == 0) return;
    s.face.insert(s.face.begin(), s.face[0] + inwards * by);
    s.back.insert(s.back.begin(), s.back[0] + inwards * by);
    s.colors.insert(s.colors.begin(), s.colors[0]);
}

}  // namespace

Vec2 DiscShape::rim(double share, double inset) const {
    const double whole = share - std::floor(share);
    if (outline.empty()) {
        const Vec2 ray = sim::unit(angle + 2 * std::numbers::pi * whole);
        return centre + Vec2{ray.x, -ray.y} * (radius - inset);
    }
    const double at = whole * static_cast<double>(outline.size());
    const std::size_t i = std::min(static_cast<std::size_t>(at), outline.size() - 1), k = (i + 1) % outline.size();
    const double part = at - static_cast<double>(i);
    return outline[i] * (1 - part) + outline[k] * part - (outward[i] * (1 - part) + outward[k] * part) * inset;
}

double mark_unit(double beam_length, double unit) {
    constexpr double kUsual = 640;         // length of a beam with marks of full size [px]
    constexpr double kSmallestHub = 0.25;  // gives a hub of 5 px
    return std::clamp(beam_length / kUsual, std::min(kSmallestHub, unit), unit);
}

double mark_unit(const sim::Problem& problem, const Camera& camera, double unit) {
    return mark_unit(problem.beam.length * camera.scale, unit);
}

double root_radius(const sim::Problem& problem) {
    constexpr double kCorner = 1.06;  // distance of a corner from the hub's axis, in its distance from the centre line
    const double depth = beam_depth(problem.beam), offset = problem.cam ? sim::contact_offset(problem) : depth / 2;
    return kCorner * std::max(offset, depth - offset);
}

// Covers the corners of the beam's root, within limits, and stays outside the circle that the disc sweeps.
double hub_radius(const sim::Problem& problem, const Camera& camera, double unit) {
    const double marks = mark_unit(problem, camera, unit);
    double boss = std::clamp(root_radius(problem) * camera.scale, 19 * marks, 48 * marks);
    if (problem.cam) {
        const double free = norm(problem.cam->centre) - cam_reach(problem);
        boss = std::min(boss, 0.7 * std::max(free, 0.0) * camera.scale);
    }
    return std::max({problem.hub.radius * camera.scale, boss, 1.0});
}

double support_reach(double hub, double marks) { return hub + 44 * marks; }
double support_half_width(double hub, double marks) { return 0.6 * (hub + 24 * marks) + 18 * marks; }

double floor_depth(const sim::Problem& problem, const Camera& camera, double unit) {
    const double marks = mark_unit(problem, camera, unit);
    double depth = support_reach(hub_radius(problem, camera, unit), marks);
    if (problem.cam) depth = std::max(depth, (cam_reach(problem) - problem.cam->centre.y) * camera.scale + 26 * marks);
    return depth;
}

// The width of lines has a visible minimum.
void draw_support(Canvas& canvas, Vec2 o, double hub, double u, double line, const Palette& p) {
    const double foot = hub + 24 * u, half = 0.6 * foot + 6 * u, pen = std::max(line, 0.45),
                 apart = std::max(11 * u, 4.0);
    canvas.move_to(o);
    canvas.line_to({o.x - half, o.y + foot});
    canvas.line_to({o.x + half, o.y + foot});
    canvas.close();
    canvas.fill_keeping_path(mix(p.paper, p.steel, 0.35));
    canvas.stroke({p.steel_edge, 2 * pen});
    const double wide = support_half_width(hub, u);
    const int lines = 1 + static_cast<int>((2 * wide - 10 * u) / apart);
    for (int i = 0; i < lines; ++i) {
        const double x = 10 * u + apart * i - wide;
        canvas.move_to({o.x + x, o.y + foot});
        canvas.line_to({o.x + x - 10 * u, o.y + foot + 12 * u});
    }
    canvas.stroke({p.muted, 1.5 * pen});
    canvas.line({o.x - wide, o.y + foot}, {o.x + wide, o.y + foot}, {p.steel_edge, 2.4 * pen});
}

MechanismShape mechanism_shape(const sim::Problem& problem, const sim::Pose& pose, const DrawnBeam& beam,
                               const MechanismLook& look, const Palette& p) {
    MechanismShape s;
    const std::size_t n = beam.line.size();
    for (std::size_t i = 0; i < n; ++i) {
        s.face.push_back(look.camera.to_pixels(beam.face(i)));
        s.back.push_back(look.camera.to_pixels(beam.back(i)));
        const bool colored = look.moment_scale > 0 && i < pose.moment.size();
        const double share = colored ? pose.moment[i] / look.moment_scale : 0;
        s.colors.push_back(moment_color(p, std::copysign(std::sqrt(std::abs(share)), share)));
    }
    s.hinge = look.camera.to_pixels({0, 0});
    s.hub = hub_radius(problem, look.camera, look.unit);
    s.pin = std::min(7 * look.unit, 0.4 * s.hub);
    s.floor = s.hinge.y + floor_depth(problem, look.camera, look.unit);
    const auto add_bracket = [&](Vec2 shaft, double top) {
        const double marks = mark_unit(problem, look.camera, look.unit);
        s.brackets.push_back({shaft, top, 1.1 * top + std::min(0.2 * (s.floor - shaft.y), 40 * marks) + 8 * marks});
    };
    add_bracket(s.hinge, 0.8 * s.hub);
    if (problem.cam) s.disc = disc_shape(problem, pose, look.camera, look.unit);
    if (s.disc) add_bracket(s.disc->axis, 1.6 * s.disc->bore);
    if (beam.contact)
        s.touch = {look.camera.to_pixels(beam.contact->on_disc), {beam.contact->normal.x, -beam.contact->normal.y}};
    continue_into_hub(s);
    return s;
}

void draw_flat(Canvas& canvas, const MechanismShape& shape, double line, const Palette& p) {
    if (shape.disc) draw_disc(canvas, *shape.disc, line, p);
    draw_beam(canvas, shape, line, p);
    draw_hub(canvas, shape, line, p);
}

}  // namespace beamcam::render
