// A figure as a value: panels of curves, bands, marks and shapes in the data's own numbers, with labels as markup
// (render/draw/markup.hpp). Nothing here draws or computes; `draw` puts it on a PageCanvas.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/geometry.hpp"
#include "render/plot/axis.hpp"
#include "render/plot/page_canvas.hpp"
#include "render/plot/style.hpp"

namespace beamcam::render::figure {

struct Series {
    std::string label = {};  // markup; empty: not in the legend
    std::vector<double> x = {}, y = {};
    std::string name = {};            // in the table of data; empty: the label, or the quantity of its axis
    int look = 0;                     // colour, dash and marker, see `look`
    bool line = true;                 // through the points; NaN breaks it
    bool every_point = false;         // a marker at each point
    bool solid = false;               // no dash although the look has one
    bool faded = false;               // lighter and thinner: not reproducible
    std::vector<double> dash = {};    // of films [design px]
    double weight = 1;                // of the line
    std::optional<Color> color = {};  // instead of the look's
    std::vector<double> value = {};   // colours the points by the panel's colour bar; same length as x
    std::vector<double> t = {};       // of a motion, if x is not the time: instants of the points [s], for the data
    bool filled = false;              // of films: the area below it
    Color faint = {};                 // of films: in the future
    void add(double at_x, double at_y) { x.push_back(at_x), y.push_back(at_y); }
};

struct Band {  // between two curves
    std::string label = {};
    std::vector<double> x = {}, low = {}, high = {};
    int look = 0;
    std::optional<Color> color = {};  // instead of the look's, paler
    Color faint = {};                 // of films: in the future
};
struct Dot {  // of films
    double x = 0, y = 0;
    Color color = {}, faint = {};  // faint: in the future
};
// Of films: a tick below the x axis at an instant of the past, in one of the lanes below each other, which are one if
// they are many.
struct EventTick {
    double x = 0;
    Color color = {};
    int lane = 0, lanes = 1;
};
// Points that are too many for marks: drawn as dots, or as an image of their density.
struct Cloud {
    std::string label = {};
    std::vector<double> x = {}, y = {};
    Color color = rgb(0x000000);
    void add(double at_x, double at_y) { x.push_back(at_x), y.push_back(at_y); }
};
// Coloured cells between edges, row by row from the lowest y; some may be transparent. Equal cells become an image.
struct Cells {
    std::vector<double> x, y;  // edges, in the order of the axes: one more than columns, than rows
    std::vector<Color> colors;
    std::vector<double> values = {};  // of the cells, for the data; may be empty
};
struct Swatch {  // an entry of the legend that is a colour
    std::string label;
    Color color;
};
struct Span {  // of films: an interval of x, over the whole height
    double from = 0, to = 0;
    std::string label = {};
    Color color = {};
};
struct Rule {  // a thin line across the panel
    double at = 0;
    bool vertical = false;
    std::string label = {};
};
struct Mark {  // a point with its value
    double x = 0, y = 0;
    std::string label = {};
    int look = 0;
    bool hollow = false;
};

struct ColorBar {
    std::string label = {};
    Scale scale = Scale::linear;
    std::optional<double> from = {}, to = {};
    bool is_signed = false;  // signed_color, from −to to `to`; else map_color
    bool root = false;       // colours follow the square root of the share, beyond 2 % of the largest
    bool operator==(const ColorBar&) const = default;
};
// The colour at this place of the bar, 0…1.
Color color_of(const ColorBar& bar, double place);

// Drawn shapes of a panel without axes, in its own plane (Y up); everything must fit, proportions stay true.
struct Shape {
    enum class Kind { line, area, circle, disc, arrow, turn, label };
    Kind kind = Kind::line;
    std::vector<Vec2> points = {};  // line, area; arrow and turn: from, to; label: where
    Vec2 centre = {};               // circle, disc, turn
    double radius = 0;              // [data]
    double radius_points = 0;       // instead: on paper [pt]
    double from = 0, to = 0;        // turn: counter-clockwise [rad], with an arrow head at `to`
    Color color = {};
    double width = 0;               // of the line [pt]; 0: the style's
    std::vector<double> dash = {};  // in widths
    std::string markup = {};        // label
    Vec2 shift = {};                // of the label, in sizes of its letters, y up
    HAlign align = HAlign::centre;
    VAlign valign = VAlign::middle;
};

struct Panel {
    std::string letter = {};   // "a": "(a)" in the upper left corner
    std::string title = {};    // markup, beside the letter
    std::string caption = {};  // markup: what it shows, after its letter in the caption of the figure
    Axis x{.tight = true}, y = {};
    std::vector<Series> series = {};
    std::vector<Band> bands = {};
    std::vector<Cells> cells = {};
    std::vector<Cloud> clouds = {};
    std::vector<Dot> dots = {};
    std::vector<EventTick> events = {};
    std::vector<Swatch> swatches = {};
    std::vector<Span> spans = {};
    std::vector<Rule> rules = {};
    std::vector<Mark> marks = {};
    std::optional<ColorBar> color_bar = {};
    std::vector<Shape> shapes = {};  // not empty: no axes
    bool legend = true;              // above the plot: the labels of series, bands, clouds and swatches
    double share = 1;                // of the height, among stacked panels
    std::string name = {};           // for the data and messages: "theta"
};

struct Figure {
    std::string name = {};   // "free-fall"
    std::string title = {};  // markup, for the caption and the file's properties
    std::vector<Panel> panels = {};
    bool stack = false;     // panels above each other however wide the page; else side by side where there is room
    bool in_pairs = false;  // two panels side by side however narrow the page
    bool share_x = false;   // stacked panels have one x axis: numbers and label below the last
    double aspect = 0.66;   // height by width of one column
    std::optional<double> height = {};  // [mm]; instead of what follows from the aspect
    std::string caption = {};           // markup: the parameters
    std::string accuracy = {};          // markup: tolerance and energy balance; ends the caption
};

struct Page {
    double width = 90, height = 60;  // [mm]
    PlotStyle style;
};
// The page for a figure in a column, or of another width [mm].
Page page_of(const Figure& figure, const Column& column, std::optional<double> width = {});

// Throws PictureError when a panel has nothing to show, FontError for missing glyphs.
void draw(const Figure& figure, const Page& page, PageCanvas& sheet);

// The plotted numbers with 17 significant digits; a cell is empty where a curve has no point. Curves over the same x,
// or of motions, are columns after one with x or the time t, in whose order the rows are; where a curve jumps, an
// instant has two rows. Figures with cells, clouds of points or shapes have a line a point: panel, series, names and
// values.
std::string data_csv(const Figure& figure);

// True when some text of the figure needs the Chinese face.
bool needs_chinese(const Figure& figure);

}  // namespace beamcam::render::figure
