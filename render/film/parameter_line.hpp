// The title, which ends with an ellipsis where it has no room in two lines; and the parameters below it: whole items,
// the most important first, in as many lines as their box has. The last ones without room are left out.
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
// On one line in two sizes, else on two in the smallest size, of which the first ends between words.
std::vector<FittedText> fitted_lines(const Canvas& canvas, const std::string& text, TextStyle style, double smaller,
                                     double smallest, double width);

}  // namespace beamcam::render
