// A strip chart of a film: a plot whose curves are faint in the future and strong in the past, with a heading, a cursor
// and readings; over the time of the whole film, or over a window of time that moves with the instant. Its first curves
// may have a row each, with the same axes.
//
// Over the whole film the past is an image, drawn once, of which the columns up to a few before the cursor are shown;
// these few are drawn from the rows up to the instant. Thus no later row is ever drawn as past.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/draw/geometry.hpp"
#include "render/plot/plot.hpp"

namespace beamcam::render {

Range window_around(double t, double length);  // the time that a moving window shows [s]

struct ChartContent {
    std::string words = {};             // before the name of y, if there is space: "Contact point on the beam "
    std::string short_words = {};       // otherwise these, if there is space: "Contact point "
    bool past_only = false;             // the curves are drawn up to the cursor
    std::string instead = {};           // text that replaces the axis if there are no values: "no contact"
    figure::Panel panel = {};           // x is time [s]
    std::optional<double> window = {};  // [s]
    bool names_first = false;  // rather the names of the curves than their readings, if only one of them has room
    std::size_t rows = 1;      // the first curves that have a row each, where there is room; the others are in all rows

    Range time() const { return {*panel.x.from, *panel.x.to}; }
    Range values() const { return {*panel.y.from, *panel.y.to}; }
    // `unit`: of the numbers [s].
    void set_time(const Range& time, double unit, std::string label);
    // `symbol`: markup, `unit`: "" for none. The axis is widened to round ends.
    void set_values(const Range& values, const std::string& symbol, const std::string& unit);
};

class Chart {
  public:
    // `box`: of heading, plot and numbers. `fonts` measure the numbers.
    Chart(ChartContent content, const Box& box, const Box& plot, const figure::PlotStyle& style, const Fonts& fonts);
    Chart(const Chart&) = delete;
    Chart& operator=(const Chart&) = delete;

    void draw_background(Canvas& canvas) const;  // axes, labels, the future
    // The curves until t, and the cursor, which is only within the time of the chart. `readings`: the values of the
    // curves at the cursor; NaN: none. `peaks`: points of the curves that have their value above them; NaN: none.
    void draw_moving(Canvas& canvas, double t, std::span<const double> readings,
                     std::span<const Vec2> peaks = {}) const;
    // The same of a chart of the past alone whose rows have a time each.
    void draw_rows(Canvas& canvas, std::span<const double> times, std::span<const double> readings,
                   std::span<const Vec2> peaks) const;
    Range time() const { return c_.time(); }

  private:
    static constexpr double kAround = 8;  // above and beside the plot that the past may reach [px]
    bool windowed() const { return c_.window.has_value(); }
    Box past_box() const {
        const Box around = area_.inset(-kAround);
        return {around.x, around.y, around.w, around.h - kAround + std::ceil(plots_[0].numbers_below())};
    }
    void make_rows(const Fonts& fonts);
    void draw_peaks(Canvas& canvas, const std::vector<figure::Plot>& rows, std::span<const double> cursors,
                    std::span<const Vec2> peaks) const;
    // The first column that may hold future at t: the stroke of a later row may reach into it.
    int past_column(double t) const;
    void draw_whole_past(const Fonts& fonts);
    figure::Interval whole(bool past) const { return {time().low, time().high, past}; }
    int cursor_column(const Range& view, double t) const;
    // `along`: the box of the line; `first`: the curve of the first reading.
    void draw_cursor(Canvas& canvas, double x, const Box& along, std::span<const double> readings,
                     std::size_t first = 0) const;

    TextStyle heading_style() const;
    TextStyle reading_style(Color color) const;
    Color reading_color(std::size_t curve) const;
    void draw_heading(Canvas& canvas) const;
    std::string heading_text(Canvas& canvas) const;
    std::string reading_text(double value) const;
    double widest_reading(Canvas& canvas) const;  // [px]
    void draw_readings(Canvas& canvas, std::span<const double> readings) const;
    double reading_width(Canvas& canvas, bool names, bool values) const;  // of all readings together [px]

    ChartContent c_;
    Box box_, area_;  // area: of all rows
    figure::PlotStyle style_;
    const Palette& palette_;
    std::vector<figure::Panel> panels_;  // of the rows
    std::vector<figure::Plot> plots_;
    Image past_;      // all curves as past, of the size of `past_box`; empty with a window, or if nothing else is drawn
    int digits_ = 0;  // decimals of the reading
};

}  // namespace beamcam::render
