// Captions: the texts of events in boxes, with leader lines to their anchors.
#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "render/film/mechanism_marks.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr std::size_t kCaptionLines = 6;
constexpr double kNearContact = 2e-3;  // of the beam's length: a gap that looks like contact
constexpr double kCaptionLine = 29;    // distance between lines [design px]
constexpr double kFreeBelow = 40;      // free space below captions [design px]
constexpr double kBetweenPlates = 8;   // [design px]
constexpr double kFromAnchor = 46;     // distance of a caption from its anchor [design px]

struct Caption {
    std::vector<std::string> lines;
    std::vector<double> heights;  // of the lines [px]
    Box plate;
    double opacity = 1;
};

class Captions {
  public:
    explicit Captions(const MechanismScene& scene) : s(scene), u(scene.at.unit), box(scene.at.box) {
        style = {.size = 22 * u, .color = s.at.palette.ink, .weight = Weight::medium, .max_width = 0.45 * box.w};
        const MechanismLabels& placed = *s.at.labels;
        for (const auto* label : {&placed.speed, &placed.angle})
            if (*label) labels.push_back(s.at.label_box(**label, s.view));
        if (placed.force)
            labels.push_back(s.at.label_box(force_place(s), s.view, s.arrow ? s.arrow->foot : placed.force->base));
    }

    void draw() const {
        for (const Callout& c : s.at.context.setup->callouts)
            if (is_visible(c)) draw_leader(c);
        for (const Callout& c : s.at.context.setup->callouts)
            if (is_visible(c)) draw_plate(c);
    }

  private:
    Caption caption_of(const Callout& callout, Vec2 at) const {
        Caption out{wrapped_lines(s.canvas, callout.text, style, kCaptionLines), {}, {}, callout.opacity(s.frame)};
        double widest = 0;
        for (const std::string& line : out.lines) {
            const Box ink = s.canvas.measure(line, style);
            widest = std::max(widest, ink.w);
            out.heights.push_back(ink.h > 1.25 * style.size ? ink.h + 9 * u : kCaptionLine * u);  // a fraction
        }
        out.plate = {at.x, at.y, widest + 32 * u,
                     17 * u + std::accumulate(out.heights.begin(), out.heights.end(), 0.0)};
        return out;
    }

    void keep_inside(Box& plate) const {
        plate.x = std::clamp(plate.x, box.x, std::max(box.x, box.right() - plate.w));
        plate.y = std::clamp(plate.y, box.y, std::max(box.y, box.bottom() - plate.h - kFreeBelow * u));
    }

    // The first label of the mechanism that the box would hide; null: none.
    const Box* hidden(const Box& plate) const {
        const auto found = std::ranges::find_if(labels, [&](const Box& label) { return plate.overlaps(label); });
        return found == labels.end() ? nullptr : &*found;
    }

    // Moves the box off the labels: below them, otherwise above.
    void place(Box& plate) const {
        keep_inside(plate);
        if (const Box* label = hidden(plate)) plate.y = label->bottom() + 12 * u;
        keep_inside(plate);
        if (const Box* label = hidden(plate)) plate.y = std::max(box.y, label->y - 12 * u - plate.h);
    }

    bool meets_label(Vec2 from, Vec2 to) const {
        for (const Box& label : labels)
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
        for (double far = 0.4; far < 4; far += 0.2)
            if (const Vec2 at = to + along * (far * radius); !crosses(rim, from, at)) return at;
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
        const Box plate = plate_of(callout);
        const Caption caption = caption_of(callout, {plate.x, plate.y});
        s.canvas.rounded(plate, 8 * u);
        s.canvas.fill_keeping_path(s.at.palette.paper.faded(caption.opacity));
        s.canvas.stroke({s.at.palette.ink.faded(caption.opacity), 1.6 * u});
        TextStyle faded = style;
        faded.color = style.color.faded(caption.opacity);
        double y = plate.y + 2 * u;
        for (std::size_t i = 0; i < caption.lines.size(); ++i) {
            const double extra = (caption.heights[i] - kCaptionLine * u) / 2;
            s.canvas.text({plate.x + 16 * u, y + extra + kCaptionLine * u}, caption.lines[i], faded);
            y += caption.heights[i];
        }
    }

    Vec2 foot_of(const Anchor& anchor) const {
        switch (anchor.kind) {
            case Anchor::Kind::tip:
                return s.on((s.shape.face.back() + s.shape.back.back()) * 0.5);
            case Anchor::Kind::hub:
                return s.px({0, 0});
            case Anchor::Kind::cam:
                return s.px(s.at.problem().cam ? s.pose.cam_centre : Vec2{});
            case Anchor::Kind::place:
            case Anchor::Kind::contact:
            case Anchor::Kind::all:
                break;
        }
        return s.px(anchor.place);
    }

    static Anchor::Kind kind_of(const Callout& c) { return c.anchor ? c.anchor->kind : Anchor::Kind::contact; }
    static bool is_at_contact(const Callout& c) { return kind_of(c) == Anchor::Kind::contact; }

    // The order in which captions get their places: those of moving parts last, so that the others keep theirs.
    static bool comes_before(const Callout& one, const Callout& other) {
        const auto moves = [](const Callout& c) { return kind_of(c) == Anchor::Kind::tip; };
        if (moves(one) != moves(other)) return moves(other);
        return one.first < other.first || (one.first == other.first && &one < &other);
    }

    // Without space for all, a later caption replaces earlier ones.
    bool is_visible(const Callout& callout) const {
        if (!callout.shown(s.frame)) return false;
        return std::ranges::none_of(s.at.context.setup->callouts, [&](const Callout& other) {
            return other.shown(s.frame) && comes_before(callout, other) && plate_of(callout).overlaps(plate_of(other));
        });
    }

    // To the contact only while there is one, from the latest caption; without a cam to the tip.
    void draw_leader(const Callout& callout) const {
        const Box plate = plate_of(callout);
        const double opacity = callout.opacity(s.frame);
        if (is_at_contact(callout)) {
            const bool near = s.pose.nearest && s.pose.nearest->gap < kNearContact * s.at.problem().beam.length;
            const bool latest = std::ranges::none_of(s.at.context.setup->callouts, [&](const Callout& other) {
                return is_at_contact(other) && other.shown(s.frame) && comes_before(callout, other);
            });
            if (!latest || (s.at.problem().cam && !near) || !s.at.shows(contact_foot())) return;
            const Vec2 from{plate.x + 10 * u, plate.y + 10 * u}, foot = contact_foot();
            lead(plate, from, foot, opacity, bend(from, foot));
        } else if (kind_of(callout) != Anchor::Kind::all) {
            if (const Vec2 foot = foot_of(*callout.anchor); s.at.shows(foot))
                lead(plate, plate.centre(), foot, opacity);
        }
    }

    Vec2 contact_foot() const {
        return s.beam.contact ? s.px(s.beam.contact->on_disc) : foot_of({.kind = Anchor::Kind::tip});
    }

    // Captions that are visible together do not overlap. Each keeps its place while others appear and disappear: it
    // depends only on those that are visible when it appears.
    Box plate_of(const Callout& callout) const {
        if (const auto found = plates.find(&callout); found != plates.end()) return found->second;
        std::vector<Box> taken;
        for (const Callout& other : s.at.context.setup->callouts)
            if (comes_before(other, callout) && other.last >= callout.first && other.first <= callout.last)
                taken.push_back(plate_of(other));
        Box first = first_plate(callout);
        keep_inside(first);
        std::vector<Box> bodies = taken;  // disc and hub should stay visible, too
        add_bodies(bodies);
        if (kind_of(callout) == Anchor::Kind::tip || kind_of(callout) == Anchor::Kind::place) {
            const Vec2 foot = foot_of(*callout.anchor);
            bodies.push_back(Box{foot.x, foot.y, 0, 0}.inset(-24 * u));
        }
        std::optional<Box> found = free_plate(first, bodies);
        if (!found) found = free_plate(first, taken);
        return plates[&callout] = found.value_or(first);
    }

    // The region that the disc sweeps, and the hub with its support; nothing while a near camera shows little else.
    void add_bodies(std::vector<Box>& taken) const {
        if (s.at.moved) return;
        const Vec2 o = s.px({0, 0});
        const double hub = s.at.hub(), half = std::max(hub, support_half_width(hub, s.at.marks));
        taken.push_back({o.x - half, o.y - hub, 2 * half, hub + support_reach(hub, s.at.marks) - 14 * s.at.marks});
        if (const auto& cam = s.at.problem().cam) {
            const double swept = (cam->radius + cam->eccentricity) * s.at.look.camera.scale;
            const Vec2 middle = s.px(s.pose.cam_centre);
            taken.push_back({middle.x - swept, middle.y - swept, 2 * swept, 2 * swept});
        }
    }

    Box first_plate(const Callout& callout) const {
        if (is_at_contact(callout)) return plate_at_contact(callout);
        if (kind_of(callout) != Anchor::Kind::all) return plate_at_anchor(callout);
        Box plate = caption_of(callout, {}).plate;  // at the lower edge
        plate.x = box.centre().x - plate.w / 2, plate.y = box.bottom() - kFreeBelow * u - plate.h;
        return plate;
    }

    // Above the anchor, away from the cam, or below it if there is no space above. Captions of fixed parts are below
    // them.
    Box plate_at_anchor(const Callout& callout) const {
        const Vec2 foot = foot_of(*callout.anchor);
        Box plate = caption_of(callout, {foot.x + kFromAnchor * u, foot.y}).plate;
        if (plate.right() > box.right()) plate.x = foot.x - kFromAnchor * u - plate.w;
        plate.y = foot.y - kFromAnchor * u - plate.h;
        if (plate.y < box.y) plate.y = foot.y + kFromAnchor * u;
        if (callout.anchor->kind == Anchor::Kind::hub) {
            plate.x = foot.x - plate.w / 2, plate.y = foot.y + support_reach(s.at.hub(), s.at.marks) + 14 * u;
        } else if (const auto& cam = s.at.problem().cam; cam && callout.anchor->kind == Anchor::Kind::cam) {
            const double swept = (cam->radius + cam->eccentricity) * s.at.look.camera.scale;
            plate.x = foot.x - 0.8 * plate.w, plate.y = foot.y + swept + 30 * u;
        }
        return plate;
    }

    // To the right of the cam, below the horizontal, where neither beam nor force arrow come, with space below for
    // captions that appear while it is visible. A near camera sees the bodies everywhere: there it is at the contact.
    Box plate_at_contact(const Callout& callout) const {
        const auto& cam = s.at.moved ? std::nullopt : s.at.problem().cam;
        const double swept = cam ? (cam->radius + cam->eccentricity) * s.at.look.camera.scale : 0;
        const Vec2 from = cam ? s.px(s.pose.cam_centre) : contact_foot();
        const Caption caption = caption_of(callout, {from.x + swept + 60 * u, from.y + 26 * u});
        Box whole = caption.plate;
        whole.h += space_for_later(callout);
        if (whole.h > box.h / 2) whole.h = caption.plate.h;
        place(whole);
        return {whole.x, whole.y, caption.plate.w, caption.plate.h};
    }

    double space_for_later(const Callout& callout) const {
        double most = 0;
        const auto appears_meanwhile = [&](const Callout& c) {
            return is_at_contact(c) && comes_before(callout, c) && c.first <= callout.last;
        };
        for (const Callout& latest : s.at.context.setup->callouts) {
            if (!appears_meanwhile(latest)) continue;
            double all = 0;
            for (const Callout& c : s.at.context.setup->callouts)
                if (appears_meanwhile(c) && c.shown(latest.first))
                    all += kBetweenPlates * u + caption_of(c, {}).plate.h;
            most = std::max(most, all);
        }
        return most;
    }

    // The nearest place clear of other boxes and of labels, rather below or beside than above.
    std::optional<Box> free_plate(const Box& first, const std::vector<Box>& taken) const {
        const double gap = kBetweenPlates * u, lowest = box.bottom() - kFreeBelow * u;
        const auto is_free = [&](const Box& plate) {
            return plate.x >= box.x && plate.right() <= box.right() && plate.y >= box.y && plate.bottom() <= lowest &&
                   !hidden(plate) &&
                   std::ranges::none_of(taken, [&](const Box& other) { return plate.overlaps(other); });
        };
        if (is_free(first)) return first;
        std::vector<double> lefts{first.x}, tops{first.y};
        for (const std::vector<Box>* each : {&taken, &labels})
            for (const Box& other : *each) {
                tops.insert(tops.end(), {other.bottom() + gap, other.y - gap - first.h});
                lefts.insert(lefts.end(), {other.right() + gap, other.x - gap - first.w});
            }
        std::optional<Box> best;
        double least = 0;
        for (const double x : lefts)
            for (const double y : tops) {
                const Box plate{x, y, first.w, first.h};
                const double down = y - first.y,
                             cost = (down > 0 ? 1 : 2) * std::abs(down) + 0.7 * std::abs(x - first.x);
                if (!is_free(plate) || (best && cost >= least)) continue;
                best = plate, least = cost;
            }
        return best;
    }

    const MechanismScene& s;
    const double u;
    const Box& box;
    TextStyle style;
    std::vector<Box> labels;                       // labels that captions must not hide; the cam's speed first
    mutable std::map<const Callout*, Box> plates;  // cached
};

}  // namespace

void draw_captions(const MechanismScene& s) {
    const auto& all = s.at.context.setup->callouts;
    if (std::ranges::any_of(all, [&](const Callout& c) { return c.shown(s.frame); })) Captions(s).draw();
}

}  // namespace beamcam::render
