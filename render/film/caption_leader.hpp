// The line that connects a caption with its anchor.
#pragma once

#include <vector>

#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

struct CaptionLeader {
    std::vector<Vec2> points;  // [px]
    bool crosses_label = false;
};

// From under the caption's box, at a place from which the line crosses none of the `labels` if there is one.
CaptionLeader straight_leader(const MechanismScene& scene, const std::vector<Box>& labels, const Box& plate, Vec2 foot);
// The same to a point on the rim of the disc, with a corner if the line would otherwise cross the disc.
CaptionLeader leader_around_disc(const MechanismScene& scene, const std::vector<Box>& labels, const Box& plate,
                                 Vec2 foot);

}  // namespace beamcam::render
