// Captions: the texts of events in boxes, with leader lines to their anchors.
#include <algorithm>
#include <numbers>
#include <optional>

#include "render/film/caption_places.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr double kNearContact = 2e-3;  // of the beam's length: a gap that looks like contact

class Captions {
  public:
    explicit Captions(const MechanismScene& scene) : s(scene), u(scene.at.unit), places(scene) {}

    void draw() const {
        for (const Callout& c : s.at.context.setup->callouts)
            if (places.is_visible(c)) draw_leader(c);
        for (const Callout& c : s.at.context.setup->callouts)
            if (places.is_visible(c)) draw_plate(c);
    }

  private:
    bool meets_label(Vec2 from, Vec2 to) const {
        for (const Box& label : places.labels())
            for (int i = 0; i <= 64; ++i) {
                const Vec2 at = from + (to - from) * (i / 64.0);
                if (label.inset(-3 * u).overlaps({at.x, at.y, 1, 1})) return true;
            }
        return false;
    }

    // The projected rim of the disc, slightly reduced.
    std::vector<Vec2> disc() const {
        std::vector<Vec2> rim;
        for (int i = 0; s.shape.disc && i < 48; ++i)
            rim.push_back(s.on(s.shape.disc->centre + down(2 * pi * i / 48) * (0.96 * s.shape.disc->radius)));
        return rim;
    }

    static bool crosses(const std::vector<Vec2>& disc, Vec2 from, Vec2 to) {
        for (int i = 0; i <= 64 && !disc.empty(); ++i) {
            const Vec2 at = from + (to - from) * (i / 64.0);
            bool inside = true;
            for (std::size_t k = 0; k < disc.size() && inside; ++k)
                inside = cross(disc[(k + 1) % disc.size()] - disc[k], at - disc[k]) < 0;
            if (inside) return true;
        }
        return false;
    }

    // The corner of a leader line to the contact that would otherwise cross the disc: a point of the tangent at the
    // contact, on the caption's side. None if the straight line is clear, or no corner makes it so.
    std::optional<Vec2> bend(Vec2 from, Vec2 to) const {
        const std::vector<Vec2> rim = disc();
        if (!crosses(rim, from, to)) return std::nullopt;
        const Vec2 centre = s.on(s.shape.disc->centre), out = to - centre;
        const double radius = norm(out), side = dot(from - centre, Vec2{-out.y, out.x}) < 0 ? -1 : 1;
        if (!(radius > 0)) return std::nullopt;
        const Vec2 along = Vec2{-out.y, out.x} * (side / radius);
        for (int fifths = 2; fifths < 20; ++fifths)
            if (const Vec2 at = to + along * (0.2 * fifths * radius); !crosses(rim, from, at)) return at;
        return std::nullopt;
    }

    // Draws a leader line that starts under the box, at a point from which it crosses no label.
    void lead(const Box& plate, Vec2 from, Vec2 to, double opacity, std::optional<Vec2> by = {}) const {
        const Vec2 end = to;
        to = by.value_or(to);
        const Vec2 usual = from;
        for (int i = 0; i <= 16 && meets_label(from, to); ++i)
            from = {plate.x + 10 * u + (plate.w - 20 * u) * i / 16, usual.y};
        const bool crossed = meets_label(from, to);
        if (crossed) from = usual;
        s.canvas.move_to(from);
        s.canvas.line_to(to);
        if (by) s.canvas.line_to(end);
        s.canvas.stroke({s.at.palette.ink.faded(opacity), 1.6 * u});
        if (crossed && s.at.labels->speed) draw_cam_speed(s);  // again, so that its halo covers the line
    }

    void draw_plate(const Callout& callout) const {
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

    // To the contact only while there is one, from the latest caption; without a cam to the tip.
    void draw_leader(const Callout& callout) const {
        const Box plate = places.plate_of(callout);
        const double opacity = callout.opacity(s.frame);
        if (CaptionPlaces::is_at_contact(callout)) {
            const bool near = s.pose.nearest && s.pose.nearest->gap < kNearContact * s.at.problem().beam.length;
            const bool latest = std::ranges::none_of(s.at.context.setup->callouts, [&](const Callout& other) {
                return CaptionPlaces::is_at_contact(other) && other.shown(s.frame) &&
                       CaptionPlaces::comes_before(callout, other);
            });
            if (!latest || (s.at.problem().cam && !near) || !s.at.shows(places.contact_foot())) return;
            const Vec2 from{plate.x + 10 * u, plate.y + 10 * u}, foot = places.contact_foot();
            lead(plate, from, foot, opacity, bend(from, foot));
        } else if (CaptionPlaces::kind_of(callout) != Anchor::Kind::all) {
            if (const Vec2 foot = places.foot_of(*callout.anchor); s.at.shows(foot))
                lead(plate, plate.centre(), foot, opacity);
        }
    }

    const MechanismScene& s;
    const double u;
    const CaptionPlaces places;
};

}  // namespace

void draw_captions(const MechanismScene& s) {
    const auto& all = s.at.context.setup->callouts;
    if (std::ranges::any_of(all, [&](const Callout& c) { return c.shown(s.frame); })) Captions(s).draw();
}

}  // namespace beamcam::render
