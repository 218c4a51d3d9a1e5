#include "render/film/caption_places.hpp"

#include <algorithm>
#include <numeric>

#include "render/plot/user_text.hpp"

namespace beamcam::render {
namespace {

constexpr std::size_t kCaptionLines = 6;
constexpr double kFreeBelow = 40;      // free space below captions [design px]
constexpr double kBetweenPlates = 8;   // [design px]
constexpr double kFromAnchor = 46;     // distance of a caption from its anchor [design px]
constexpr double kRounding = 1e-6;     // [px]
constexpr double kNearContact = 2e-3;  // of the beam's length: a gap that looks like contact
// The distances that are worth not covering moving parts, and not crossing the disc or a label with the leader line
// [design px].
constexpr double kCovering = 1e4, kCrossing = 1e3;

}  // namespace

CaptionPlaces::CaptionPlaces(const MechanismScene& scene) : s(scene), u(scene.at.unit), box(scene.at.box) {
    style_ = {.size = 22 * u, .color = s.at.palette.ink, .weight = Weight::medium, .max_width = 0.45 * box.w};
    const MechanismLabels& placed = *s.at.labels;
    for (const auto* label : {&placed.speed, &placed.angle})
        if (*label) labels_.push_back(s.label_box(**label, (*label)->base));
    if (placed.force) labels_.push_back(s.label_box(*placed.force, s.arrow ? s.arrow->foot : placed.force->base));
}

Caption CaptionPlaces::caption_of(const Callout& callout, Vec2 at) const {
    Caption out{wrapped_lines(s.canvas, callout.text, style_, kCaptionLines), {}, {}, callout.opacity(s.frame)};
    double widest = 0;
    for (const std::string& line : out.lines) {
        const Box ink = s.canvas.measure(line, style_);
        widest = std::max(widest, ink.w);
        out.heights.push_back(ink.h > 1.25 * style_.size ? ink.h + 9 * u : kCaptionLine * u);  // a fraction
    }
    out.plate = {at.x, at.y, widest + 32 * u, 17 * u + std::accumulate(out.heights.begin(), out.heights.end(), 0.0)};
    return out;
}

void CaptionPlaces::keep_inside(Box& plate) const {
    plate.x = std::clamp(plate.x, box.x, std::max(box.x, box.right() - plate.w));
    plate.y = std::clamp(plate.y, box.y, std::max(box.y, box.bottom() - plate.h - kFreeBelow * u));
}

// The first label of the mechanism that the box would hide; null: none.
const Box* CaptionPlaces::hidden(const Box& plate) const {
    const auto found = std::ranges::find_if(labels_, [&](const Box& label) { return plate.overlaps(label); });
    return found == labels_.end() ? nullptr : &*found;
}

// Moves the box off the labels: below them, otherwise above.
void CaptionPlaces::place(Box& plate) const {
    keep_inside(plate);
    if (const Box* label = hidden(plate)) plate.y = label->bottom() + 12 * u;
    keep_inside(plate);
    if (const Box* label = hidden(plate)) plate.y = std::max(box.y, label->y - 12 * u - plate.h);
}

Vec2 CaptionPlaces::foot_of(const Anchor& anchor) const {
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

bool CaptionPlaces::comes_before(const Callout& one, const Callout& other) {
    const auto moves = [](const Callout& c) { return kind_of(c) == Anchor::Kind::tip; };
    if (moves(one) != moves(other)) return moves(other);
    return one.first < other.first || (one.first == other.first && &one < &other);
}

bool CaptionPlaces::is_visible(const Callout& callout) const {
    if (!callout.shown(s.frame)) return false;
    return std::ranges::none_of(s.at.context.setup->callouts, [&](const Callout& other) {
        return other.shown(s.frame) && comes_before(callout, other) && plate_of(callout).overlaps(plate_of(other));
    });
}

Vec2 CaptionPlaces::contact_foot() const {
    return s.beam.contact ? s.px(s.beam.contact->on_disc) : foot_of({.kind = Anchor::Kind::tip});
}

std::optional<Vec2> CaptionPlaces::leader_foot(const Callout& callout) const {
    if (kind_of(callout) == Anchor::Kind::all) return std::nullopt;
    const bool near = s.pose.nearest && s.pose.nearest->gap < kNearContact * s.at.problem().beam.length;
    if (is_at_contact(callout) && s.at.problem().cam && !near) return std::nullopt;
    const Vec2 foot = is_at_contact(callout) ? contact_foot() : foot_of(*callout.anchor);
    return s.at.shows(foot) ? std::optional(foot) : std::nullopt;
}

CaptionLeader CaptionPlaces::leader_of(const Callout& callout, const Box& plate, Vec2 foot) const {
    return is_at_contact(callout) ? leader_around_disc(s, labels_, plate, foot)
                                  : straight_leader(s, labels_, plate, foot);
}

Box CaptionPlaces::plate_of(const Callout& callout) const {
    const auto index = static_cast<std::size_t>(&callout - s.at.context.setup->callouts.data());
    if (const auto& kept = s.at.labels->captions[index]) return *kept;
    if (const auto found = plates_.find(&callout); found != plates_.end()) return found->second;
    return plates_[&callout] = placed(callout, beam());
}

// Depends only on captions that are visible when this one appears.
Box CaptionPlaces::placed(const Callout& callout, const std::vector<Box>& moving) const {
    std::vector<Box> others;
    for (const Callout& other : s.at.context.setup->callouts)
        if (comes_before(other, callout) && other.last >= callout.first && other.first <= callout.last)
            others.push_back(plate_of(other).inset(-kBetweenPlates * u));
    Box first = first_plate(callout);
    keep_inside(first);
    std::vector<Box> bodies = others;
    add_bodies(bodies);
    if (kind_of(callout) == Anchor::Kind::tip || kind_of(callout) == Anchor::Kind::place) {
        const Vec2 foot = foot_of(*callout.anchor);
        bodies.push_back(Box{foot.x, foot.y, 0, 0}.inset(-24 * u));
    }
    std::optional<Box> found = free_plate(callout, first, bodies, moving);
    if (!found) found = free_plate(callout, first, others, moving);
    return found.value_or(first);
}

// The region that the disc sweeps, and the hub with its support; nothing while a near camera shows little else.
void CaptionPlaces::add_bodies(std::vector<Box>& taken) const {
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

// Boxes around the beam: a caption that moves with the tip keeps clear of it at its instant.
std::vector<Box> CaptionPlaces::beam() const {
    constexpr std::size_t kPieces = 12;
    std::vector<Box> out;
    const std::size_t last = s.shape.face.size() - 1;
    for (std::size_t piece = 0; piece < kPieces; ++piece) {
        Bounds around;
        for (std::size_t i = last * piece / kPieces; i <= last * (piece + 1) / kPieces; ++i)
            around.add(s.on(s.shape.face[i])), around.add(s.on(s.shape.back[i]));
        out.push_back(around.box());
    }
    return out;
}

Box CaptionPlaces::first_plate(const Callout& callout) const {
    if (is_at_contact(callout)) return plate_at_contact(callout);
    if (kind_of(callout) != Anchor::Kind::all) return plate_at_anchor(callout);
    Box plate = caption_of(callout, {}).plate;  // at the lower edge
    plate.x = box.centre().x - plate.w / 2, plate.y = box.bottom() - kFreeBelow * u - plate.h;
    return plate;
}

// Above the anchor, away from the cam, or below it if there is no space above. Captions of fixed parts are below
// them.
Box CaptionPlaces::plate_at_anchor(const Callout& callout) const {
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
Box CaptionPlaces::plate_at_contact(const Callout& callout) const {
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

double CaptionPlaces::space_for_later(const Callout& callout) const {
    double most = 0;
    const auto appears_meanwhile = [&](const Callout& c) {
        return is_at_contact(c) && comes_before(callout, c) && c.first <= callout.last;
    };
    for (const Callout& latest : s.at.context.setup->callouts) {
        if (!appears_meanwhile(latest)) continue;
        double all = 0;
        for (const Callout& c : s.at.context.setup->callouts)
            if (appears_meanwhile(c) && c.shown(latest.first)) all += kBetweenPlates * u + caption_of(c, {}).plate.h;
        most = std::max(most, all);
    }
    return most;
}

// Whether a leader line passes over the disc.
bool CaptionPlaces::crosses_cam(Vec2 from, Vec2 to) const {
    const auto& cam = s.at.problem().cam;
    if (!cam) return false;
    const Vec2 axis = s.px(s.pose.cam_centre), way = to - from;
    const double swept = (cam->radius + cam->eccentricity) * s.at.look.camera.scale;
    const double nearest = std::clamp(dot(axis - from, way) / std::max(dot(way, way), 1e-9), 0.0, 1.0);
    return norm(to - axis) > swept && norm(from + way * nearest - axis) < swept;
}

// The nearest place clear of what is taken and of labels, unless the camera is near rather below or beside than above,
// and over as little as possible of what moves. None if there is none.
std::optional<Box> CaptionPlaces::free_plate(const Callout& callout, const Box& first, const std::vector<Box>& taken,
                                             const std::vector<Box>& moving) const {
    const double gap = kBetweenPlates * u, lowest = box.bottom() - kFreeBelow * u;
    const auto is_free = [&](const Box& plate) {
        return plate.x >= box.x && plate.right() <= box.right() && plate.y >= box.y && plate.bottom() <= lowest &&
               !hidden(plate) &&
               std::ranges::none_of(taken, [&](const Box& other) { return plate.inset(kRounding).overlaps(other); });
    };
    const auto covers = [&](const Box& plate) {
        double area = 0;
        for (const Box& other : moving)
            area += std::max(0.0, std::min(plate.right(), other.right()) - std::max(plate.x, other.x)) *
                    std::max(0.0, std::min(plate.bottom(), other.bottom()) - std::max(plate.y, other.y));
        return area / (plate.w * plate.h);
    };
    const std::optional<Vec2> foot = leader_foot(callout);
    const auto crosses = [&](const Box& plate) {
        return foot && ((!is_at_contact(callout) && crosses_cam(plate.centre(), *foot)) ||
                        leader_of(callout, plate, *foot).crosses_label);
    };
    if (is_free(first) && covers(first) == 0 && !crosses(first)) return first;
    std::vector<double> lefts{first.x, box.x, box.right() - first.w}, tops{first.y, box.y, lowest - first.h};
    const auto add_beside = [&](const Box& other) {
        tops.insert(tops.end(), {other.bottom(), other.y - first.h});
        lefts.insert(lefts.end(), {other.right(), other.x - first.w});
    };
    for (const Box& other : taken) add_beside(other);
    for (const std::vector<Box>* each : {&labels_, &moving})
        for (const Box& other : *each) add_beside(other.inset(-gap));
    const double upwards = s.at.moved ? 1 : 2;
    std::optional<Box> best;
    double least = 0;
    for (const double x : lefts)
        for (const double y : tops) {
            const Box plate{x, y, first.w, first.h};
            const double down = y - first.y;
            double cost = (down > 0 ? 1 : upwards) * std::abs(down) + 0.7 * std::abs(x - first.x);
            if ((best && cost >= least) || !is_free(plate)) continue;
            cost += kCovering * u * covers(plate) + (crosses(plate) ? kCrossing * u : 0);
            if (best && cost >= least) continue;
            best = plate, least = cost;
        }
    return best;
}

}  // namespace beamcam::render
