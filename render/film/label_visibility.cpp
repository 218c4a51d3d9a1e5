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

OccupancyGrid with_bodies(OccupancyGrid room, const SeenFrame& now, const ForceArrow* arrow) {
    SweptRegion parts(now.at, std::move(room),
                      now.projection ? std::vector{*now.projection} : std::vector<Perspective>());
    const sim::Pose pose = now.at.context.pose(now.at.member, now.frame);
    parts.add_shape(
        mechanism_shape(now.at.problem(), pose, now.at.drawn(now.at.member, pose), now.at.look, now.at.palette));
    if (arrow) parts.add_arrow(*arrow);
    return std::move(parts.room);
}

bool meets_body(const Box& box, const SeenFrame& now) {
    return with_bodies(OccupancyGrid(box, 4 * now.at.unit), now).covered(box.inset(0.01)) > 0.01;
}

void shift_clear(LabelPlace& label, const MechanismCameras& cameras,
                 const std::function<std::optional<WantedPlace>(const SeenFrame&)>& wanted) {
    const FilmContext& context = cameras.view(0).context;
    const auto frames = static_cast<std::size_t>(context.frames());
    std::vector<std::optional<Vec2>> aside(frames);  // from the wanted place
    std::vector<Vec2> usual(frames);                 // to the wanted place
    std::vector<Box> boxes(frames);                  // the wanted places
    std::vector<int> met;
    for (std::size_t k = 0; k < frames; ++k) {
        const SeenFrame now(cameras, static_cast<int>(k));
        const auto place = wanted(now);
        if (!place) continue;
        const double u = now.at.unit;
        const Box box = now.at.inside_view(place->box);
        usual[k] = box.centre() - place->base - label.offset;
        boxes[k] = box;
        aside[k] = Vec2{};
        const bool pushed = !(box == place->box);
        if (pushed && std::ranges::any_of(place->owner, [&](const Box& part) { return box.overlaps(part); })) {
            aside[k].reset(), met.push_back(now.frame);
            continue;
        }
        if (!meets_body(box.inset(-kMargin * u), now)) continue;
        const OccupancyGrid room = with_bodies(OccupancyGrid(now.at.label_area(), 4 * u), now);
        const Box free = room.nearest_free(box.inset(-4 * u)).inset(4 * u);
        if (norm(free.centre() - box.centre()) > kFarthestShift * u || meets_body(free, now))
            aside[k].reset(), met.push_back(now.frame);
        else
            aside[k] = free.centre() - box.centre();
    }
    label.shifts = averaged(aside, static_cast<int>(kSmoothedShifts / 2 * context.setup->fps));
    for (std::size_t k = 0; k < frames; ++k) {
        if (aside[k] && !(label.shifts[k] == *aside[k])) {
            const SeenFrame now(cameras, static_cast<int>(k));
            Box there = boxes[k];
            there.x += label.shifts[k].x, there.y += label.shifts[k].y;
            if (meets_body(now.at.inside_view(there).inset(-kMargin * now.at.unit), now)) label.shifts[k] = *aside[k];
        }
        const Vec2 whole = label.shifts[k] + usual[k];  // rounded: it is the same while the camera rests
        label.shifts[k] = {std::round(64 * whole.x) / 64, std::round(64 * whole.y) / 64};
    }
    fade_about(label, met, context, kFastFade);
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
