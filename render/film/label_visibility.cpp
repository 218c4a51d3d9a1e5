#include "render/film/label_visibility.hpp"

#include <algorithm>
#include <cmath>

#include "render/film/swept_region.hpp"

namespace beamcam::render {
namespace {

constexpr double kFastFade = 0.05;       // of a label that the camera passes quickly [s]
constexpr double kFarthestShift = 90;    // of a label before a moving camera [design px]
constexpr double kMargin = 2;            // from bodies [design px]
constexpr double kSmoothedShifts = 0.1;  // duration over which they are averaged [s of the film]

// Of neighbours that are shown. Windows are symmetric, so that a label does not lag behind the camera.
std::vector<Vec2> averaged(const std::vector<std::optional<Vec2>>& all, int half) {
    std::vector<Vec2> out(all.size());
    const auto at = [&](int k) {
        return k < 0 || k >= static_cast<int>(all.size()) ? std::nullopt : all[static_cast<std::size_t>(k)];
    };
    for (int k = 0; k < static_cast<int>(all.size()); ++k) {
        if (!at(k)) continue;
        Vec2 sum = *at(k);
        int reach = 0;
        while (reach < half && at(k - reach - 1) && at(k + reach + 1)) ++reach, sum += *at(k - reach) + *at(k + reach);
        out[static_cast<std::size_t>(k)] = sum * (1.0 / (2 * reach + 1));
    }
    return out;
}

}  // namespace

SeenFrame::SeenFrame(const MechanismCameras& cameras, int k)
    : frame(k), at(cameras.view(k)), projection(cameras.perspective(at, k)) {}

OccupancyGrid with_bodies(OccupancyGrid room, const SeenFrame& now) {
    SweptRegion parts(now.at, std::move(room),
                      now.projection ? std::vector{*now.projection} : std::vector<Perspective>());
    parts.add_shape(now.at.drawn_frame(now.frame).shape);
    return std::move(parts.room);
}

bool meets_body(const Box& box, const SeenFrame& now) {
    return with_bodies(OccupancyGrid(box, 4 * now.at.unit), now).covered(box.inset(0.01)) > 0.01;
}

// A label in this box hides neither a body nor its owner.
static bool is_clear(const Box& box, const SeenFrame& now, const std::vector<Box>& owner) {
    const Box kept = box.inset(-kMargin * now.at.unit);
    return std::ranges::none_of(owner, [&](const Box& part) { return kept.overlaps(part); }) && !meets_body(kept, now);
}

// From the wanted place, moved into the view, to the nearest clear one; none if that is far.
static std::optional<Vec2> way_aside(const Box& box, const SeenFrame& now, const std::vector<Box>& owner) {
    if (is_clear(box, now, owner)) return Vec2{};
    const double cell = 4 * now.at.unit;
    const Box within = now.at.label_area(), near = box.inset(-kFarthestShift * now.at.unit);
    const double x = std::max(within.x, near.x), y = std::max(within.y, near.y);
    const Box around{x, y, std::min(within.right(), near.right()) - x, std::min(within.bottom(), near.bottom()) - y};
    OccupancyGrid room = with_bodies(OccupancyGrid(around, cell), now);
    for (const Box& part : owner) room.cover(part);
    const Box free = room.nearest_free(box.inset(-cell)).inset(cell);
    if (!is_clear(free, now, owner)) return std::nullopt;
    return free.centre() - box.centre();
}

void shift_clear(LabelPlace& label, const MechanismCameras& cameras,
                 const std::function<std::optional<WantedPlace>(const SeenFrame&)>& wanted) {
    const FilmContext& context = cameras.view(0).context;
    const auto frames = static_cast<std::size_t>(context.frames());
    std::vector<std::optional<Vec2>> aside(frames);
    std::vector<std::optional<WantedPlace>> places(frames);
    std::vector<int> met;
    for (std::size_t k = 0; k < frames; ++k) {
        const SeenFrame now(cameras, static_cast<int>(k));
        if (places[k] = wanted(now); !places[k]) continue;
        places[k]->box = now.at.inside_view(places[k]->box);
        aside[k] = way_aside(places[k]->box, now, places[k]->owner);
        if (!aside[k]) met.push_back(now.frame);
    }
    label.shifts = averaged(aside, static_cast<int>(kSmoothedShifts / 2 * context.setup->fps));
    for (std::size_t k = 0; k < frames; ++k) {
        if (!places[k]) continue;
        const WantedPlace& place = *places[k];
        Vec2& shift = label.shifts[k];
        if (aside[k] && !(shift == *aside[k])) {
            const SeenFrame now(cameras, static_cast<int>(k));
            const Box there{place.box.x + shift.x, place.box.y + shift.y, place.box.w, place.box.h};
            if (!is_clear(now.at.inside_view(there), now, place.owner)) shift = *aside[k];
        }
        shift = shift + place.box.centre() - place.base - label.offset;
        shift = {std::round(64 * shift.x) / 64, std::round(64 * shift.y) / 64};  // the same while the camera rests
    }
    fade_about(label, met, context, kFastFade);
    label.opacity.resize(frames, 1);
    for (std::size_t k = 0; k < frames; ++k)
        if (!places[k]) label.opacity[k] = 0;
}

LabelPlace placed_near(const MechanismView& at, const Perspective* by, const OccupancyGrid& room, const Box& preferred,
                       Vec2 base, double clear) {
    const Box found = room.nearest_free(preferred.inset(-at.unit - clear));
    const Vec2 on_base = at.look.camera.to_world(base);
    return {on_base, found.centre() - at.seen(at.px(on_base), by), {preferred.w, preferred.h}, {}, {}};
}

void fade_where_met(LabelPlace& label, const MechanismCameras& cameras, const OccupancyGrid& room) {
    const SeenFrame usual(cameras, 0);
    if (room.covered(usual.at.label_box(label, usual.by())) == 0) return;
    const FilmContext& context = usual.at.context;
    std::vector<int> met;
    for (int k = 0; k < context.frames(); ++k)
        if (const SeenFrame now(cameras, k); meets_body(now.at.label_box(label, now.by()), now)) met.push_back(k);
    fade_about(label, met, context);
}

void fade_about(LabelPlace& label, const std::vector<int>& met, const FilmContext& context, double lasts) {
    if (met.empty()) return;
    const double fade = lasts * context.setup->fps;
    for (int k = 0; k < context.frames(); ++k) {
        const auto after = std::ranges::lower_bound(met, k);
        int far = context.frames();
        if (after != met.end()) far = *after - k;
        if (after != met.begin()) far = std::min(far, k - *std::prev(after));
        label.opacity.push_back(static_cast<float>(std::min(1.0, far / (1 + fade))));
    }
}

double frames_visible(const Box& box, const MechanismCameras& cameras,
                      const std::function<bool(const sim::Pose&)>& counts) {
    constexpr int kSample = 60;
    const MechanismView at = cameras.view(0);
    const int frames = at.context.frames(), step = 1 + frames / kSample;
    std::vector<int> met, counted;
    for (int k = 0; k < frames; k += step) {
        if (meets_body(box, {cameras, k})) met.push_back(k);
        if (counts(at.context.pose(at.member, k))) counted.push_back(k);
    }
    LabelPlace label;
    fade_about(label, met, at.context);
    double visible = 0;
    for (const int k : counted) visible += label.opacity_at(k);
    return visible;
}

}  // namespace beamcam::render
