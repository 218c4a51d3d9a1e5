// The title, and the line of parameters below it: whole items, the most important first. Letters have two sizes; where
// the smaller one has no room, a title ends with an ellipsis, and the last parameters are left out.
#pragma once

#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/film/layout.hpp"
#include "render/plot/labels.hpp"
#include "render/plot/user_text.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

struct ParameterLine {
    struct Piece {
        std::string markup;
        Vec2 baseline;  // left [px]
    };
    double size = 0;  // size of the letters [px]
    std::vector<Piece> pieces;
};

// `canvas` is only used for measuring.
ParameterLine parameter_line(const Canvas& canvas, const Layout& places, const std::vector<std::string>& pieces);

// Style of the title at full size.
TextStyle title_style(const Letters& letters, Color color = {});
// On one line in two sizes, else on two in that of headings, of which the first ends between words.
std::vector<FittedText> fitted_title(const Canvas& canvas, const std::string& title, const Box& box,
                                     const Letters& letters);

}  // namespace beamcam::render
