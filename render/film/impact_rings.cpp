#include "render/film/impact_rings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>
#include <set>

namespace beamcam::render {
namespace {

constexpr double kRing = 0.4;             // lifetime of a ring [s]
constexpr std::ptrdiff_t kMostRings = 6;  // at once

struct ShownImpact {
    int frame = 0;       // the first frame that shows it
    bool brief = false;  // it is shorter than two frames
};

std::vector<double> frame_times(const FilmContext& context, int member) {
    std::vector<double> out;
    for (int k = 0; k < context.frames(); ++k) out.push_back(context.at(member, k));
    return out;
}

// None of an impact before the first frame or after the last one.
std::optional<ShownImpact> shown_impact(const std::vector<double>& times, const sim::Impact& impact) {
    const auto first = std::lower_bound(times.begin(), times.end(), impact.t_start);
    if (first == times.end() || (first == times.begin() && *first > impact.t_start)) return std::nullopt;
    const auto after = std::upper_bound(first, times.end(), impact.t_end.value_or(times.back()));
    return ShownImpact{static_cast<int>(first - times.begin()), times.size() > 1 && after - first < 2};
}

}  // namespace

double largest_held_peak(const FilmContext& context, const PanelSlot& slot) {
    if (slot.spec.kind != PanelKind::mechanism || is_small(slot.box, context.unit)) return 0;
    if (!context.setup->view.show.labels) return 0;
    const int member = std::min(slot.spec.member, context.members() - 1);
    const std::vector<double> times = frame_times(context, member);
    std::map<int, double> strongest;  // contact of each collision
    std::set<int> held;               // collisions
    for (const sim::Impact& impact : context.motion(member).impacts) {
        const auto shown = shown_impact(times, impact);
        if (!shown) continue;
        double& force = strongest[impact.collision];
        force = std::max(force, impact.force_peak.value_or(0));
        if (shown->brief) held.insert(impact.collision);
    }
    double out = 0;
    for (const int collision : held) out = std::max(out, strongest[collision]);
    return out;
}

void ImpactRings::find(const MechanismView& at) {
    frames_ = kRing * at.context.setup->fps;
    labelled_ = at.labelled();
    radius_ = at.problem().cam ? at.problem().cam->radius : 0;
    const std::vector<double> times = frame_times(at.context, at.member);
    for (const sim::Impact& impact : at.motion().impacts) {
        const auto shown = shown_impact(times, impact);
        if (!shown) continue;
        const sim::Pose pose = at.context.pose(at.member, shown->frame);
        const DrawnBeam b = at.drawn(at.member, pose);
        if (!b.contact) continue;
        const Vec2 n = b.contact->normal;
        rings_.push_back({shown->frame,
                          std::atan2(n.y, n.x) - pose.cam_angle,
                          {b.contact->on_disc, n, impact.force_peak.value_or(0), true},
                          shown->brief,
                          impact.collision});
    }
}

bool ImpactRings::change(int frame) const {
    return std::ranges::any_of(rings_, [&](const Ring& r) {
        return frame >= r.frame && frame < r.frame + frames_ + 1;  // including the frame without it
    });
}

// Rings move with the disc.
void ImpactRings::draw(const MechanismScene& s) const {
    if (!s.at.problem().cam) return;
    const auto later = std::ranges::upper_bound(rings_, s.frame, {}, &Ring::frame);
    for (const Ring& r : std::ranges::subrange(later - std::min(kMostRings, later - rings_.begin()), later)) {
        const double share = (s.frame - r.frame) / frames_;
        if (share >= 1) continue;
        const Vec2 at =
            s.px(s.pose.disc_centre + sim::unit(s.pose.cam_angle + r.material_angle) * s.at.problem().cam->radius);
        s.canvas.circle(at, (7 + 20 * std::sqrt(share)) * s.at.marks);
        s.canvas.stroke(
            {s.at.palette.contact.faded((1 - share) * (1 - share)), (3.2 - 2 * share) * std::max(s.at.marks, 0.45)});
    }
}

// Of the collision's contacts so far. A longer contact shows its own force.
std::optional<ForceArrow> ImpactRings::peak(int frame, const sim::Pose& pose) const {
    if (!labelled_) return std::nullopt;
    const Ring* latest = nullptr;
    for (const Ring& r : rings_)
        if (frame >= r.frame && frame < r.frame + frames_ && (!latest || r.frame >= latest->frame || !r.brief))
            latest = &r;
    if (!latest || !latest->brief) return std::nullopt;
    const ForceArrow* most = &latest->peak;
    for (const Ring& r : rings_)
        if (r.frame <= frame && r.collision == latest->collision && r.peak.force > most->force) most = &r.peak;
    if (!(most->force > 0)) return std::nullopt;
    ForceArrow out = *most;
    out.foot = pose.disc_centre + out.normal * radius_;
    return out;
}

}  // namespace beamcam::render
