#include "render/mechanism.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

DiscShape disc_shape(const sim::Problem& problem, const sim::Pose& pose, const Camera& camera, double unit) {
    const sim::Cam& cam = *problem.cam;
    DiscShape disc;
    disc.centre = camera.to_pixels(pose.disc_centre);
    disc.axis = camera.to_pixels(pose.cam_centre);
    disc.radius = cam.radius * camera.scale;
    disc.angle = pose.cam_angle;
    // The bore stays inside the disc: at C it has R − e of material around it.
    disc.bore = std::min({0.16 * disc.radius, 12 * unit, 0.6 * (cam.radius - cam.eccentricity) * camera.scale});
    disc.mark_radius = std::min(5.5 * unit, 0.09 * disc.radius);
    const Vec2 ray = sim::unit(pose.cam_angle);
    const double out = disc.radius - std::min(24 * unit, 0.24 * disc.radius);
    disc.mark = disc.centre + Vec2{ray.x, -ray.y} * out;
    return disc;
}

void draw_disc(Canvas& canvas, const DiscShape& disc, double unit, const Palette& p) {
    canvas.circle(disc.centre, disc.radius);
    canvas.circle(disc.axis, disc.bore);
    canvas.fill_even_odd(p.steel);
    canvas.circle(disc.centre, disc.radius - unit);
    canvas.stroke({p.steel_edge, 2 * unit});
    canvas.circle(disc.axis, disc.bore);
    canvas.stroke({p.steel_edge, 1.6 * unit});
    canvas.circle(disc.mark, disc.mark_radius);
    canvas.fill(p.steel_edge);
}

// Into how many parts the colour between two stations is divided: steps of two levels of 255 are no bands to the eye.
int color_steps(const Color& a, const Color& b) {
    const double most = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
    return std::clamp(static_cast<int>(std::ceil(most * 255 / 2)), 1, 64);
}

// Each piece reaches on into the next station's, so that no seam shows; the outline covers the hard edges.
void draw_beam(Canvas& canvas, const MechanismShape& s, double unit, const Palette& p) {
    const std::size_t n = s.face.size();
    canvas.smooth_edges(false);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const int steps = color_steps(s.colors[i], s.colors[i + 1]);
        const bool last = i + 2 == n;
        for (int k = 0; k < steps; ++k) {
            const double from = double(k) / steps;
            const Vec2 face = s.face[i] * (1 - from) + s.face[i + 1] * from,
                       back = s.back[i] * (1 - from) + s.back[i + 1] * from;
            canvas.move_to(face);
            canvas.line_to(s.face[i + 1]);
            if (!last) canvas.line_to(s.face[i + 1] + (s.face[i + 2] - s.face[i + 1]) * 0.5);
            if (!last) canvas.line_to(s.back[i + 1] + (s.back[i + 2] - s.back[i + 1]) * 0.5);
            canvas.line_to(s.back[i + 1]);
            canvas.line_to(back);
            canvas.close();
            canvas.fill(mix(s.colors[i], s.colors[i + 1], (k + 0.5) / steps));
        }
    }
    canvas.smooth_edges(true);
    // Drawn inside the section, so that the face's outer edge is the true one.
    const auto inner = [&](std::size_t i, bool face) {
        const Vec2 across = s.back[i] - s.face[i];
        const Vec2 in = across * (unit / norm(across));
        return face ? s.face[i] + in : s.back[i] - in;
    };
    for (std::size_t i = 0; i < n; ++i) i == 0 ? canvas.move_to(inner(i, true)) : canvas.line_to(inner(i, true));
    for (std::size_t i = n; i-- > 0;) canvas.line_to(inner(i, false));
    canvas.close();
    canvas.stroke({p.steel_edge, 2 * unit});
}

void draw_hub(Canvas& canvas, const MechanismShape& s, double unit, const Palette& p) {
    canvas.circle(s.hinge, s.hub - unit);
    canvas.fill_keeping_path(mix(p.paper, p.steel, 0.45));
    canvas.stroke({p.steel_edge, 2 * unit});
    canvas.circle(s.hinge, s.pin);
    canvas.fill(p.steel_edge);
}

}  // namespace

// Wide enough to cover the root's corners, within reason, and always short of the circle that the disc sweeps.
double hub_radius(const sim::Problem& problem, const Camera& camera, double unit) {
    const double offset = problem.cam ? sim::contact_offset(problem) : problem.beam.depth / 2;
    const double corner = 1.06 * std::max(offset, problem.beam.depth - offset) * camera.scale;
    double boss = std::clamp(corner, 19 * unit, 36 * unit);
    if (problem.cam) {
        const double free = norm(problem.cam->centre) - problem.cam->radius - problem.cam->eccentricity;
        boss = std::min(boss, 0.7 * std::max(free, 0.0) * camera.scale);
    }
    return std::max({problem.hub.radius * camera.scale, boss, 1.0});
}

double support_reach(double hub, double unit) { return hub + 44 * unit; }

void draw_support(Canvas& canvas, Vec2 o, double hub, double u, const Palette& p) {
    const double foot = hub + 24 * u, half = 0.6 * foot + 6 * u;
    canvas.move_to(o);
    canvas.line_to({o.x - half, o.y + foot});
    canvas.line_to({o.x + half, o.y + foot});
    canvas.close();
    canvas.fill_keeping_path(mix(p.paper, p.steel, 0.35));
    canvas.stroke({p.steel_edge, 2 * u});
    const double wide = half + 12 * u;
    for (double x = -wide + 10 * u; x <= wide; x += 11 * u) {
        canvas.move_to({o.x + x, o.y + foot});
        canvas.line_to({o.x + x - 10 * u, o.y + foot + 12 * u});
    }
    canvas.stroke({p.muted, 1.5 * u});
    canvas.move_to({o.x - wide, o.y + foot});
    canvas.line_to({o.x + wide, o.y + foot});
    canvas.stroke({p.steel_edge, 2.4 * u});
}

MechanismShape mechanism_shape(const sim::Problem& problem, const sim::Pose& pose, const DrawnBeam& beam,
                               const MechanismLook& look, const Palette& p) {
    MechanismShape s;
    const std::size_t n = beam.line.size();
    for (std::size_t i = 0; i < n; ++i) {
        s.face.push_back(look.camera.to_pixels(beam.face(i)));
        s.back.push_back(look.camera.to_pixels(beam.back(i)));
        const bool colored = look.moment_scale > 0 && i < pose.moment.size();
        s.colors.push_back(colored ? moment_color(p, pose.moment[i] / look.moment_scale) : moment_color(p, -0.5));
    }
    s.hinge = look.camera.to_pixels({0, 0});
    s.hub = hub_radius(problem, look.camera, look.unit);
    s.pin = std::min(7 * look.unit, 0.4 * s.hub);
    if (problem.cam) s.disc = disc_shape(problem, pose, look.camera, look.unit);
    return s;
}

void draw_flat(Canvas& canvas, const MechanismShape& shape, const MechanismLook& look, const Palette& p) {
    if (shape.disc) draw_disc(canvas, *shape.disc, look.unit, p);
    draw_beam(canvas, shape, look.unit, p);
    draw_hub(canvas, shape, look.unit, p);
}

}  // namespace beamcam::render
