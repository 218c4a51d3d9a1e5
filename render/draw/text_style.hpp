// Style and alignment of a text: on pictures (Canvas) in pixels, on pages (figure::PageCanvas) in points.
#pragma once

#include <optional>

#include "render/draw/color.hpp"
#include "render/draw/geometry.hpp"

namespace beamcam::render {

enum class Weight { regular = 400, medium = 500, semibold = 600, bold = 700 };  // as in Pango
enum class HAlign { left, centre, right };
enum class VAlign {
    baseline,
    top,
    middle,
    bottom
};  // which part of the text is at the point; digits and capitals count

struct TextStyle {
    double size = 16;
    Color color = {};
    Weight weight = Weight::regular;
    HAlign align = HAlign::left;
    VAlign valign = VAlign::baseline;
    double max_width = 0;            // pictures only; > 0: truncated with an ellipsis
    std::optional<Color> halo = {};  // outline that keeps the text readable over drawings
    bool tabular = false;            // pictures only: digits of equal width, so that a changing number does not jitter
    double turned = 0;               // pages only: rotation, counter-clockwise [rad]
};

}  // namespace beamcam::render
