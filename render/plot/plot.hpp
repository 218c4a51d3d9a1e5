// A plot: its axes with ticks, numbers and frame, and the data between them, on pages and in films.
//
// The style decides what differs: a page has a frame with ticks that point inwards; a film has grid lines at the
// numbers and the name of x among its numbers. Texts around a plot are added by PanelNames on a page and by Chart in a
// film.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "render/plot/figure.hpp"

namespace beamcam::render::figure {

// Of films: the data of an interval of time, from the last row before it on. The past ends at its end; the future,
// which is fainter, at the first row after it.
struct Interval {
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
    bool past = true;
};

enum class Side { left, right, top, bottom };

class Plot {
  public:
    // `panel` and `style` must live as long. `lowest`: this panel shows the numbers of x.
    Plot(const Panel& panel, const PlotStyle& style, std::string what, bool lowest = true)
        : panel_(&panel), style_(&style), lowest_(lowest), what_(std::move(what)) {}

    void fit(const Painter& on, double width, double height);  // chooses the ticks for a plot of about this size
    void place(const Painter& on, const Box& box) { box_ = box, fit(on, box.w, box.h); }
    void move_data(Vec2 by) { shift_ = by; }  // draws the data elsewhere than the axes
    // In films: another interval of x, whose numbers move with time.
    void show_x(const Painter& on, double from, double to);

    const Box& box() const { return box_; }
    Vec2 at(double x, double y) const;
    // On a page clamped, because Cairo's numbers are limited; in films those of an interval, reduced to columns of
    // pixels.
    std::vector<Vec2> points(const std::vector<double>& x, const std::vector<double>& y,
                             const Interval& part = {}) const;
    // Rounding decides to which column of pixels a point belongs: each medium keeps its own order of multiplication.
    double along_x(double x) const { return box_.x + (style_->palette ? x_->place(x, box_.w) : box_.w * x_->place(x)); }
    double along_y(double y) const { return box_.bottom() - box_.h * y_->place(y); }
    // By the colour bar; none for NaN, and for a value <= 0 on a log bar.
    std::optional<Color> color_at(double value) const {
        const double place = bar_->place(value);
        return std::isnan(place) ? std::nullopt : std::optional(color_of(*panel_->color_bar, place));
    }
    const AxisMap& x() const { return *x_; }
    const AxisMap& y() const { return *y_; }
    const std::optional<AxisMap>& bar() const { return bar_; }

    // How much the numbers below the plot are lowered so that they do not touch those beside it at a corner.
    double drop(const Painter& on) const;
    // Of films: from the axis down to the baseline of its numbers [px].
    double numbers_below() const { return 9 * style_->unit + style_->numbers; }
    void draw_x_axis(Painter& on) const;
    void draw_y_axis(Painter& on) const;
    void draw_frame(Painter& on) const;
    // Ticks and numbers of a page, which point into `box`.
    void draw_page_ticks(Painter& on, const AxisMap& axis, const Box& box, Side side, bool labelled, double major,
                         double minor) const;

    void draw_bands(Painter& on, const Interval& part = {}) const;
    void draw_data(Painter& on, const Interval& part) const;  // these, and spans and curves; films

  private:
    void fit_x(const Painter& on, const Axis& axis, const Extent& data);
    void draw_dots_and_events(Painter& on, const Interval& part) const;
    void draw_spans(Painter& on, const Interval& part, bool names) const;
    void draw_curve(Painter& on, const Series& curve, const Interval& part) const;

    const Panel* panel_;
    const PlotStyle* style_;
    bool lowest_, moves_ = false;  // moves: the numbers of x
    std::string what_;
    std::optional<AxisMap> x_, y_, bar_;
    Box box_;
    Vec2 shift_;
    double width_ = 0, height_ = 0;
};

Pen curve_pen(const Series& series, const PlotStyle& style);
Color color_of(const Series& series);

}  // namespace beamcam::render::figure
