#include "render/film/captions.hpp"

#include <algorithm>
#include <numeric>

#include "render/film/mechanism_marks.hpp"
#include "render/plot/words.hpp"

namespace beamcam::render {
namespace {

constexpr std::size_t kCaptionLines = 6;
constexpr double kNearContact = 2e-3;  // of the beam's length: what looks like touching
constexpr double kCaptionLine = 29;    // from line to line [design px]
constexpr double kFreeBelow = 40;      // that stays free below captions [design px]
constexpr double kFromAnchor = 46;     // from what a caption is anchored to [design px]

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
        for (const auto* label : {&s.at.labels->speed, &s.at.labels->angle, &s.at.labels->force})
            if (*label) labels.push_back(s.at.label_box(**label, s.view));
    }

    void draw() const {
        std::vector<const Callout*> at_contact;
        double free = box.bottom() - kFreeBelow * u;  // above it, for captions of the whole picture
        for (const Callout& c : s.at.facts.setup->callouts) {
            if (!c.shown(s.frame)) continue;
            const Anchor::Kind kind = c.anchor.value_or(Anchor{Anchor::Kind::contact, {}}).kind;
            if (kind == Anchor::Kind::contact)
                at_contact.push_back(&c);
            else if (kind == Anchor::Kind::all)
                free = draw_below(c, free);
            else
                draw_anchored(c);
        }
        if (!at_contact.empty()) draw_at_contact(std::move(at_contact));
    }

  private:
    Caption caption_of(const Callout& words, Vec2 at) const {
        Caption out{wrapped(s.canvas, words.text, style, kCaptionLines), {}, {}, words.opacity(s.frame)};
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

    // The first of the mechanism's labels that it would hide; null: none.
    const Box* hidden(const Box& plate) const {
        const auto found = std::ranges::find_if(labels, [&](const Box& label) { return plate.overlaps(label); });
        return found == labels.end() ? nullptr : &*found;
    }

    // Off the labels: below, else above.
    void place(Box& plate) const {
        keep_inside(plate);
        if (const Box* label = hidden(plate)) plate.y = label->bottom() + 12 * u;
        keep_inside(plate);
        if (const Box* label = hidden(plate)) plate.y = std::max(box.y, label->y - 12 * u - plate.h);
    }

    void lead(Vec2 from, Vec2 to, double opacity) const {
        s.canvas.move_to(from);
        s.canvas.line_to(to);
        s.canvas.stroke({s.at.palette.ink.faded(opacity), 1.6 * u});
        for (int i = 0; s.at.labels->speed && i <= 64; ++i) {  // under the cam's speed, whose halo keeps it off
            const Vec2 at = from + (to - from) * (i / 64.0);
            if (labels.front().overlaps({at.x, at.y, 1, 1})) return draw_cam_speed(s);
        }
    }

    void draw(const Caption& caption) const {
        const Box& plate = caption.plate;
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

    // One above the other at the lower edge.
    double draw_below(const Callout& words, double free) const {
        Caption caption = caption_of(words, {});
        caption.plate.x = box.centre().x - caption.plate.w / 2, caption.plate.y = free - caption.plate.h;
        keep_inside(caption.plate);
        if (const Box* label = hidden(caption.plate)) caption.plate.y = label->y - 12 * u - caption.plate.h;
        draw(caption);
        return caption.plate.y - 8 * u;
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

    // Above what it belongs to, where the cam does not come; where there is no room, below. What does not move has its
    // words below it.
    void draw_anchored(const Callout& words) const {
        const Vec2 foot = foot_of(*words.anchor);
        Caption caption = caption_of(words, {foot.x + kFromAnchor * u, foot.y});
        Box& plate = caption.plate;
        if (plate.right() > box.right()) plate.x = foot.x - kFromAnchor * u - plate.w;
        plate.y = foot.y - kFromAnchor * u - plate.h;
        if (plate.y < box.y) plate.y = foot.y + kFromAnchor * u;
        if (words.anchor->kind == Anchor::Kind::hub) {
            plate.x = foot.x - plate.w / 2, plate.y = foot.y + support_reach(s.at.hub(), s.at.marks) + 14 * u;
        } else if (const auto& cam = s.at.problem().cam; cam && words.anchor->kind == Anchor::Kind::cam) {
            const double swept = (cam->radius + cam->eccentricity) * s.at.look.camera.scale;
            plate.x = foot.x - 0.8 * plate.w, plate.y = foot.y + swept + 30 * u;
        }
        place(plate);
        if (s.at.shows(foot)) lead(plate.centre(), foot, caption.opacity);
        draw(caption);
    }

    // To the right of the cam, below the horizontal, where neither the beam nor the force comes: the latest with a line
    // to the contact, earlier ones below or above it.
    void draw_at_contact(std::vector<const Callout*> shown) const {
        std::ranges::stable_sort(shown, std::ranges::greater(), [](const Callout* c) { return c->first; });
        const auto& cam = s.at.problem().cam;
        const Vec2 foot = s.beam.contact ? s.px(s.beam.contact->on_disc) : foot_of({.kind = Anchor::Kind::tip});
        const double swept = cam ? (cam->radius + cam->eccentricity) * s.at.look.camera.scale : 0;
        const Vec2 from = cam ? s.px(s.pose.cam_centre) : foot;
        Caption latest = caption_of(*shown.front(), {from.x + swept + 60 * u, from.y + 26 * u});
        place(latest.plate);
        // A line to the contact while there is one; without a cam to the tip.
        const bool near = s.pose.nearest && s.pose.nearest->gap < kNearContact * s.at.problem().beam.length;
        if (s.at.shows(foot) && (!cam || near))
            lead({latest.plate.x + 10 * u, latest.plate.y + 10 * u}, foot, latest.opacity);
        draw(latest);
        const double gap = 8 * u;
        double below = latest.plate.bottom() + gap, above = latest.plate.y - gap;
        for (std::size_t i = 1; i < shown.size(); ++i) {
            Caption other = caption_of(*shown[i], {latest.plate.x, below});
            other.plate.x = std::max(box.x, std::min(other.plate.x, box.right() - other.plate.w));
            if (const Box* label = hidden(other.plate)) other.plate.y = label->bottom() + gap;
            const bool fits = other.plate.bottom() <= box.bottom() - kFreeBelow * u;
            if (!fits) other.plate.y = above - other.plate.h;
            const Box* label = fits ? nullptr : hidden(other.plate);
            if (label) other.plate.y = label->y - gap - other.plate.h;
            if (other.plate.y < box.y) return;  // no room for more
            (fits ? below : above) = fits ? other.plate.bottom() + gap : other.plate.y - gap;
            draw(other);
        }
    }

    const MechanismScene& s;
    const double u;
    const Box& box;
    TextStyle style;
    std::vector<Box> labels;  // of the mechanism, which captions keep off; the cam's speed first
};

}  // namespace

void draw_captions(const MechanismScene& s) {
    const auto& all = s.at.facts.setup->callouts;
    if (std::ranges::any_of(all, [&](const Callout& c) { return c.shown(s.frame); })) Captions(s).draw();
}

}  // namespace beamcam::render
