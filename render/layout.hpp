// Where things stand in a film's frame, for any size: wide, square, tall, odd, tiny.
//
// Type and spacing scale with the frame but never below half of their full-size value, where text stops being
// readable; what then no longer fits is left out (charts first, then the lines of text) rather than overlapped.
#pragma once

#include <optional>
#include <vector>

#include "render/geometry.hpp"

namespace beamcam::render {

enum class ChartKind { angle, force, position, deflection };  // in this order of importance

struct ChartSlot {
    ChartKind kind = ChartKind::angle;
    Box box;   // title, labels and all
    Box plot;  // the axes, whole pixels
};

struct Layout {
    double unit = 1;           // [px] of one design pixel (1920×1080)
    Box mechanism;             // whole pixels
    std::optional<Box> title;  // line boxes; text stands on `baseline(box)`
    std::optional<Box> parameters;
    std::optional<Box> clock;   // with the pills
    std::optional<Box> scales;  // colour bars
    std::optional<Box> note;    // accuracy
    std::vector<ChartSlot> charts;
};

// width, height >= 1. `charts` that the film has data for.
Layout layout(int width, int height, const std::vector<ChartKind>& charts);

}  // namespace beamcam::render
