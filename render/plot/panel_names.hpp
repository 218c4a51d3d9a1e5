// The texts around a plot on a page: labels of the axes, common factors, letter and title, and the colour bar.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "render/plot/plot.hpp"

namespace beamcam::render::figure {

struct Margins {
    double left = 0, right = 0, top = 0, bottom = 0;  // [pt]
};

class PanelNames {
  public:
    // `lowest`: this panel shows the label of x.
    PanelNames(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, bool lowest)
        : panel_(panel), style_(style), sheet_(sheet), lowest_(lowest) {}

    // For a plot of about this size, with the ticks chosen for it.
    void fit(const Plot& plot, double width, double height);
    Margins margins() const { return margins_; }             // room that numbers, texts and colour bar need
    double titles_height() const { return titles_height_; }  // of letter and title above the plot; 0: none
    double letter_width() const;                             // with the space behind it; 0: none
    // `top`: baseline of letter and title; they are directly above the plot if nothing else is.
    void draw(const Plot& plot, double top, bool legend_above, const Box& bar_beside) const;

  private:
    struct Label {
        std::vector<std::string> lines;
        double beside = 0;  // height of the lines beside the first
    };
    Label broken(std::string label, double room) const;
    TextStyle letter_style() const;
    Margins room_around(const Plot& plot) const;
    double widest(const AxisMap& axis) const;  // of its numbers
    void draw_label_below(const Plot& plot) const;
    void draw_labels_beside(const Plot& plot) const;
    void draw_key_of_axis(bool right, const std::string& first_line, Vec2 middle) const;
    void draw_common_factors(const Plot& plot) const;
    void draw_titles(const Plot& plot, double top, bool alone) const;
    void draw_color_bar(const Plot& plot, const Box& beside) const;
    // Between plot and colour bar, which passes the numbers below plots that share it.
    double before_bar() const { return std::max(2.2 * style_.gap, beyond_right_ + style_.gap); }

    const Panel& panel_;
    const PlotStyle& style_;
    PageCanvas& sheet_;
    bool lowest_;
    Label x_, y_, right_;
    std::vector<std::string> title_;
    double widest_y_ = 0, widest_right_ = 0, widest_bar_ = 0, below_ = 0, titles_height_ = 0;
    double beyond_left_ = 0, beyond_right_ = 0;  // of the plot, reached by the numbers below it
    Margins margins_;
};

}  // namespace beamcam::render::figure
