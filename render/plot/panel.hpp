// A panel on a page: a plot with its names, and labels at fixed places beside marks and rules.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/plot/panel_names.hpp"

namespace beamcam::render::figure {

class PanelDrawing {
  public:
    // `width`, `height`: about the size of the plot; `lowest`: this panel shows the numbers and label of x; `legend`:
    // it shows the legend if it has one.
    PanelDrawing(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, double width, double height,
                 bool lowest, bool legend, const std::string& what);

    Margins margins() const { return names_.margins(); }  // room that names and numbers need around the plot
    double width_of_legend() const { return names_.width_of_legend(); }
    // Sets the plot; the margins may change with the numbers and with the lines of labels.
    void place(const Box& plot);
    // `bar_beside`: the colour bar is to its right and as high; empty: another panel shows the bar.
    void draw(const Box& bar_beside) const;

  private:
    std::array<Vec2, 2> ends(const Rule& rule) const;
    std::vector<Rule> distinct_rules() const;
    void draw_backgrounds() const;
    void draw_data() const;
    void label_marks() const;
    void label_rules() const;

    const Panel& panel_;
    const PlotStyle& style_;
    PageCanvas& sheet_;
    Plot plot_;
    PanelNames names_;
};

// A panel of shapes, without axes, within the box.
void draw_shapes(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, const Box& box);

}  // namespace beamcam::render::figure
