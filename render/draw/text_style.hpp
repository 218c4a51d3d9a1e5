// How a text stands: on a picture (Canvas) in pixels, on a sheet of paper (figure::PageCanvas) in points.
#pragma once

#include <optional>

#include "render/draw/color.hpp"
#include "render/draw/geometry.hpp"

namespace beamcam::render {

enum class Weight { regular, medium, semibold, bold };
enum class HAlign { left, centre, right };
enum class VAlign {
    baseline,
    top,
    middle,
    bottom
};  // what of the text stands at the point; ink of digits and capitals

struct TextStyle {
    double size = 16;
    Color color = {};
    Weight weight = Weight::regular;
    HAlign align = HAlign::left;
    VAlign valign = VAlign::baseline;
    double max_width = 0;            // of pictures, > 0: cut with an ellipsis there
    std::optional<Color> halo = {};  // of pictures: outline that keeps the text legible over drawings
    double turned = 0;               // on paper: counter-clockwise [rad]
};

}  // namespace beamcam::render
