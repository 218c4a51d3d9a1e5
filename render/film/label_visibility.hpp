// When moving parts meet the place of a label, and its opacity, which fades around those frames.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "render/film/mechanism_cameras.hpp"
#include "render/plot/placement.hpp"

namespace beamcam::render {

// The mechanism at a frame, as its camera sees it.
struct SeenFrame {
    SeenFrame(const MechanismCameras& cameras, int k);
    const Perspective* by() const { return projection ? &*projection : nullptr; }

    int frame;
    MechanismView at;
    std::optional<Perspective> projection;
};

// Covers the bodies.
OccupancyGrid with_bodies(OccupancyGrid room, const SeenFrame& now);
bool meets_body(const Box& box, const SeenFrame& now);
// The free place of a label nearest to the preferred box. `by`: of the solid view; `base`: in the flat view [px].
LabelPlace placed_near(const MechanismView& at, const Perspective* by, const OccupancyGrid& room, const Box& preferred,
                       Vec2 base, double clear = 0);
// Before a camera that does not move, hides a label that has no place in `room` while a body is in its place.
void fade_where_met(LabelPlace& label, const MechanismCameras& cameras, const OccupancyGrid& room);
// Number of frames, by a sample, in which a label in this box is visible, of those with a pose that counts.
double frames_visible(const Box& box, const MechanismCameras& cameras,
                      const std::function<bool(const sim::Pose&)>& counts);
// The place of a label at a frame.
struct WantedPlace {
    Vec2 base;  // the point beside which it is drawn [px]
    Box box;
    std::vector<Box> owner;  // what it belongs to, which it must not hide [px]
};
// Shifts the label of a moving camera in each frame: to the place that is wanted, or else to the nearest one that is
// inside the view and hides neither a body nor the owner. Where that is far, the label is hidden, as while no place is
// wanted because its owner is out of view.
void shift_clear(LabelPlace& label, const MechanismCameras& cameras,
                 const std::function<std::optional<WantedPlace>(const SeenFrame&)>& wanted);
inline constexpr double kLabelFade = 0.2;  // duration of fading a label without a free place [s]
// Hides the label in the frames `met`, and fades it before and after.
void fade_about(LabelPlace& label, const std::vector<int>& met, const FilmContext& context, double lasts = kLabelFade);

}  // namespace beamcam::render
