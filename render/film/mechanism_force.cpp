// The arrow of the contact force, its label, and the leader line between them.
#include <algorithm>
#include <string>

#include "render/film/mechanism_marks.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {

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

static bool names_force(const MechanismScene& s, Vec2 foot) {
    return s.at.labelled() && s.at.shows(foot) && s.at.labels->force;
}

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
    if (!s.arrow || !names_force(s, s.px(s.arrow->foot))) return;
    draw_leader(s, *s.at.labels->force, s.at.palette.contact, arrow_tip(s.at, s.view, *s.arrow), s.arrow->foot);
}

void draw_force(const MechanismScene& s) {
    if (!s.arrow) return;
    const ForceArrow& arrow = *s.arrow;
    const Vec2 foot = s.px(arrow.foot), tip = arrow_tip(s.at, s.view, arrow);
    s.canvas.circle(foot, 5 * s.at.marks);
    s.canvas.fill(s.at.palette.contact);
    // A force too small for an arrow is shown by the dot and the number.
    const double length = s.at.moved ? norm(tip - foot) : arrow_length(s.at, arrow);
    if (length > 7 * s.at.marks)
        s.canvas.arrow(foot, tip, {s.at.palette.contact, 4 * s.at.marks}, {std::min(19 * s.at.marks, 0.7 * length)});
    if (names_force(s, foot))
        draw_label(s, *s.at.labels->force, force_label(s.at, arrow), force_style(s.at), arrow.foot);
}

}  // namespace beamcam::render
