// Places of the labels of a mechanism. Each label keeps one place over the whole film: the nearest to its owner that no
// moving part ever meets. A label far from its owner gets a leader line, that of forces that are very far a sample of
// their arrow. A label without a free place, or an angle's without one near its arc, fades out while a part moves
// through it.
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "render/draw/geometry.hpp"
#include "render/plot/ticks.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

struct MechanismView;
class Canvas;
class MechanismCameras;
class OccupancyGrid;
class SweptRegion;

// A contact force as it is drawn.
struct ForceArrow {
    Vec2 foot, normal;     // [m]
    double force = 0;      // [N]
    bool is_peak = false;  // the largest force of a contact that is shorter than two frames
};

struct LabelPlace {
    Vec2 base;                   // the point beside which it is placed [m]
    Vec2 offset, size;           // of its middle from the base as seen, whatever the zoom [px]
    std::vector<float> opacity;  // of each frame; empty: always 1
    std::vector<Vec2> shifts;    // of each frame, from that offset, before a moving camera; empty: none [px]
    bool has_sample = false;     // it begins with a sample of its arrow

    double opacity_at(int frame) const { return opacity.empty() ? 1 : opacity[static_cast<std::size_t>(frame)]; }
    Vec2 offset_at(int frame) const {
        return shifts.empty() ? offset : offset + shifts[static_cast<std::size_t>(frame)];
    }
};

struct MechanismLabels {
    double speed_way = -0.30 * std::numbers::pi;  // direction from the cam's axis to the arrow of its speed [rad]
    double arc_radius = 0;                        // radius of the arc of θ [px]
    std::optional<LabelPlace> angle, speed, force;
    std::vector<std::optional<Box>> captions;  // of the film; none: it moves with its part [px]
};

struct LabelNeeds {
    Range angles;                    // range of θ over the film, as drawn [rad]
    double arc_room = 0;             // largest radius of the arc of θ that fits into the panel [px]
    std::vector<ForceArrow> arrows;  // of every frame with a force
    std::vector<int> frames;         // … and these frames
};

// Places the labels and covers their boxes in both regions. `in_contact`: the region swept in frames that show a force,
// which is all that the label of the force has to avoid.
MechanismLabels place_labels(const MechanismView& at, const MechanismCameras& cameras, const LabelNeeds& needs,
                             SweptRegion& swept, SweptRegion& in_contact);

// The place of the label of the force; at least one arrow.
LabelPlace place_force_label(const MechanismView& at, const MechanismCameras& cameras, const LabelNeeds& needs,
                             const OccupancyGrid& room, Canvas& canvas);

// Largest radius of an arc about the hub's axis that stays before the disc at every angle of the cam [m].
double arc_before_cam(const sim::Cam& cam);

// Texts of the labels.
std::string speed_label(const MechanismView& at);
std::string force_label(const MechanismView& at, const ForceArrow& arrow);
// Size of the letters of the cam's speed and of the force [px].
double label_size(const MechanismView& at);
// Smallest size of single letters on a mechanism [px].
double least_letter(const MechanismView& at);
// Size of a design pixel of the letter θ [px].
double angle_letter(const MechanismView& at);

}  // namespace beamcam::render
