// A strip chart of a film: axes, faint curves of the future, strong curves of the past, a cursor; over the time of the
// whole film, or over a window of time that moves with the instant.
//
// Curves are reduced to the resolution of the pixels (first, least, greatest, last value of each column), so the cost
// of drawing does not depend on the number of rows. Over the whole film the past is a cached layer that is shown up to
// a few columns before the cursor; these columns are drawn from the rows up to the instant. Thus no later row is ever
// drawn as past, and frames have the same pixels in any order.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/draw/geometry.hpp"
#include "render/plot/tick_marks.hpp"

namespace beamcam::render {

struct ChartCurve {
    std::vector<double> t, v;  // [s], SI units; may be empty
    Color color, faint;
    std::string label = {};  // markup; beside the reading
    std::vector<double> dash = {};
    std::vector<Range> pale_within = {};  // ascending; there the past is drawn in `pale` [s]
    Color pale = {};
};
struct ChartDot {
    double t = 0, value = 0;
    Color color, faint;  // faint: in the future
};
// The instant of an impact: a tick at the time axis, in one of the lanes above each other.
struct ChartMark {
    double t = 0;  // [s]
    Color color;
    int lane = 0, lanes = 1;
};
// The area between two curves of the same instants.
struct ChartBand {
    std::vector<double> low, high;
    Color color;
};

Range window_around(double t, double length);  // the time that a moving window shows [s]

struct ChartContent {
    std::string words;             // before the symbol, if there is space: "Contact point on the beam "
    std::string short_words = {};  // otherwise these, if there is space: "Contact point "
    std::string symbol;            // markup: θ; may be empty
    std::string unit;              // "rad", "N", "" for none
    Range value;                   // of the axis, which is widened to round ends
    Range time;                    // of the film [s]
    std::optional<double> window;  // [s]
    double time_unit = 1;          // [s]
    // Unit of the readings, which choose their prefix as labels beside the mechanism do; empty: the axis's unit and
    // prefix.
    std::string reading_unit = {};
    std::string time_label;    // markup, "t / s"
    std::string instead = {};  // text that replaces the axis if there are no values: "no contact"
    bool names_first = false;  // rather the names of the curves than their readings, if only one of them has room
    std::vector<ChartCurve> curves;
    std::vector<double> band_times;  // [s]
    std::vector<ChartBand> bands;
    bool filled = false;  // area under the first curve down to zero
    std::vector<ChartDot> dots;
    std::vector<ChartMark> marks;
};

class Chart {
  public:
    Chart(ChartContent content, const Box& box, const Box& plot, const ChartStyle& style);

    void draw_background(Canvas& canvas) const;  // axes, labels, the future
    // All curves as past, of the size of `past_box`; columns up to `past_column` may be shown. Empty with a window.
    Image past(const Fonts& fonts) const;
    Box past_box() const;
    // The first column that may hold future at t: the stroke of a later row may reach into it.
    int past_column(double t) const;
    // The moving part: the last columns of the curves until t, with a window all columns. `readings`: the values of the
    // curves at the cursor; NaN: none.
    void draw_moving(Canvas& canvas, double t, std::span<const double> readings) const;
    Range time() const { return c_.time; }
    bool windowed() const { return c_.window.has_value(); }

  private:
    Range whole() const { return c_.time; }
    double x(const Range& view, double t) const;
    double y(double v) const { return plot_.bottom() - plot_.h * axis_.place(v); }
    int cursor_column(const Range& view, double t) const;
    void draw_time_axis(Canvas& canvas, const Range& view) const;

    // Rows between two instants, drawn as past or as future.
    struct Segment {
        Range view;  // the time along the plot
        Range rows;
        bool past = false;
        Vec2 shift = {};  // of the picture
    };
    void draw_curves(Canvas& canvas, const Segment& segment) const;
    void draw_bands(Canvas& canvas, const Segment& segment) const;
    void draw_line(Canvas& canvas, const ChartCurve& curve, const Segment& segment) const;
    void draw_dots_and_marks(Canvas& canvas, const Segment& segment) const;
    Vec2 place(const Segment& segment, double t, double v) const;
    std::vector<Vec2> points(const std::vector<double>& t, const std::vector<double>& v, const Segment& segment) const;

    TextStyle heading_style() const;
    TextStyle reading_style(Color color) const;
    void draw_heading(Canvas& canvas) const;
    std::string reading_text(double value) const;
    double widest_reading(Canvas& canvas) const;  // [px]
    void draw_readings(Canvas& canvas, std::span<const double> readings) const;
    double reading_width(Canvas& canvas, bool names, bool values) const;  // of all readings together [px]

    ChartContent c_;
    Box box_, plot_;
    ChartStyle style_;
    AxisMap axis_;
    int digits_ = 0;  // decimals of the reading
};

}  // namespace beamcam::render
