#include "render/film/mechanism_marks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/plot/ticks.hpp"

namespace beamcam::render {

// The base line has its name where it is above a beam that bends visibly, in stills and in slow motion, which give time
// to read it.
static void name_base_line(const MechanismScene& s, const std::vector<Vec2>& line) {
    constexpr double kSlow = 0.1;  // of real time
    const FilmSetup& setup = *s.at.context.setup;
    const bool slow = setup.speeds.empty() ? setup.frames() == 1 : setup.speeds[std::size_t(s.frame)] <= kSlow;
    if (!slow || !s.at.labelled() || s.at.ghosts) return;
    const double size = s.at.context.look.letters.words;
    const Box inside = s.at.box.inset(1.6 * size + s.at.fade());
    std::size_t last = line.size();  // the point nearest to the tip that is drawn and in the view
    for (std::size_t i = 0; i < line.size(); ++i)
        if (!std::isnan(line[i].x) && inside.contains({line[i].x, line[i].y, 0, 0})) last = i;
    if (last == line.size()) return;
    // Above a line that rises from the hub or below one that falls, and towards the hub; where the beam is there, on
    // the other side and away from the hub, if that is in the view.
    const auto [upper, lower] = std::minmax({s.px(s.beam.back(last)).y, s.px(s.beam.face(last)).y});
    const Vec2 o = s.at.px({0, 0});
    const bool above = line[last].y < o.y, leftward = line[last].x < o.x;
    const bool free = above ? upper >= line[last].y + 0.2 * size : lower <= line[last].y - 0.2 * size;
    const bool rightward = leftward == free;  // the text begins at the line
    const TextStyle style{.size = size, .color = s.at.palette.muted, .align = rightward ? HAlign::left : HAlign::right};
    const std::string word = s.at.context.look.translate("undeflected");
    const Vec2 at = line[last] + Vec2{(rightward ? 0.4 : -0.4) * size, (above == free ? -0.5 : 1.2) * size};
    const double end = at.x + (rightward ? 1 : -1) * s.canvas.measure(word, style).w;
    if (free || (end > s.at.box.x && end < s.at.box.right())) s.canvas.text(at, word, style);
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
    name_base_line(s, line);
}

static bool is_flat(const MechanismScene& s) { return s.at.context.setup->view.style == Style::flat; }

Color ink_on_disc(const MechanismScene& s) {
    if (!is_flat(s)) return rgb(0xF4F6F9);
    return s.at.context.setup->view.theme == Theme::dark ? s.at.palette.paper : s.at.palette.steel_edge;
}

// On the front of the disc.
void draw_disc_marks(const MechanismScene& s, const Trace& trace) {
    const DiscShape& d = *s.shape.disc;
    const double inset = std::min(7 * s.at.unit, 0.1 * d.radius), n = static_cast<double>(trace.rim().size());
    stroke_places(s.canvas, s.at.context, trace.rim(), inset, [&](std::size_t i) {
        const double share = (static_cast<double>(i) + 0.5) / n, wide = 1.7 / n;
        s.canvas.move_to(s.on_disc(d.rim(share - wide, inset)));
        s.canvas.line_to(s.on_disc(d.rim(share, inset)));
        s.canvas.line_to(s.on_disc(d.rim(share + wide, inset)));
    });
    if (d.radius < 26 * s.at.marks) return;
    const Color ink = ink_on_disc(s);
    const double apart = norm(d.centre - d.axis), pen = std::max(s.at.marks, 0.45);
    if (apart > d.bore + 2)
        s.canvas.line(s.on_disc(d.axis + (d.centre - d.axis) * (d.bore / apart)), s.on_disc(d.centre),
                      {ink, 1.8 * pen});
    if (d.outline.empty()) {
        s.canvas.circle(s.on_disc(d.centre), 4 * s.at.marks);
        s.canvas.fill(ink);
    }
    if (!is_flat(s)) return;                     // there the axis has a bearing
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
