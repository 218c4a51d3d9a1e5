// What surrounds a plot on a page: labels of the axes, common factors, letter and title, the legend in rows above the
// plot, and the colour bar.
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
    // `lowest`: this panel shows the label of x; `legend`: it shows the legend if it has one.
    PanelNames(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, bool lowest, bool legend);

    // For a plot of about this size, with the ticks chosen for it.
    void fit(const Plot& plot, double width, double height);
    Margins margins() const { return margins_; }  // room that numbers, texts, legend and colour bar need
    double width_of_legend() const { return widest_entry_; }
    // `bar_beside`: the colour bar is to its right and as high; empty: another panel shows the bar.
    void draw(const Plot& plot, const Box& bar_beside) const;

  private:
    struct Label {
        std::vector<std::string> lines;
        double beside = 0;  // height of the lines beside the first
    };
    struct Entry {  // of the legend
        std::string label;
        const Series* series;  // null: a block of a colour, or dots
        Color color;
        bool dots;
        double width;
        Vec2 at;  // of its left end and upper edge, in the legend
    };
    void arrange_legend(double width);
    double legend_height() const;  // with the gap to the plot; 0 without entries
    void draw_sample_of(const Entry& entry, Vec2 left, double width) const;
    void draw_legend(Vec2 top_left) const;
    // The legend's first row is behind a letter that has no title.
    bool has_letter_in_legend() const { return panel_.title.empty() && !panel_.letter.empty() && !entries_.empty(); }
    double letter_width() const;  // with the space behind it; 0: none
    Label broken(std::string label, double room) const;
    TextStyle letter_style() const;
    Margins room_around(const Plot& plot) const;
    double widest(const AxisMap& axis) const;  // of its numbers
    void draw_label_below(const Plot& plot) const;
    void draw_labels_beside(const Plot& plot) const;
    void draw_common_factors(const Plot& plot) const;
    void draw_titles(const Plot& plot, double top, bool alone) const;
    void draw_color_bar(const Plot& plot, const Box& beside) const;
    // Between plot and colour bar, which passes the numbers below plots that share it.
    double before_bar() const { return std::max(2.2 * style_.gap, beyond_right_ + style_.gap); }

    const Panel& panel_;
    const PlotStyle& style_;
    PageCanvas& sheet_;
    bool lowest_;
    Label x_, y_;
    std::vector<std::string> title_;
    double widest_y_ = 0, widest_bar_ = 0, below_ = 0, titles_height_ = 0;
    std::vector<Entry> entries_;
    double widest_entry_ = 0;
    double beyond_left_ = 0, beyond_right_ = 0;  // of the plot, reached by the numbers below it
    Margins margins_;
};

}  // namespace beamcam::render::figure
