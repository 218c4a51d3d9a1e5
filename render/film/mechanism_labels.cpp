#include "render/film/mechanism_labels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/gl/bodies.hpp"
#include "render/mechanism/cam_outline.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;

double letter_size(const MechanismView& at) { return at.context.look.letters.heading; }

// A letter that belongs to `owner` is drawn while that is in the view, and stays inside the view [px].
void draw_letter(const MechanismScene& s, Vec2 owner, Vec2 middle, const char* markup, Color color) {
    const double size = letter_size(s.at);
    if (!s.at.labelled() || !s.at.shows(owner)) return;
    const Box within = s.at.box.inset(0.6 * size);
    middle.x = std::clamp(middle.x, within.x, std::max(within.x, within.right()));
    middle.y = std::clamp(middle.y, within.y, std::max(within.y, within.bottom()));
    TextStyle style{.size = size, .color = color, .align = HAlign::centre};
    if (!s.view) style.halo = s.at.palette.paper;  // over soft shadows it would glow
    s.canvas.text(middle + Vec2{0, 0.32 * size}, markup, style);
}

}  // namespace

// ---- θ -----------------------------------------------------------------------------------------

double drawn_angle(const sim::Pose& pose) { return std::fmod(pose.theta, 2 * pi); }

double arc_before_cam(const sim::Problem& problem) { return 0.86 * (norm(problem.cam->centre) - cam_reach(problem)); }

// The arc and its letter lie between hub and cam or, where they have no room there, beyond the cam; so do those of the
// solid view, whose bearing takes that room.
std::optional<double> arc_radius(const MechanismView& home) {
    constexpr double kUsual = 150;    // [design px of marks]
    constexpr double kOfReach = 0.8;  // largest part of the beam's reach
    const bool solid = home.context.setup->view.style == Style::solid;
    const double scale = home.look.camera.scale, letter = letter_size(home) / 21;
    const double hub = solid ? 1.5 * home.hub() + kMountDepth * home.wide : home.hub();
    const double least = hub + 22 * home.marks, usual = std::max(kUsual * home.marks, hub + 50 * letter);
    const double reach = kOfReach * (home.problem().hub.radius + home.problem().beam.length) * scale;
    const double beside = home.box.right() - home.px({0, 0}).x - home.unit;  // where the arc begins
    double radius = std::min({usual, reach, beside});
    if (const std::optional<sim::Cam>& cam = home.problem().cam) {
        const double before = arc_before_cam(home.problem()) * scale - 30 * letter;
        const double aside = solid ? 2 * kDiscDepth * home.wide + 40 * letter : 12 * home.unit;
        const double beyond = (norm(cam->centre) + cam_reach(home.problem())) * scale + aside;
        if (before >= least && !solid)
            radius = std::min(radius, before);
        else if (beyond <= std::min(reach, beside))
            radius = std::max(radius, beyond);
    }
    return radius >= least ? std::optional(radius) : std::nullopt;
}

// The letter is on the bisector, or as far from the beam as it needs: at small angles beyond the horizontal.
void draw_angle(const MechanismScene& s) {
    if (!s.at.labelled() || !s.at.arc_radius) return;
    const double radius = *s.at.arc_radius * s.at.zoom(), angle = drawn_angle(s.pose), way = angle < 0 ? -1 : 1;
    const double edge = (angle > 0 ? -s.beam.low : s.beam.high) * s.at.look.camera.scale;  // of the beam below its line
    const double visible = std::abs(angle) - std::asin(std::clamp(edge / radius, 0.0, 1.0));
    if (visible * radius < 3 * s.at.unit) return;
    const Vec2 o = s.at.px({0, 0});
    const Pen pen{s.at.palette.muted, 1.6 * s.at.unit, {}, Cap::butt};
    s.canvas.clip(s.at.box, [&] {
        s.arc(o, radius, 0, way * (s.view ? visible : std::abs(angle)));
        s.canvas.stroke(pen);
    });
    const double size = letter_size(s.at), outside = radius + 0.8 * size;
    const double clear = std::asin(std::clamp((edge + 0.7 * size) / outside, 0.0, 1.0));
    const double bisector = way * std::min(std::abs(angle) / 2, std::abs(angle) - clear);
    const Vec2 middle = s.on(o + down(bisector) * outside);
    draw_letter(s, middle, middle, "$θ$", s.at.palette.muted);
}

// ---- ω -----------------------------------------------------------------------------------------

// The arrow is outside the circle that the disc sweeps, on the side away from the beam and beside the bracket; in the
// solid view, where a body may be anywhere around it, it is on the face of the disc. Positive speed is clockwise.
void draw_cam_speed(const MechanismScene& s) {
    const std::optional<sim::Cam>& cam = s.at.problem().cam;
    if (!cam || cam->speed == 0 || !s.at.labelled()) return;
    const Vec2 axis = s.at.px(s.pose.cam_centre);
    const double to_cam = std::atan2(cam->centre.y, cam->centre.x), u = s.at.unit;
    const double beam_side = std::remainder(s.at.problem().initial.angle - to_cam, 2 * pi) >= 0 ? 1 : -1;
    const double middle = to_cam - beam_side * 0.2 * pi, reach = cam_reach(s.at.problem()) * s.at.look.camera.scale;
    const double radius = s.view ? 0.45 * reach : reach + 20 * u;
    const Color color = s.view ? rgb(0xF4F6F9) : s.at.palette.muted;
    const double half = std::min(s.view ? 1.4 : 0.8, 150 * u / radius) / 2, head = 17 * u;
    const double from = middle + (cam->speed > 0 ? half : -half), to = 2 * middle - from;
    const double back = (to < from ? 1 : -1) * 0.9 * head / radius;
    const Vec2 on_arc = s.on(axis + down(middle) * radius);
    if (!s.at.shows(on_arc) || radius < 2 * head) return;
    s.arc(axis, radius, from, to + back);
    s.canvas.stroke({color, 2.6 * u, {}, Cap::butt});
    const Vec2 tip = s.on(axis + down(to) * radius);
    Vec2 along = tip - s.on(axis + down(to + back) * radius);
    // Seen from aside, the head keeps its length.
    if (const double length = norm(along); s.view && length > 0)
        along = along * (std::max(0.9 * head, length) / length);
    s.canvas.arrow(tip - along, tip, {color, 2.6 * u}, {head});
    draw_letter(s, on_arc, s.on(axis + down(middle) * (radius + 22 * u)), "$ω$", color);
}

// ---- F -----------------------------------------------------------------------------------------

std::optional<ForceArrow> force_arrow_of(const sim::Pose& pose, const DrawnBeam& beam) {
    if (!shows_force(pose, beam)) return std::nullopt;
    return ForceArrow{beam.contact->on_disc, beam.contact->normal, pose.nearest->force};
}

// The arrow's length is in proportion to the force. A force too small for an arrow is shown by the dot and its letter.
void draw_force(const MechanismScene& s) {
    const std::optional<ForceArrow> arrow = force_arrow_of(s.pose, s.beam);
    if (!arrow) return;
    const double marks = s.at.marks, depth = s.at.look.depth * s.at.look.camera.scale;
    const double length =
        force_arrow_length(std::min(1.0, arrow->force / s.at.context.scales.arrow_force), s.at.small, marks);
    const Color color = s.at.palette.contact;
    const Vec2 flat_foot = s.at.px(arrow->foot), n{arrow->normal.x, -arrow->normal.y}, foot = s.on(flat_foot);
    s.canvas.circle(foot, 5 * marks);
    s.canvas.fill(color);
    if (length > 7 * marks)
        s.canvas.arrow(foot, s.on(flat_foot + n * length), {color, 4 * marks}, {std::min(19 * marks, 0.7 * length)});
    draw_letter(s, foot, s.on(flat_foot + n * force_label_distance(length, depth, s.at.unit)), "$F$", color);
}

}  // namespace beamcam::render
