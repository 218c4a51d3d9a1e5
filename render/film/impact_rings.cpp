#include "render/film/impact_rings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

namespace beamcam::render {
namespace {

constexpr double kRing = 0.4;             // lifetime of a ring, freezes not counted [s]
constexpr std::ptrdiff_t kMostRings = 6;  // at once

struct ShownImpact {
    const sim::Impact& impact;
    int frame = 0;       // the first frame that shows it
    bool brief = false;  // it is shorter than two frames
};

// Without those before the first frame and after the last one.
std::vector<ShownImpact> shown_impacts(const Motion& motion, const std::vector<double>& times) {
    std::vector<ShownImpact> out;
    for (const sim::Impact& impact : motion.impacts) {
        const auto first = std::lower_bound(times.begin(), times.end(), impact.t_start);
        if (first == times.end() || (first == times.begin() && *first > impact.t_start)) continue;
        const auto after = std::upper_bound(first, times.end(), impact.t_end.value_or(times.back()));
        const bool one_instant = first == after || *first == *(after - 1);
        out.push_back({impact, static_cast<int>(first - times.begin()), times.size() > 1 && one_instant});
    }
    return out;
}

// The station of the line that is nearest to a place relative to the beam's length.
std::size_t station(const DrawnBeam& beam, double place) {
    return static_cast<std::size_t>(std::lround(place * static_cast<double>(beam.line.size() - 1)));
}

}  // namespace

double largest_held_peak(const FilmContext& context, const PanelSlot& slot) {
    if (slot.spec.kind != PanelKind::mechanism || is_small(slot.box, context.unit)) return 0;
    if (!context.setup->view.show.labels) return 0;
    const int member = std::min(slot.spec.member, context.members() - 1);
    std::map<int, double> strongest;  // contact of each collision
    std::set<int> held;               // collisions
    for (const auto& [impact, frame, brief] : shown_impacts(context.motion(member), context.times)) {
        double& force = strongest[impact.collision];
        force = std::max(force, impact.force_peak.value_or(0));
        if (brief) held.insert(impact.collision);
    }
    double out = 0;
    for (const int collision : held) out = std::max(out, strongest[collision]);
    return out;
}

void ImpactRings::find(const MechanismView& at) {
    context_ = &at.context;
    labelled_ = at.labelled();
    const std::vector<double>& times = at.context.times;
    for (const auto& [impact, frame, brief] : shown_impacts(at.motion(), times)) {
        const sim::Pose pose = at.context.pose(at.member, frame);
        const DrawnBeam b = at.drawn(at.member, pose);
        if (!b.contact) continue;
        const Vec2 n = b.contact->normal;
        const double place = std::clamp(impact.x / at.problem().beam.length, 0.0, 1.0);
        const Vec2 left = b.left[station(b, place)];
        const auto struck = std::ranges::upper_bound(times, impact.t_start) - times.begin();
        rings_.push_back({frame,
                          static_cast<int>(struck),
                          std::atan2(n.y, n.x) - pose.cam_angle,
                          place,
                          {cross(n, left), dot(n, left)},
                          impact.force_peak.value_or(0),
                          brief,
                          impact.collision});
    }
}

double ImpactRings::age(const Ring& ring, int frame) const {
    const std::vector<int>& moved = context_->moved;
    return (moved[static_cast<std::size_t>(frame)] - moved[static_cast<std::size_t>(ring.frame)]) /
           (kRing * context_->setup->fps);
}

// Rings move with the disc.
void ImpactRings::draw(const MechanismScene& s) const {
    if (!s.at.problem().cam) return;
    const auto later = std::ranges::upper_bound(rings_, s.frame, {}, &Ring::frame);
    for (const Ring& r : std::span(later - std::min(kMostRings, later - rings_.begin()), later)) {
        const double share = age(r, s.frame);
        if (share >= 1) continue;
        const Vec2 at =
            s.px(s.pose.disc_centre + sim::unit(s.pose.cam_angle + r.material_angle) * s.at.problem().cam->radius);
        s.canvas.circle(at, (7 + 20 * std::sqrt(share)) * s.at.marks);
        s.canvas.stroke(
            {s.at.palette.contact.faded((1 - share) * (1 - share)), (3.2 - 2 * share) * std::max(s.at.marks, 0.45)});
    }
}

// Of the collision's contacts so far. A longer contact shows its own force.
std::optional<ForceArrow> ImpactRings::peak(int frame, const DrawnBeam& beam) const {
    if (!labelled_) return std::nullopt;
    const Ring* latest = nullptr;
    for (const Ring& r : rings_)
        if (frame >= r.struck && age(r, frame) < 1 && (!latest || r.frame >= latest->frame || !r.brief)) latest = &r;
    if (!latest || !latest->brief) return std::nullopt;
    const Ring* most = latest;
    for (const Ring& r : rings_)
        if (r.struck <= frame && r.collision == latest->collision && r.peak > most->peak) most = &r;
    if (!(most->peak > 0)) return std::nullopt;
    const std::size_t i = station(beam, most->place);
    const Vec2 left = beam.left[i], along{left.y, -left.x};
    const Vec2 face = beam.line[i] + left * (most->direction.y >= 0 ? beam.low : beam.high);
    return ForceArrow{face, along * most->direction.x + left * most->direction.y, most->peak, true};
}

}  // namespace beamcam::render
