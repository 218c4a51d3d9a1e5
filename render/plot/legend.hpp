// The legend of a panel, in rows above the plot.
#pragma once

#include <string>
#include <vector>

#include "render/plot/plot.hpp"

namespace beamcam::render::figure {

class LegendAbove {
  public:
    LegendAbove(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, bool shown);

    void fit(double width);  // arranges the entries in rows of this width
    bool empty() const { return entries_.empty(); }
    double height() const;                          // with the gap to the plot; 0 without entries
    double least_width() const { return widest_; }  // that of the widest entry
    double baseline() const;                        // of the first row, from the top
    void draw(Vec2 top_left) const;

  private:
    struct Entry {
        std::string label;
        const Series* series;  // null: a block of a colour, or dots
        Color color;
        bool dots;
        double width;
        Vec2 at;  // of its left end and upper edge, in the legend
    };
    void draw_sample(const Entry& entry, Vec2 left, double width) const;

    const PlotStyle& style_;
    PageCanvas& sheet_;
    std::vector<Entry> entries_;
    double widest_ = 0;
};

}  // namespace beamcam::render::figure
