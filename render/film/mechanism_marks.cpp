#include "render/film/mechanism_marks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/plot/ticks.hpp"

namespace beamcam::render {

// The box meets the beam, or the circle that the cam sweeps.
static bool meets_body(const MechanismScene& s, const Box& box) {
    const auto inside = [&](const Vec2& p) { return box.contains({s.on(p).x, s.on(p).y, 0, 0}); };
    if (std::ranges::any_of(s.shape.face, inside) || std::ranges::any_of(s.shape.back, inside)) return true;
    if (!s.shape.disc) return false;
    const Vec2 centre = s.on(s.shape.disc->centre),
               nearest{std::clamp(centre.x, box.x, box.right()), std::clamp(centre.y, box.y, box.bottom())};
    return norm(nearest - centre) < s.shape.disc->radius;
}

// Where the name of the line has room in the view: at its end or closer to the hub, on the side of `away` and towards
// the hub, where the trail of the tip is not; nowhere if it would meet beam or cam.
static std::optional<Box> box_of_name(const MechanismScene& s, const std::vector<Vec2>& line, Vec2 away, Vec2 size) {
    const Box inside = s.at.box.inset(s.at.fade());
    for (std::size_t i = line.size(); i-- > 0 && !std::isnan(line[i].x);) {
        const Vec2 corner = line[i] + away * (0.6 * size.y);
        const Box box{away.x < 0 ? corner.x - size.x : corner.x, away.y < 0 ? corner.y - size.y : corner.y, size.x,
                      size.y};
        if (inside.contains(box)) return meets_body(s, box) ? std::nullopt : std::optional(box);
    }
    return std::nullopt;
}

// The straight beam at the angle of the hub, where the tip of the drawn beam is visibly elsewhere. In stills and in
// films of one motion that vibrates slowly, which give time to read it, the line has its name where there is room, and
// on the side away from θ. The horizontal is a line of its own, and compared motions have lines of their own.
void draw_undeflected(const MechanismScene& s) {
    constexpr double kApart = 8, kSlow = 0.4;  // [design px]; a period of the first vibration [s of the film]
    if (!s.at.labelled() || s.at.ghosts) return;
    const Vec2 along = sim::unit(s.pose.theta), tip = s.px(along * norm(s.beam.line.back()));
    const Vec2 apart = tip - s.px(s.beam.line.back());
    if (norm(apart) < kApart * s.at.unit || std::abs(along.y) < 0.01) return;
    const double clear = 4 * s.at.unit / s.at.look.camera.scale;
    constexpr double kGap = std::numeric_limits<double>::quiet_NaN();  // interrupts the line
    std::vector<Vec2> line;  // only outside the section: dashes along its edge would be confusing
    for (Vec2 p : s.beam.line) {
        const double below = -cross(along, p);  // the straight line's offset from the centre line
        const bool covered = below > s.beam.low - clear && below < s.beam.high + clear;
        line.push_back(covered ? Vec2{kGap, kGap} : s.px(along * dot(along, p)));
    }
    if (std::isnan(line.back().x)) return;
    const FilmSetup& setup = *s.at.context.setup;
    const double speed = setup.frames() == 1 ? 0 : setup.speeds.empty() ? 1 : setup.speeds[std::size_t(s.frame)];
    const bool slow = kSlow * speed <= s.at.context.scales.period;
    if (slow && s.at.context.members() == 1 && apart.y * along.y < 0) {
        const TextStyle style{.size = s.at.context.look.letters.words, .color = s.at.palette.muted};
        const std::string word = s.at.context.look.translate("undeflected");
        if (const auto box =
                box_of_name(s, line, apart * (1 / norm(apart)), {s.canvas.measure(word, style).w, style.size}))
            s.canvas.text({box->x, box->bottom() - 0.2 * style.size}, word, style);
    }
    s.canvas.clip(s.at.box, [&] {  // the line may extend beyond the extent of the camera
        s.canvas.polyline(line);
        s.canvas.stroke({s.at.palette.faint, 1.5 * s.at.unit, {6 * s.at.unit, 7 * s.at.unit}, Cap::butt});
    });
}

static bool is_flat(const MechanismScene& s) { return s.at.context.setup->view.style == Style::flat; }

Color ink_on_disc(const MechanismScene& s) {
    if (!is_flat(s)) return rgb(0xF4F6F9);
    return s.at.context.setup->view.theme == Theme::dark ? s.at.palette.paper : s.at.palette.steel_edge;
}

// On the front of the disc.
void draw_disc_marks(const MechanismScene& s, const Trace& trace) {
    const DiscShape& d = *s.shape.disc;
    const double inset = std::min({7 * s.at.unit, 0.1 * d.radius, 0.5 * d.sharpest}),
                 n = static_cast<double>(trace.rim.size());
    const auto piece = [&](std::size_t i) {
        const double share = (static_cast<double>(i) + 0.5) / n, wide = 1.7 / n;
        s.canvas.move_to(s.on_disc(d.rim(share - wide, inset)));
        s.canvas.line_to(s.on_disc(d.rim(share, inset)));
        s.canvas.line_to(s.on_disc(d.rim(share + wide, inset)));
    };
    stroke_places(s.canvas, s.at.context, trace.rim, inset, piece,
                  [&](double share) { return force_color(s.at.palette, share); });
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
    const double n = static_cast<double>(trace.beam.size()), last = static_cast<double>(s.beam.line.size() - 1);
    const double inset = 4.5 * s.at.unit;
    const auto at = [&](double place) {
        const double station = std::clamp(place / n * last, 0.0, last);
        const auto i = std::min(static_cast<std::size_t>(station), s.beam.line.size() - 2);
        const double part = station - static_cast<double>(i);
        const Vec2 face = s.px(s.beam.face(i) * (1 - part) + s.beam.face(i + 1) * part),
                   back = s.px(s.beam.back(i) * (1 - part) + s.beam.back(i + 1) * part);
        return face + (back - face) * (inset / norm(back - face));
    };
    const auto piece = [&](std::size_t i) {
        s.canvas.move_to(at(static_cast<double>(i) - 1.2));
        s.canvas.line_to(at(static_cast<double>(i) + 2.2));
    };
    // Not in a colour of the moment.
    const Palette& p = s.at.palette;
    const Color ink = contrast(p.ink, p.moment[2]) > contrast(p.paper, p.moment[2]) ? p.ink : p.paper;
    stroke_places(s.canvas, s.at.context, trace.beam, 5 * s.at.unit, piece,
                  [&](double share) { return ink.faded(0.3 + 0.6 * share); });
}

}  // namespace beamcam::render
