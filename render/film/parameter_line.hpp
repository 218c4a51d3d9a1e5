// The line below the title that says what is filmed: whole pieces, the most important first.
//
// Where they do not fit they stand closer, then smaller; then the rest of them beside the title, where it leaves room;
// then the least important are left out, and can be named before anything is drawn.
#pragma once

#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/film/layout.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

struct ParameterLine {
    struct Piece {
        std::string markup;
        Vec2 baseline;  // left [px]
    };
    double size = 0;  // of the letters [px]
    std::vector<Piece> pieces;
    std::vector<std::string> without_room;  // markup
};

// `canvas` measures only. `title`: plain text.
ParameterLine parameter_line(Canvas& canvas, const Layout& places, const std::string& title,
                             const std::vector<std::string>& pieces);

// The title as it is drawn at full size.
TextStyle title_style(double unit, Color color = {});
// A long title (plain text) becomes smaller, down to two thirds; then it fills two lines; then it is cut where the
// second ends.
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

// What of these a picture of this size, with this layout or the standard one of `members` mechanisms, has no room for,
// in plain words: "the title" or "the end of the title", parameters, "colour scales". Loads fonts, unless there is no
// room for title and parameters. Throws FontError.
std::vector<std::string> without_room(int width, int height, const std::optional<LayoutNode>& layout, int members,
                                      const std::string& title, const std::vector<const sim::Problem*>& problems,
                                      const Shown& shown = {}, bool rpm = false);

// Markup as people type it: "K = 10^8 N m^−1.5".
std::string plain(const std::string& markup);

}  // namespace beamcam::render
