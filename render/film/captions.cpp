// Captions: the texts of events in boxes, with leader lines to their anchors.
#include <algorithm>
#include <optional>

#include "render/film/caption_places.hpp"

namespace beamcam::render {
namespace {

void draw_plate(const MechanismScene& s, const CaptionPlaces& places, const Callout& callout) {
    const double u = s.at.unit;
    const Box plate = places.plate_of(callout);
    const Caption caption = places.caption_of(callout, {plate.x, plate.y});
    s.canvas.rounded(plate, 8 * u);
    s.canvas.fill_keeping_path(s.at.palette.paper.faded(caption.opacity));
    s.canvas.stroke({s.at.palette.ink.faded(caption.opacity), 1.6 * u});
    TextStyle faded = places.style();
    faded.color = faded.color.faded(caption.opacity);
    double y = plate.y + 2 * u;
    for (std::size_t i = 0; i < caption.lines.size(); ++i) {
        const double extra = (caption.heights[i] - kCaptionLine * u) / 2;
        s.canvas.text({plate.x + 16 * u, y + extra + kCaptionLine * u}, caption.lines[i], faded);
        y += caption.heights[i];
    }
}

// To the contact only from the latest caption.
void draw_line(const MechanismScene& s, const CaptionPlaces& places, const Callout& callout) {
    const std::optional<Vec2> foot = places.leader_foot(callout);
    const auto replaces = [&](const Callout& other) {
        return CaptionPlaces::is_at_contact(other) && other.shown(s.frame) &&
               CaptionPlaces::comes_before(callout, other);
    };
    if (!foot) return;
    if (CaptionPlaces::is_at_contact(callout) && std::ranges::any_of(s.at.context.setup->callouts, replaces)) return;
    const CaptionLeader leader = places.leader_of(callout, places.plate_of(callout), *foot);
    s.canvas.polyline(leader.points);
    s.canvas.stroke({s.at.palette.ink.faded(callout.opacity(s.frame)), 1.6 * s.at.unit});
    if (leader.crosses_label && s.at.labels->speed) draw_cam_speed(s);  // again, so that its halo covers the line
}

template <class Part>
void draw_visible(const MechanismScene& s, const Part& part) {
    const std::vector<Callout>& all = s.at.context.setup->callouts;
    if (std::ranges::none_of(all, [&](const Callout& c) { return c.shown(s.frame); })) return;
    const CaptionPlaces places(s);
    for (const Callout& each : all)
        if (places.is_visible(each)) part(s, places, each);
}

}  // namespace

void draw_caption_leaders(const MechanismScene& s) { draw_visible(s, draw_line); }
void draw_captions(const MechanismScene& s) { draw_visible(s, draw_plate); }

}  // namespace beamcam::render
