// The axes of a panel: maps data to the page and draws frame, ticks, numbers, labels and colour bar.
#pragma once

#include <optional>
#include <string>

#include "render/plot/figure.hpp"
#include "render/plot/tick_marks.hpp"

namespace beamcam::render::figure {

struct Margins {
    double left = 0, right = 0, top = 0, bottom = 0;  // [pt]
};
inline Box without(const Box& outer, const Margins& m) {
    return {outer.x + m.left, outer.y + m.top, outer.w - m.left - m.right, outer.h - m.top - m.bottom};
}

class PlotAxes {
  public:
    // `lowest`: this panel shows the numbers and label of x.
    PlotAxes(const Panel& panel, const PrintStyle& style, PageCanvas& sheet, bool lowest, std::string what)
        : panel_(panel), style_(style), sheet_(sheet), lowest_(lowest), what_(std::move(what)) {}

    void fit(double width, double height);  // chooses the ticks for a plot of about this size
    void place(const Box& plot) { plot_ = plot, fit(plot.w, plot.h); }

    const Box& plot() const { return plot_; }
    Vec2 at(double x, double y, bool right = false) const;
    double along_x(double x) const { return plot_.x + plot_.w * x_->place(x); }
    double along_y(double y) const { return plot_.bottom() - plot_.h * y_->place(y); }
    double color_share(double value) const { return bar_ ? bar_->place(value) : 0; }

    // Room that numbers, labels and colour bar need around the plot.
    Margins margins() const;
    double drop() const;
    std::vector<std::string> label_lines(const AxisMap& axis) const;
    double titles_height() const;  // of letter and title above the plot; 0: none
    void draw_frame() const;
    // `top`: baseline of letter and title; they are directly above the plot if nothing else is.
    void draw_titles(double top, bool legend_above) const;
    void draw_color_bar() const;

  private:
    std::vector<std::string> title_lines() const;
    double label_height(const AxisMap& axis) const;           // of the lines beside the first
    double widest(const std::optional<AxisMap>& axis) const;  // of its numbers
    // Ticks point inwards.
    void draw_ticks(const AxisMap& axis, const Box& plot, Side side, bool labelled, double major, double minor) const;
    void draw_labels() const;

    const Panel& panel_;
    const PrintStyle& style_;
    PageCanvas& sheet_;
    bool lowest_;
    std::string what_;
    std::optional<AxisMap> x_, y_, right_, bar_;
    double widest_y_ = 0, widest_right_ = 0, widest_bar_ = 0;
    Box plot_;
    double width_ = 0, height_ = 0;  // of the plot
};

}  // namespace beamcam::render::figure
