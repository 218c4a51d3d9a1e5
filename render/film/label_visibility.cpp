#include "render/film/label_visibility.hpp"

#include <algorithm>

#include "render/film/swept_region.hpp"

namespace beamcam::render {
namespace {

constexpr double kLabelFade = 0.2;  // duration of fading a label without a free place [s]

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

void fade_about(LabelPlace& label, const std::vector<int>& met, const FilmContext& context) {
    if (met.empty()) return;
    const double fade = kLabelFade * context.setup->fps;
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
