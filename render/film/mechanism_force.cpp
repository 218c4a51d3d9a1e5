// The arrow of the contact force, its label, and the leader line between them.
#include <algorithm>
#include <string>

#include "render/film/label_visibility.hpp"
#include "render/film/mechanism_marks.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

constexpr double kSameEpisode = 0.5;         // longest time without a force during which its label keeps its place [s]
constexpr std::size_t kMeasuredPushes = 60;  // number of forces whose texts are measured to find the widest label
// Beyond it a line that follows the arrow would sweep the picture [design px].
constexpr double kFarthestArrow = 320;
constexpr double kPast = 0.4;                    // share of the colour that the arrow of a peak has after its contact
constexpr double kSample = 44, kSampleGap = 12;  // length of a sample, and its distance from the text [design px]

}  // namespace

std::string force_label(const MechanismView& at, const ForceArrow& arrow) {
    const std::string peak_of = arrow.is_peak ? at.context.translate("peak") + "\u00A0" : std::string();
    return peak_of + "$F$\u2009=\u2009" + reading(arrow.force, "N");
}

// In proportion to the force, peaks that are held included.
double arrow_length(const MechanismView& at, const ForceArrow& arrow) {
    return force_arrow_length(std::min(1.0, arrow.force / at.context.arrow_scale), at.small, at.marks);
}

TextStyle force_style(const MechanismView& at) {
    return {.size = 22.0 / 21 * label_size(at), .color = at.palette.contact, .weight = Weight::medium};
}

std::optional<ForceArrow> force_arrow_of(const sim::Pose& pose, const DrawnBeam& beam,
                                         const std::optional<ForceArrow>& peak) {
    if (peak || !shows_force(pose, beam)) return peak;
    return ForceArrow{beam.contact->on_disc, beam.contact->normal, pose.nearest->force};
}

// ---- the place of the label --------------------------------------------------------------------

// Beside the tip of the arrow, beyond the beam.
static Box beside_tip(const MechanismView& at, const Perspective* view, const ForceArrow& arrow, Vec2 size) {
    const double u = at.unit,
                 length = force_label_distance(arrow_length(at, arrow), at.look.depth * at.look.camera.scale, u);
    const Vec2 n{arrow.normal.x, -arrow.normal.y}, tip = at.seen(at.px(arrow.foot) + n * length, view);
    const bool right = n.x > 0.5;  // on its left is the beam
    return {tip.x + (right ? 14 * u : -14 * u - size.x), tip.y - size.y / 2, size.x, size.y};
}

// Of each frame with a force, the largest one of its contact [N].
static std::vector<double> largest_of_episodes(const LabelNeeds& needs, double most_apart) {
    std::vector<double> out(needs.arrows.size());
    for (std::size_t first = 0, end; first < needs.arrows.size(); first = end) {
        end = first + 1;
        while (end < needs.arrows.size() && needs.frames[end] - needs.frames[end - 1] <= most_apart) ++end;
        const auto begin = needs.arrows.begin();
        const double most =
            std::ranges::max_element(begin + std::ptrdiff_t(first), begin + std::ptrdiff_t(end), {}, &ForceArrow::force)
                ->force;
        std::fill(out.begin() + std::ptrdiff_t(first), out.begin() + std::ptrdiff_t(end), most);
    }
    return out;
}

// The end of a leader line from this box: of foot and tip the nearer one, so that the line crosses no arrow.
static Vec2 leader_end(const MechanismView& at, const Perspective* view, const Box& label, const ForceArrow& arrow) {
    const Vec2 foot = at.seen(at.px(arrow.foot), view), tip = arrow_tip(at, view, arrow), middle = label.centre();
    return norm(tip - middle) <= norm(foot - middle) ? tip : foot;
}

// The largest distance of an arrow from the label at its usual place [px].
static double farthest_arrow(const MechanismView& at, const Perspective* view, const LabelPlace& label,
                             const LabelNeeds& needs) {
    const Box box = at.label_box(label, view);
    double out = 0;
    for (const ForceArrow& arrow : needs.arrows) {
        const Vec2 end = leader_end(at, view, box, arrow);
        out = std::max(out, norm(end - box.nearest(end)));
    }
    return out;
}

static std::vector<Box> along(const SeenFrame& now, const ForceArrow& arrow) {
    constexpr int kPieces = 16;
    const Vec2 foot = now.at.seen(now.at.px(arrow.foot), now.by()), way = arrow_tip(now.at, now.by(), arrow) - foot;
    std::vector<Box> out;
    for (int i = 0; i <= kPieces; ++i) {
        const Vec2 on = foot + way * (static_cast<double>(i) / kPieces);
        out.push_back(Box{on.x, on.y, 0, 0}.inset(-8 * now.at.marks));
    }
    return out;
}

// Before a moving camera the label is beside the tip of the largest arrow of its contact.
static void keep_beside_tip(LabelPlace& label, const MechanismCameras& cameras, const LabelNeeds& needs, double fps) {
    const std::vector<double> largest = largest_of_episodes(needs, kSameEpisode * fps);
    shift_clear(label, cameras, [&](const SeenFrame& now) -> std::optional<WantedPlace> {
        const auto found = std::ranges::lower_bound(needs.frames, now.frame);
        if (found == needs.frames.end() || *found != now.frame) return std::nullopt;
        const auto i = static_cast<std::size_t>(found - needs.frames.begin());
        ForceArrow arrow = needs.arrows[i];
        const Vec2 foot = now.at.seen(now.at.px(arrow.foot), now.by());
        if (!now.at.shows(foot)) return std::nullopt;
        const std::vector<Box> drawn = along(now, arrow);
        arrow.force = largest[i];
        return WantedPlace{foot, beside_tip(now.at, now.by(), arrow, label.size), drawn};
    });
}

// Beside the tip of the longest arrow, clear of the beam.
LabelPlace place_force_label(const MechanismView& at, const MechanismCameras& cameras, const LabelNeeds& needs,
                             const OccupancyGrid& room, Canvas& canvas) {
    const ForceArrow& most = *std::ranges::max_element(needs.arrows, {}, &ForceArrow::force);
    double width = 0;
    const auto measure = [&](const ForceArrow& arrow) {
        width = std::max(width, canvas.measure(force_label(at, arrow), force_style(at)).w);
    };
    measure(most);
    const std::size_t step = 1 + needs.arrows.size() / kMeasuredPushes;
    for (std::size_t i = 0; i < needs.arrows.size(); i += step) measure(needs.arrows[i]);
    const std::optional<Perspective> usual = cameras.usual();
    const Perspective* view = usual ? &*usual : nullptr;
    const auto place = [&](double wide) {
        const Vec2 size{wide, label_size(at) * 4 / 3};
        return placed_near(at, view, room, beside_tip(at, view, most, size), at.px(most.foot));
    };
    LabelPlace out = place(width);
    if (!cameras.near() && farthest_arrow(at, view, out, needs) > kFarthestArrow * at.unit)
        out = place(width + (kSample + kSampleGap) * at.unit), out.has_sample = true;
    if (cameras.near())
        keep_beside_tip(out, cameras, needs, at.context.setup->fps);
    else
        fade_where_met(out, cameras, room);
    return out;
}

// ---- drawing -----------------------------------------------------------------------------------

static bool names_force(const MechanismScene& s) { return s.at.labelled() && s.at.labels->force; }

Vec2 arrow_tip(const MechanismView& at, const Perspective* view, const ForceArrow& arrow) {
    const auto end = [&](double share) {
        return at.seen(at.px(arrow.foot) + Vec2{arrow.normal.x, -arrow.normal.y} * (share * arrow_length(at, arrow)),
                       view);
    };
    const Box inside = at.box.inset(4 * at.unit);
    const auto leaves = [&](Vec2 p) { return at.moved && !inside.contains({p.x, p.y, 0, 0}); };
    if (!leaves(end(1)) || leaves(end(0))) return end(1);
    double fits = 0, too_long = 1;
    while (too_long - fits > 1e-3) {
        const double share = (fits + too_long) / 2;
        if (leaves(end(share)))
            too_long = share;
        else
            fits = share;
    }
    return end(fits);
}

void draw_force_leader(const MechanismScene& s) {
    if (!s.arrow || !names_force(s)) return;
    const LabelPlace& label = *s.at.labels->force;
    if (label.has_sample) return;
    Box text = s.label_box(label, s.arrow->foot);  // has room for the widest number
    text.w = std::min(text.w, s.canvas.measure(force_label(s.at, *s.arrow), force_style(s.at)).w);
    draw_leader(s, label, text, s.at.palette.contact, leader_end(s.at, s.view, text, *s.arrow),
                {kFarLabel, kFarthestArrow});
}

static void draw_arrow(Canvas& canvas, Vec2 foot, Vec2 tip, double length, Color color, double marks) {
    canvas.circle(foot, 5 * marks);
    canvas.fill(color);
    // A force too small for an arrow is shown by the dot and the number.
    if (length > 7 * marks) canvas.arrow(foot, tip, {color, 4 * marks}, {std::min(19 * marks, 0.7 * length)});
}

void draw_force(const MechanismScene& s) {
    if (!s.arrow) return;
    const ForceArrow& arrow = *s.arrow;
    const Vec2 foot = s.px(arrow.foot), tip = arrow_tip(s.at, s.view, arrow);
    const double length = s.at.moved ? norm(tip - foot) : arrow_length(s.at, arrow);
    const bool past = arrow.is_peak && !(s.pose.nearest && s.pose.nearest->force > 0);
    const Color color = past ? s.at.palette.tint(s.at.palette.contact, kPast) : s.at.palette.contact;
    draw_arrow(s.canvas, foot, tip, length, color, s.at.marks);
    if (!names_force(s)) return;
    const LabelPlace& label = *s.at.labels->force;
    const double u = s.at.unit, sample = label.has_sample ? kSample * u : 0;
    if (const double opacity = label.opacity_at(s.frame); label.has_sample && opacity > 0) {
        const Box box = s.label_box(label, arrow.foot);
        const Vec2 from{box.x + 5 * s.at.marks, box.centre().y};
        draw_arrow(s.canvas, from, {box.x + sample, from.y}, sample, color.faded(opacity), s.at.marks);
    }
    draw_label(s, label, force_label(s.at, arrow), force_style(s.at), arrow.foot,
               sample > 0 ? sample + kSampleGap * u : 0);
}

}  // namespace beamcam::render
