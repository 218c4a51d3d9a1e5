#include "render/film/mechanism_marks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr double kFarLetter = 26;  // distance from which θ has a leader line [design px]
constexpr double kFadeIn = 0.2;    // a leader line fades in over this share of its least length

}  // namespace

void draw_leader(const MechanismScene& s, const LabelPlace& label, const Box& text, Color color, Vec2 owner,
                 Range lengths) {
    const Vec2 edge = text.nearest(owner);
    const double way = norm(owner - edge) / s.at.unit;
    const double opacity = label.opacity_at(s.frame) * std::min(1.0, (way / lengths.low - 1) / kFadeIn);
    if (opacity <= 0 || way > lengths.high) return;
    const Vec2 gap = (owner - edge) * (6 / way);
    s.canvas.line(edge + gap, owner - gap, {color.faded(0.6 * opacity), 1.2 * s.at.unit});
}

void draw_label(const MechanismScene& s, const LabelPlace& label, const std::string& text, TextStyle style, Vec2 base,
                double indent) {
    const double opacity = label.opacity_at(s.frame);
    const Box box = s.label_box(label, base);
    if (opacity <= 0) return;
    style.color = style.color.faded(opacity);
    // In the solid view a halo over soft shadows would glow; a near camera needs it.
    if (!s.view || s.at.moved) style.halo = s.at.palette.paper.faded(opacity);
    const double left = style.align == HAlign::centre ? box.centre().x : box.x;
    s.canvas.text({left + indent, box.centre().y + 0.32 * style.size}, text, style);
    if (s.labels) s.labels->push_back(box);
}

std::string speed_label(const MechanismView& at) {
    return "$ω$\u2009=\u2009" + turning_speed(at.problem().cam->speed, at.context.setup->units.speed);
}

double speed_radius(const MechanismView& at) {
    const sim::Cam& cam = *at.problem().cam;
    return (cam.radius + cam.eccentricity) * at.look.camera.scale + speed_gap(at);
}

double speed_gap(const MechanismView& at) { return 20 * at.unit; }

double speed_span(const MechanismView& at) { return std::min(0.8, 150 * at.unit / speed_radius(at)); }

double drawn_angle(const sim::Pose& pose) { return std::fmod(pose.theta, 2 * pi); }

std::vector<Vec2> angle_arc(const MechanismView& at, double radius, const sim::Pose& pose) {
    constexpr int kPieces = 32;
    std::vector<Vec2> out;
    for (int i = 0; i <= kPieces; ++i)
        out.push_back(at.px({0, 0}) + down(drawn_angle(pose) * i / kPieces) * (radius * at.zoom()));
    return out;
}

std::vector<Vec2> angle_base(const MechanismView& at, double radius) {
    const Vec2 start = at.px({0, 0}) + Vec2{radius * at.zoom(), 0};
    return {start - Vec2{12 * at.unit, 0}, start + Vec2{26 * at.unit, 0}};
}

std::vector<Color> rim_colors(const MechanismView& at, const Trace& trace) {
    std::vector<Color> out(trace.rim().size(), Color{0, 0, 0, 0});
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!(trace.rim()[i] > 0) || !(at.context.force_scale > 0)) continue;
        out[i] = force_color(at.palette, std::sqrt(std::min(1.0, double(trace.rim()[i]) / at.context.force_scale)));
    }
    return out;
}

// End of the arc of θ: in the solid view, where it is drawn over the beam, at the edge of that [rad].
static double visible_angle(const MechanismScene& s, double radius) {
    const double angle = drawn_angle(s.pose);
    if (!s.view) return angle;
    const double edge = (angle > 0 ? -s.beam.low : s.beam.high) * s.at.look.camera.scale;
    const double hidden = std::asin(std::clamp(edge / radius, 0.0, 1.0));
    return angle > 0 ? std::max(0.0, angle - hidden) : std::min(0.0, angle + hidden);
}

// A line [px] crosses the arc of θ.
static bool crosses_angle_arc(const MechanismScene& s, Vec2 from, Vec2 to) {
    const auto apart = [](Vec2 a, Vec2 b, Vec2 p, Vec2 q) { return cross(b - a, p - a) * cross(b - a, q - a) > 0; };
    const std::vector<Vec2> arc = angle_arc(s.at, s.at.labels->arc_radius, s.pose);
    for (std::size_t i = 0; i + 1 < arc.size(); ++i) {
        const Vec2 a = s.on(arc[i]), b = s.on(arc[i + 1]);
        if (!apart(a, b, from, to) && !apart(from, to, a, b)) return true;
    }
    return false;
}

// The angle has a place: outside the hub.
static bool shows_angle(const MechanismView& at, double radius) {
    return at.labelled() && radius * at.zoom() >= at.hub() + 22 * at.marks;
}

bool shows_angle_arc(const MechanismView& at, double radius, const sim::Pose& pose) {
    return shows_angle(at, radius) && std::abs(drawn_angle(pose)) >= kLeastArc;
}

void draw_angle_arc(const MechanismScene& s) {
    if (!shows_angle(s.at, s.at.labels->arc_radius)) return;
    const double radius = s.at.labels->arc_radius * s.at.zoom(), angle = drawn_angle(s.pose);
    const Vec2 o = s.at.px({0, 0});
    if (std::abs(angle) >= kLeastArc) {
        if (s.view) {
            const std::vector<Vec2> base = angle_base(s.at, s.at.labels->arc_radius);
            s.canvas.line(s.on(base[0]), s.on(base[1]), {s.at.palette.muted, 1.6 * s.at.unit, {}, Cap::butt});
        }
        s.arc(o, radius, 0, visible_angle(s, radius));
        s.canvas.stroke({s.at.palette.muted, 1.6 * s.at.unit, {}, Cap::butt});
    }
    if (!s.at.labels->angle) return;
    // A letter outside the sector of the angle gets a leader line to the start of the arc.
    const LabelPlace& label = *s.at.labels->angle;
    const Vec2 letter = s.at.px(label.base) + label.offset * s.at.zoom() - o;
    const double sense = angle < 0 ? -1 : 1, way = std::atan2(-letter.y, letter.x) * sense;
    const double turned = way < 0 ? way + 2 * pi : way;
    const double foot = turned <= std::max(std::abs(angle), pi / 2) ? turned * sense : 0;
    Vec2 owner = s.on(o + down(foot) * radius);
    const Box text = s.label_box(label, label.base);
    if (s.at.moved) {
        const Vec2 middle = text.centre();
        const std::vector<Vec2> arc = angle_arc(s.at, s.at.labels->arc_radius, s.pose);
        owner = s.on(*std::ranges::min_element(arc, {}, [&](Vec2 p) { return norm(s.on(p) - middle); }));
    }
    draw_leader(s, label, text, s.at.palette.muted, owner, {kFarLetter, kLongestLeader});
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
    const Vec2 arrow = s.on(axis + down(middle) * radius);
    const Box text = s.label_box(label, label.base);
    if (!crosses_angle_arc(s, arrow, text.centre())) draw_leader(s, label, text, s.at.palette.muted, arrow);
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
    // On a small disc they keep a readable size; before a near camera they grow with it to their usual size.
    const double marks = std::min(s.at.unit, s.at.marks * s.at.zoom());
    const double size = std::max(22 * marks, std::min(least_letter(s.at), 0.5 * d.radius)), letter = size / 22;
    if (size < kReadable || d.radius < 60 * marks || !s.at.context.setup->view.show.labels) return;
    const double apart = norm(d.centre - d.axis);
    const Vec2 along = apart > 2 ? (d.centre - d.axis) * (1 / apart) : Vec2{0, -1}, across{along.y, -along.x};
    TextStyle style{.size = size, .color = ink, .align = HAlign::centre};
    // A halo covers the outlines of other discs; it must not cover the pin.
    if (s.at.ghosts) style.halo = s.at.palette.steel;
    const auto put = [&](const char* name, Vec2 at) {
        const Vec2 middle = s.at.seen(at, s.view, kDiscDepth);
        if (s.at.moved && !s.at.box.inset(12 * letter).contains({middle.x, middle.y, 0, 0}))
            return;  // cut off by the edge of the panel
        s.canvas.text(middle + Vec2{0, 7 * letter}, name, style);
    };
    const double dot = s.view ? std::max(d.dot, 4 * marks) : 4 * marks;
    const double beyond = dot + (s.at.ghosts ? 21 : 16) * letter;
    if (beyond + 13 * letter > norm(d.mark - d.centre) - d.mark_radius) {  // B would touch the mark
        put("$B$", d.centre - across * (13 * letter));
        put("$C$", d.axis + across * (d.bore + 12 * letter));
        return;
    }
    put("$B$", d.centre + along * beyond);
    // The shaft in the solid view needs more space. If C would come near the rim, where contacts and their rings are,
    // it goes to the side.
    const double off = d.bore + (s.view ? 24 : 16) * letter;
    put("$C$", d.axis + (apart + off + 24 * marks <= d.radius ? along * -1 : along * 0.6 + across * 0.8) * off);
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
    stroke_places(s.canvas, s.at.context, trace.rim(), width, place);
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

}  // namespace beamcam::render
