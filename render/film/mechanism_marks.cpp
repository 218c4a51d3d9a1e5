#include "render/film/mechanism_marks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;

}  // namespace

std::vector<Color> rim_colors(const MechanismView& at, const Trace& trace) {
    std::vector<Color> out(trace.rim().size(), Color{0, 0, 0, 0});
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!(trace.rim()[i] > 0) || !(at.context.force_scale > 0)) continue;
        out[i] = force_color(at.palette, std::sqrt(std::min(1.0, double(trace.rim()[i]) / at.context.force_scale)));
    }
    return out;
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

// Smallest size of single letters on a disc, which are recognized more easily than numbers [px].
static double least_letter(const MechanismView& at) {
    constexpr double kOfTicks = 0.75;
    return std::max(kReadable, kOfTicks * at.context.tick);
}

// B and C are beyond the ends of the line between them or, on a small disc, on its two sides, and inside the disc.
void draw_disc_letters(const MechanismScene& s) {
    if (!s.shape.disc || !s.shape.disc->outline.empty()) return;
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
        const double share = (static_cast<double>(i) + 0.5) / n, wide = 1.7 / n;
        if (!d.outline.empty()) {
            s.canvas.move_to(d.rim(share - wide, inset));
            s.canvas.line_to(d.rim(share, inset));
            s.canvas.line_to(d.rim(share + wide, inset));
            return;
        }
        const double at = d.angle + 2 * pi * share, half = 2 * pi * wide;
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
    if (d.outline.empty()) {
        s.canvas.circle(d.centre, 4 * s.at.marks);
        s.canvas.fill(ink);
    }
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
