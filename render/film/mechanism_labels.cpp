#include "render/film/mechanism_labels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/film/mechanism_marks.hpp"
#include "render/gl/bodies.hpp"
#include "render/mechanism/cam_outline.hpp"
#include "sim/beam/drive.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;

double letter_size(const MechanismView& at) { return at.context.look.letters.heading; }

// A letter that belongs to `owner` is drawn while that is in the view, and stays inside the view [px].
void draw_letter(const MechanismScene& s, Vec2 owner, Vec2 middle, const char* markup, Color color, bool halo = true) {
    const double size = letter_size(s.at);
    if (!s.at.labelled() || !s.at.shows(owner)) return;
    const Box within = s.at.box.inset(0.6 * size);
    middle.x = std::clamp(middle.x, within.x, std::max(within.x, within.right()));
    middle.y = std::clamp(middle.y, within.y, std::max(within.y, within.bottom()));
    TextStyle style{.size = size, .color = color, .align = HAlign::centre};
    if (!s.view && halo) style.halo = s.at.palette.paper;  // over soft shadows it would glow
    s.canvas.text(middle + Vec2{0, 0.32 * size}, markup, style);
}

}  // namespace

// ---- θ -----------------------------------------------------------------------------------------

double drawn_angle(const sim::Pose& pose) { return std::fmod(pose.theta, 2 * pi); }

double arc_before_cam(const sim::Problem& problem) { return 0.86 * (norm(problem.cam->centre) - cam_reach(problem)); }

// A part of the beam's reach [px].
static double longest_arc(const MechanismView& at) {
    return 0.8 * (at.problem().hub.radius + at.problem().beam.length) * at.look.camera.scale;
}

// The arc and its letter lie beyond the cam or, where the beam is too short for that, between hub and cam.
std::optional<double> arc_radius(const MechanismView& home) {
    constexpr double kUsual = 150;  // [design px of marks]
    const bool solid = home.context.setup->view.style == Style::solid;
    const double scale = home.look.camera.scale, letter = letter_size(home) / 21;
    const double hub = solid ? 1.5 * home.hub() + kMountDepth * home.wide : home.hub();
    const double least = least_arc(hub, home.marks), usual = std::max(kUsual * home.marks, hub + 50 * letter);
    const double reach = longest_arc(home);
    const Vec2 o = home.px({0, 0});
    double beside = home.box.right() - o.x - home.unit;  // where the arc begins
    if (home.context.extent.turned)
        beside = std::min({beside, o.x - home.box.x - 40 * home.unit, o.y - home.box.y - 40 * home.unit,
                           home.box.bottom() - o.y - 40 * home.unit});
    double radius = std::min({usual, reach, beside});
    if (const std::optional<sim::Cam>& cam = home.problem().cam) {
        const double before = arc_before_cam(home.problem()) * scale - 30 * letter;
        const double aside = 40 * letter + (solid ? 2 * kDiscDepth * home.wide : 0);
        const double beyond = (norm(cam->centre) + cam_reach(home.problem())) * scale + aside;
        if (beyond <= std::min(reach, beside))
            radius = std::max(radius, beyond);
        else if (before >= least)
            radius = std::min(radius, before);
    }
    return radius >= least ? std::optional(radius) : std::nullopt;
}

// The arc ends at the line at θ through the hub, behind the beam. The letter is on the bisector, or as far from the
// beam as it needs; without room for it between beam and horizontal there are neither. With the cam on the beam's other
// side, the arc has the radius at which the letter has room between beam and horizontal.
std::optional<Vec2> draw_arc_of_angle(const MechanismScene& s) {
    if (!s.at.labelled() || !s.at.arc_radius) return std::nullopt;
    const double angle = drawn_angle(s.pose);
    double radius = *s.at.arc_radius * s.at.zoom();
    const double way = angle < 0 ? -1 : 1, size = letter_size(s.at);
    const double edge = (angle > 0 ? -s.beam.low : s.beam.high) * s.at.look.camera.scale;  // of the beam below its line
    if (way * s.beam.side < 0)
        radius = std::max(radius, std::min(longest_arc(s.at), (edge + 1.4 * size) / std::abs(angle) - 0.8 * size));
    const Vec2 o = s.at.px({0, 0});
    const double outside = radius + 0.8 * size;
    double room = std::abs(angle);  // up to the drawn beam near the letter
    for (const std::vector<Vec2>* side : {&s.shape.face, &s.shape.back})
        for (const Vec2& p : *side)
            if (std::abs(norm(p - o) - outside) < size)
                room = std::min(room, way * (angle + std::remainder(std::atan2(o.y - p.y, p.x - o.x) - angle, 2 * pi)));
    const double half = 0.5 * size / outside;  // of the letter
    if (room < 2 * half) return std::nullopt;
    s.canvas.clip(s.at.box, [&] {
        s.arc(o, radius, 0, angle);
        s.canvas.stroke({s.at.palette.muted, 1.6 * s.at.unit, {}, Cap::butt});
    });
    return s.on(o + down(way * std::min(std::abs(angle) / 2, room - half)) * outside);
}

void draw_letter_of_angle(const MechanismScene& s, Vec2 middle) {
    draw_letter(s, middle, middle, "$θ$", s.at.palette.muted);
}

// ---- ω and τ -----------------------------------------------------------------------------------

// An arrow along an arc about an axis, with its letter outside; clockwise if `half` > 0.
struct TurningArrow {
    Vec2 axis;
    double radius = 0, middle = 0, half = 0, depth = 0;
    Color color;
    const char* letter = "";
    bool halo = true;
};

static void draw_turning(const MechanismScene& s, const TurningArrow& arrow) {
    const double u = s.at.unit, head = 17 * u, to = arrow.middle - arrow.half;
    const double back = std::copysign(0.9 * head / arrow.radius, arrow.half);
    const auto at = [&](double angle, double r) { return s.on(arrow.axis + down(angle) * r, arrow.depth); };
    const Vec2 on_arc = at(arrow.middle, arrow.radius);
    if (!s.at.shows(on_arc) || arrow.radius < 2 * head) return;
    const Vec2 tip = at(to, arrow.radius);
    Vec2 along = tip - at(to + back, arrow.radius);
    // Seen from aside, the head keeps its length.
    if (const double length = norm(along); s.view && length > 0)
        along = along * (std::max(0.9 * head, length) / length);
    s.arc(arrow.axis, arrow.radius, arrow.middle + arrow.half, to + back, arrow.depth);
    s.canvas.stroke({arrow.color, 2.6 * u, {}, Cap::butt});
    s.canvas.arrow(tip - along, tip, {arrow.color, 2.6 * u}, {head});
    draw_letter(s, on_arc, at(arrow.middle, arrow.radius + 22 * u), arrow.letter, arrow.color, arrow.halo);
}

// Around the hub, above it on the side away from the beam. A positive torque is counter-clockwise.
void draw_hub_torque(const MechanismScene& s) {
    const sim::Problem& problem = s.at.problem();
    if (!s.at.labelled() || sim::is_prescribed(problem.hub.drive)) return;
    const double torque = sim::DriveLaw(problem.hub.drive, 0).torque(s.pose.t);
    if (torque == 0) return;
    draw_turning(s, {.axis = s.at.px({0, 0}),
                     .radius = s.at.hub() + torque_arrow_distance(s.at.unit),
                     .middle = problem.initial.angle + 0.7 * pi,
                     .half = std::copysign(0.6, -torque),
                     .depth = kHubDepth,
                     .color = s.at.palette.muted,
                     .letter = "$τ$"});
}

// The arrow is outside the circle that the disc sweeps, on the side away from the beam, in the plane of the disc's
// front or back that is farther out there; where a bracket is there, it is on the face of the disc. Positive speed is
// clockwise.
void draw_cam_speed(const MechanismScene& s) {
    const std::optional<sim::Cam>& cam = s.at.problem().cam;
    if (!cam || cam->speed == 0 || !s.at.labelled()) return;
    const Vec2 axis = s.at.px(s.pose.cam_centre);
    const double to_cam = std::atan2(cam->centre.y, cam->centre.x), u = s.at.unit;
    const double beam_side = std::remainder(s.at.problem().initial.angle - to_cam, 2 * pi) >= 0 ? 1 : -1;
    const double middle = to_cam - beam_side * 0.18 * pi, reach = cam_reach(s.at.problem()) * s.at.look.camera.scale;
    double radius = reach + 20 * u;
    const auto half = [&](double most) { return std::min(most, 150 * u / radius) / 2; };
    const auto behind = [&](double angle) {  // a bracket is there, behind the arrow
        const Vec2 at = axis + down(angle) * radius;
        return std::ranges::any_of(s.shape.brackets, [&](const MechanismShape::Bracket& each) {
            return at.y > each.shaft.y && std::abs(at.x - each.shaft.x) < each.foot + 2 * u;
        });
    };
    const bool on_face = behind(middle - half(0.8)) || behind(middle) || behind(middle + half(0.8));
    if (on_face) radius = 0.45 * reach;
    const auto out = [&](double depth) { return norm(s.on(axis + down(middle) * radius, depth) - s.on(axis, 0)); };
    const TurningArrow arrow{.axis = axis,
                             .radius = radius,
                             .middle = middle,
                             .half = std::copysign(half(on_face ? 1.4 : 0.8), cam->speed),
                             .depth = on_face || out(kDiscDepth) > out(-kDiscDepth) ? kDiscDepth : -kDiscDepth,
                             .color = on_face ? ink_on_disc(s) : s.at.palette.muted,
                             .letter = "$ω$",
                             .halo = !on_face};
    on_face ? s.canvas.without_halo([&] { draw_turning(s, arrow); }) : draw_turning(s, arrow);
}

// ---- F -----------------------------------------------------------------------------------------

std::optional<ForceArrow> force_arrow_of(const sim::Pose& pose, const DrawnBeam& beam) {
    if (!shows_force(pose, beam)) return std::nullopt;
    return ForceArrow{beam.contact->on_disc, beam.contact->normal, pose.nearest->force};
}

// The arrow's length is in proportion to the force. An arrow shorter than its usual head has no letter.
void draw_force(const MechanismScene& s) {
    const std::optional<ForceArrow> arrow = force_arrow_of(s.pose, s.beam);
    if (!arrow) return;
    const double marks = s.at.marks, depth = s.at.look.depth * s.at.look.camera.scale;
    const double length =
        force_arrow_length(std::min(1.0, arrow->force / s.at.context.scales.arrow_force), s.at.small, marks);
    const Color color = s.at.palette.contact;
    const Vec2 flat_foot = s.at.px(arrow->foot), n{arrow->normal.x, -arrow->normal.y}, foot = s.on(flat_foot);
    const double head = 19 * marks, size = marks * std::min(1.0, length / (2 * head));  // a short arrow is a small one
    s.canvas.arrow(foot, s.on(flat_foot + n * length), {color, 4 * size}, {19 * size});
    if (length > head)
        draw_letter(s, foot, s.on(flat_foot + n * force_label_distance(length, depth, s.at.unit)), "$F$", color);
}

}  // namespace beamcam::render
