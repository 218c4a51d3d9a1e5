// The line of parameters below the title: whole items, the most important first.
//
// If they do not fit, gaps shrink, then letters; then the rest goes beside the title if there is space; then the least
// important items are omitted. The omitted ones are known before anything is drawn.
#pragma once

#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/film/layout.hpp"
#include "render/plot/labels.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

struct ParameterLine {
    struct Piece {
        std::string markup;
        Vec2 baseline;  // left [px]
    };
    double size = 0;  // size of the letters [px]
    std::vector<Piece> pieces;
    std::vector<std::string> omitted;  // markup
};

// `canvas` is only used for measuring. `title`: plain text.
ParameterLine parameter_line(Canvas& canvas, const Layout& places, const std::string& title,
                             const std::vector<std::string>& pieces);

// Style of the title at full size.
TextStyle title_style(double unit, Color color = {});
// A long title (plain text) gets smaller letters, down to two thirds; then two lines; then it is truncated at the end
// of the second line.
struct FittedTitle {
    struct Line {
        std::string markup;
        Vec2 baseline;
    };
    TextStyle style;
    std::vector<Line> lines;
    bool cut = false;
};
FittedTitle fitted_title(Canvas& canvas, const std::string& title, const Box& box, double unit, Color color = {});

// The texts for which a picture of this size, with this layout or the standard one of `members` mechanisms, has no
// space: "the title" or "the end of the title", parameters, "colour scales". Loads fonts, unless there is no space for
// title and parameters. Throws FontError.
std::vector<std::string> omitted_text(int width, int height, const std::optional<LayoutNode>& layout, int members,
                                      const std::string& title, const std::vector<const sim::Problem*>& problems,
                                      const Shown& shown = {}, SpeedUnit unit = {});

}  // namespace beamcam::render
