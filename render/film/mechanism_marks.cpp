#include "render/film/mechanism_marks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr double kFarLabel = 60, kFarLetter = 26;  // distance from which a label has a leader line [design px]

// Draws the leader line of a label whose owner is far.
void draw_leader(const MechanismScene& s, const LabelPlace& label, Color color, Vec2 owner, Vec2 base,
                 double far = kFarLabel) {
    const Box box = s.at.label_box(label, s.view, base);
    const Vec2 edge{std::clamp(owner.x, box.x, box.right()), std::clamp(owner.y, box.y, box.bottom())};
    const double way = norm(owner - edge), opacity = label.opacity_at(s.frame);
    if (opacity <= 0 || !s.at.shows(s.px(base)) || way <= far * s.at.unit) return;
    const Vec2 gap = (owner - edge) * (6 * s.at.unit / way);
    s.canvas.line(edge + gap, owner - gap, {color.faded(0.6 * opacity), 1.2 * s.at.unit});
}

// A moving camera shows labels whose base is in view.
void draw_label(const MechanismScene& s, const LabelPlace& label, const std::string& text, TextStyle style, Vec2 base) {
    const double opacity = label.opacity_at(s.frame);
    const Box box = s.at.label_box(label, s.view, base);
    if (opacity <= 0 || !s.at.shows(s.px(base))) return;
    style.color = style.color.faded(opacity);
    // In the solid view a halo over soft shadows would glow; a near camera needs it.
    if (!s.view || s.at.moved) style.halo = s.at.palette.paper.faded(opacity);
    const double left = style.align == HAlign::centre ? box.centre().x : box.x;
    s.canvas.text({left, box.centre().y + 0.32 * style.size}, text, style);
    if (s.labels) s.labels->push_back(box);
}

}  // namespace

double speed_radius(const MechanismView& at) {
    const sim::Cam& cam = *at.problem().cam;
    return (cam.radius + cam.eccentricity) * at.look.camera.scale + speed_gap(at);
}

double speed_gap(const MechanismView& at) { return 20 * at.unit; }

double speed_span(const MechanismView& at) { return std::min(0.8, 150 * at.unit / speed_radius(at)); }

// In proportion to the force, peaks that are held included.
double arrow_length(const MechanismView& at, const ForceArrow& arrow) {
    return force_arrow_length(std::min(1.0, arrow.force / at.context.arrow_scale), at.small, at.marks);
}

TextStyle force_style(const MechanismView& at) {
    return {.size = 22.0 / 21 * label_size(at), .color = at.palette.contact, .weight = Weight::medium};
}

double drawn_angle(const sim::Pose& pose) { return std::fmod(pose.theta, 2 * pi); }

std::vector<Color> rim_colors(const MechanismView& at, const Trace& trace, double now) {
    const double half_life = trace_half_life(at.context.span);
    std::vector<Color> out(trace.rim().size(), Color{0, 0, 0, 0});
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!(trace.rim()[i] > 0) || !(at.context.force_scale > 0)) continue;
        if (at.context.setup->view.trace == TraceColor::force) {
            out[i] = force_color(at.palette, std::sqrt(std::min(1.0, double(trace.rim()[i]) / at.context.force_scale)));
        } else {
            const double age = std::max(0.0, now - trace.rim_times()[i]);
            out[i] = age_color(at.palette, age, half_life);
        }
    }
    return out;
}

void draw_angle_arc(const MechanismScene& s) {
    if (!s.at.labelled()) return;
    const double radius = s.at.labels->arc_radius * s.at.zoom(), angle = drawn_angle(s.pose);
    if (radius < s.at.hub() + 22 * s.at.marks) return;
    const Vec2 o = s.at.px({0, 0});
    if (std::abs(angle) >= kLeastArc) {
        s.arc(o, radius, 0, angle);
        s.canvas.stroke({s.at.palette.muted, 1.6 * s.at.unit, {}, Cap::butt});
    }
    if (!s.at.labels->angle) return;
    // A letter outside the sector of the angle gets a leader line to the start of the arc.
    const Vec2 letter = s.at.px(s.at.labels->angle->base) + s.at.labels->angle->offset * s.at.zoom() - o;
    const double sense = angle < 0 ? -1 : 1, way = std::atan2(-letter.y, letter.x) * sense;
    const double turned = way < 0 ? way + 2 * pi : way;
    const double foot = turned <= std::max(std::abs(angle), pi / 2) ? turned * sense : 0;
    const LabelPlace& label = *s.at.labels->angle;
    draw_leader(s, label, s.at.palette.muted, s.on(o + down(foot) * radius), label.base, kFarLetter);
    draw_label(s, label, "$θ$", {.size = 21 * angle_letter(s.at), .color = s.at.palette.muted, .align = HAlign::centre},
               label.base);
}

// Outside the circle that the disc sweeps, on a side away from the beam. Positive speed is clockwise.
void draw_cam_speed(const MechanismScene& s) {
    if (!s.at.problem().cam || !s.at.labelled()) return;
    const sim::Cam& cam = *s.at.problem().cam;
    const Vec2 axis = s.at.px(s.pose.cam_centre);
    const double radius = speed_radius(s.at), middle = s.at.labels->speed_way;
    if (!s.at.shows(s.on(axis + down(middle) * radius))) return;
    if (cam.speed != 0) {
        const double half = speed_span(s.at) / 2;
        const double from = middle + (cam.speed > 0 ? half : -half), to = 2 * middle - from;
        const double head = 17 * s.at.unit, back = (to < from ? 1 : -1) * 0.9 * head / radius;
        s.arc(axis, radius, from, to + back);
        s.canvas.stroke({s.at.palette.muted, 2.6 * s.at.unit, {}, Cap::butt});
        const Vec2 tip = s.on(axis + down(to) * radius);
        Vec2 way = tip - s.on(axis + down(to + back) * radius);
        // Seen from aside, the head keeps its length.
        if (const double length = norm(way); s.view && length > 0) way = way * (std::max(0.9 * head, length) / length);
        s.canvas.arrow(tip - way, tip, {s.at.palette.muted, 2.6 * s.at.unit}, {head});
    }
    const LabelPlace& label = *s.at.labels->speed;
    draw_leader(s, label, s.at.palette.muted, s.on(axis + down(middle) * radius), label.base);
    draw_label(s, label, speed_label(s.at), {.size = label_size(s.at), .color = s.at.palette.muted}, label.base);
}

// The base line of the exaggerated deflection.
void draw_base_line(const MechanismScene& s) {
    const bool led = sim::is_prescribed(s.at.problem().hub.drive);
    const Vec2 base = sim::unit(s.at.look.factor == 1 && led ? s.pose.theta : s.beam.base_angle);
    // Without exaggeration, the direction of a prescribed hub, unless it coincides with the horizontal.
    if (s.at.look.factor == 1 && !(led && std::abs(base.y) > 0.01)) return;
    const double clear = 4 * s.at.unit / s.at.look.camera.scale;
    constexpr double kGap = std::numeric_limits<double>::quiet_NaN();  // interrupts the line
    std::vector<Vec2> line;  // only outside the section: dashes along its edge would be confusing
    for (Vec2 p : s.beam.line) {
        const double below = -cross(base, p);  // the base line's offset from the centre line
        const bool covered = below > s.beam.low - clear && below < s.beam.high + clear;
        line.push_back(covered ? Vec2{kGap, kGap} : s.px(base * dot(base, p)));
    }
    s.canvas.clip(s.at.box, [&] {  // the base line may extend beyond the extent of the camera
        s.canvas.polyline(line);
        s.canvas.stroke({s.at.palette.faint, 1.5 * s.at.unit, {6 * s.at.unit, 7 * s.at.unit}, Cap::butt});
    });
}

static Color ink_on_disc(const MechanismScene& s) {
    const bool dark = s.at.context.setup->view.theme == Theme::dark;
    if (s.view) return s.at.palette.ink;
    if (dark && s.at.context.setup->view.style == Style::flat) return s.at.palette.paper;
    return dark ? rgb(0x14171D) : s.at.palette.steel_edge;
}

// B and C are beyond the ends of the line between them or, on a small disc, on its two sides, and inside the disc.
void draw_disc_letters(const MechanismScene& s) {
    if (!s.shape.disc) return;
    const Color ink = ink_on_disc(s);
    const DiscShape& d = *s.shape.disc;
    // On a small disc they keep a readable size.
    const double size = std::max(22 * s.at.marks, std::min(least_letter(s.at), 0.5 * d.radius)), letter = size / 22;
    if (size < kReadable || d.radius < 60 * s.at.marks || !s.at.context.setup->view.show.labels) return;
    const double apart = norm(d.centre - d.axis);
    const Vec2 along = apart > 2 ? (d.centre - d.axis) * (1 / apart) : Vec2{0, -1}, across{along.y, -along.x};
    TextStyle style{.size = size, .color = ink, .align = HAlign::centre};
    // A halo covers the outlines of other discs; it must not cover the pin.
    if (s.at.ghosts) style.halo = s.at.palette.steel;
    const auto put = [&](const char* name, Vec2 at) {
        const Vec2 middle = s.on(at);
        if (s.at.moved && !s.at.box.inset(12 * letter).contains({middle.x, middle.y, 0, 0}))
            return;  // cut off by the edge of the panel
        s.canvas.text(middle + Vec2{0, 7 * letter}, name, style);
    };
    const double beyond = 4 * s.at.marks + (s.at.ghosts ? 21 : 16) * letter;
    if (beyond + 13 * letter > norm(d.mark - d.centre) - d.mark_radius) {  // B would touch the mark
        put("$B$", d.centre - across * (13 * letter));
        put("$C$", d.axis + across * (d.bore + 12 * letter));
        return;
    }
    put("$B$", d.centre + along * beyond);
    // The shaft in the solid view needs more space. If C would come near the rim, where contacts and their rings are,
    // it goes to the side.
    const double off = d.bore + (s.view ? 24 : 16) * letter;
    put("$C$", d.axis + (apart + off + 24 * s.at.marks <= d.radius ? along * -1 : along * 0.6 + across * 0.8) * off);
}

void draw_disc_marks(const MechanismScene& s, const Trace& trace) {
    if (!s.shape.disc) return;
    const DiscShape& d = *s.shape.disc;
    const double inset = std::min(7 * s.at.unit, 0.1 * d.radius), n = static_cast<double>(trace.rim().size());
    const auto place = [&](std::size_t i) {
        const double at = d.angle + 2 * pi * (static_cast<double>(i) + 0.5) / n, half = 2 * pi * 1.7 / n;
        s.canvas.move_to(d.centre + down(at - half) * (d.radius - inset));
        s.canvas.arc(d.centre, d.radius - inset, at - half, at + half);
    };
    const double width = std::min(7 * s.at.unit, 0.1 * d.radius);
    if (s.at.context.setup->view.trace == TraceColor::force) {
        stroke_places(s.canvas, s.at.context, trace.rim(), width, place);
    } else {
        const std::vector<Color> colors = rim_colors(s.at, trace, s.pose.t);
        for (std::size_t i = 0; i < colors.size(); ++i) {
            if (colors[i].a == 0) continue;
            place(i);
            s.canvas.stroke({colors[i], width, {}, Cap::butt});
        }
    }
    if (d.radius < 26 * s.at.marks) return;
    const Color ink = ink_on_disc(s);
    const double apart = norm(d.centre - d.axis), pen = std::max(s.at.marks, 0.45);
    if (apart > d.bore + 2) {
        s.canvas.move_to(d.axis + (d.centre - d.axis) * (d.bore / apart));
        s.canvas.line_to(d.centre);
        s.canvas.stroke({ink, 1.8 * pen});
    }
    s.canvas.circle(d.centre, 4 * s.at.marks);
    s.canvas.fill(ink);
    if (s.at.context.setup->view.transparent) {  // the bore shows the background, on which the cross may be invisible
        s.canvas.circle(d.axis, d.bore);
        s.canvas.fill(s.at.palette.paper);
    }
    for (Vec2 arm : {Vec2{1, 0}, Vec2{0, 1}}) {
        s.canvas.move_to(d.axis - arm * (d.bore * 0.75));
        s.canvas.line_to(d.axis + arm * (d.bore * 0.75));
    }
    s.canvas.stroke({s.at.palette.ink, 1.6 * pen, {}, Cap::butt});
}

void draw_beam_trace(const MechanismScene& s, const Trace& trace) {
    const double n = static_cast<double>(trace.beam().size()), last = static_cast<double>(s.beam.line.size() - 1);
    const double inset = 4.5 * s.at.unit;
    const auto at = [&](double place) {
        const double station = std::clamp(place / n * last, 0.0, last);
        const auto i = std::min(static_cast<std::size_t>(station), s.beam.line.size() - 2);
        const double part = station - static_cast<double>(i);
        const Vec2 face = s.px(s.beam.face(i) * (1 - part) + s.beam.face(i + 1) * part),
                   back = s.px(s.beam.back(i) * (1 - part) + s.beam.back(i + 1) * part);
        return face + (back - face) * (inset / norm(back - face));
    };
    stroke_places(s.canvas, s.at.context, trace.beam(), 5 * s.at.unit, [&](std::size_t i) {
        s.canvas.move_to(at(static_cast<double>(i) - 1.2));
        s.canvas.line_to(at(static_cast<double>(i) + 2.2));
    });
}

std::optional<ForceArrow> force_arrow_of(const sim::Pose& pose, const DrawnBeam& beam,
                                         const std::optional<ForceArrow>& peak) {
    if (peak || !shows_force(pose, beam)) return peak;
    return ForceArrow{beam.contact->on_disc, beam.contact->normal, pose.nearest->force};
}

static bool names_force(const MechanismScene& s, Vec2 foot) {
    return s.at.labelled() && s.at.shows(foot) && s.at.labels->force;
}

LabelPlace force_place(const MechanismScene& s) {
    LabelPlace label = *s.at.labels->force;
    if (s.arrow && !label.pinned.empty())
        label.offset = label.pinned[static_cast<std::size_t>(s.frame)] - s.px(s.arrow->foot);
    return label;
}

static Vec2 tip_of(const MechanismView& at, const Perspective* view, const ForceArrow& arrow) {
    return at.seen(at.px(arrow.foot) + Vec2{arrow.normal.x, -arrow.normal.y} * arrow_length(at, arrow), view);
}

Vec2 visible_end(const MechanismView& at, const Perspective* view, const ForceArrow& arrow) {
    const Vec2 tip = tip_of(at, view, arrow);
    return at.shows(tip) ? tip : at.seen(at.px(arrow.foot), view);
}

void draw_force_leader(const MechanismScene& s) {
    if (!s.arrow || !names_force(s, s.px(s.arrow->foot))) return;
    draw_leader(s, force_place(s), s.at.palette.contact, visible_end(s.at, s.view, *s.arrow), s.arrow->foot);
}

void draw_force(const MechanismScene& s) {
    if (!s.arrow) return;
    const ForceArrow& arrow = *s.arrow;
    const Vec2 foot = s.px(arrow.foot), tip = tip_of(s.at, s.view, arrow);
    s.canvas.circle(foot, 5 * s.at.marks);
    s.canvas.fill(s.at.palette.contact);
    // A force too small for an arrow is shown by the dot and the number.
    const double length = arrow_length(s.at, arrow);
    if (length > 7 * s.at.marks)
        s.canvas.arrow(foot, tip, {s.at.palette.contact, 4 * s.at.marks}, {std::min(19 * s.at.marks, 0.7 * length)});
    if (names_force(s, foot)) draw_label(s, force_place(s), force_label(s.at, arrow), force_style(s.at), arrow.foot);
}

}  // namespace beamcam::render
