// A strip chart over the film's time: axes, a faint curve of what is to come, the curve so far, a cursor.
//
// Curves are reduced to what the pixels can show (first, least, most, last of each column), so drawing costs the
// same for any number of rows. What lies before the cursor is a kept layer shown up to the cursor's column: no stroke
// grows, and any frame in any order gives the same pixels.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "render/canvas.hpp"
#include "render/geometry.hpp"
#include "render/ticks.hpp"

namespace beamcam::render {

// Points in pixels of v(t); NaN rows break the line. `to_pixels` must increase with t.
std::vector<Vec2> decimate(std::span<const double> t, std::span<const double> v,
                           const std::function<Vec2(double, double)>& to_pixels);

struct ChartDot {
    double t = 0, value = 0;
    Color color;
};
struct ChartMark {  // an impact
    double t = 0;
};

struct ChartContent {
    std::string words;   // before the symbol, left out where there is no room: "Hub angle "
    std::string symbol;  // markup with unit, "θ / rad"
    Range value;  // to be shown, in axis units; the axis is widened to round ends               // of the vertical
                  // axis, in axis units
    Range time;   // in axis units
    std::string time_label;    // markup, "t / s"
    std::vector<double> t, v;  // curve, in axis units; may be empty
    bool filled = false;       // area down to zero
    std::vector<ChartDot> dots;
    std::vector<ChartMark> marks;  // ticks at the time axis
    Color color, faint;
};

class Chart {
  public:
    Chart(ChartContent content, Box box, Box plot, double unit);

    Vec2 to_pixels(double t, double v) const;
    void draw_ground(Canvas& canvas, const Palette& palette) const;  // axes, labels, what is to come
    Image past(const Fonts& fonts, const Palette& palette) const;    // as large as `past_box`
    Box past_box() const;
    void draw_cursor(Canvas& canvas, const Palette& palette, double t, double v, const std::string& value) const;
    int cursor_column(double t) const;  // the first column after the cursor

  private:
    std::vector<Vec2> curve() const;
    ChartContent c_;
    Box box_, plot_;
    double unit_;
    Ticks value_ticks_, time_ticks_;
};

}  // namespace beamcam::render
