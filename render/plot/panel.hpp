// A panel on a page: a plot with its legend, its insets, and labels that avoid the curves.
#pragma once

#include <array>
#include <deque>
#include <string>
#include <vector>

#include "render/plot/legend.hpp"
#include "render/plot/panel_names.hpp"

namespace beamcam::render::figure {

class PanelDrawing {
  public:
    // `width`, `height`: about the size of the plot; `lowest`: this panel shows the numbers and label of x.
    PanelDrawing(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, double width, double height,
                 bool lowest, const std::string& what);

    // Room that numbers, labels, colour bar and a legend above need around the plot.
    Margins margins() const;
    double width_of_legend() const { return legend_.width_above(); }  // the least of one above the plot
    // Sets the plot and places labels and legends. False: the legend finds no room; `margins` includes it from now on,
    // so lay out again.
    bool place(const Box& plot);
    void draw();

  private:
    struct Writing {
        Vec2 at;
        std::string markup;
        TextStyle lettering;
        std::optional<std::pair<Vec2, Vec2>> leader;
        std::optional<Box> ground = {};  // hides lines behind the letters
    };

    void fit(double width, double height);
    void make_curves();
    std::array<Vec2, 2> ends(const Rule& rule) const;
    double place_boxes(bool legend_first);
    Box shown_enlarged(const Inset::Source& source) const;
    double place_insets();
    void place_marks();
    Writing best_at_mark(const Mark& mark);
    void place_rules();
    bool place_labels();
    bool place_direct();
    double best_direct(const DrawnCurve& curve, Writing& out);
    double crowding(const Box& box, const DrawnCurve& own) const;

    void draw_backgrounds();
    std::deque<PanelDrawing> draw_inset_backgrounds() const;  // returns the insets, to be drawn

    const Panel& panel_;
    const PlotStyle& style_;
    PageCanvas& sheet_;
    std::string what_;
    Plot plot_;
    PanelNames names_;
    LegendBox legend_;
    std::vector<DrawnCurve> curves_;
    std::optional<OccupancyGrid> taken_;
    std::optional<OccupancyGrid> data_;  // of the curves alone
    struct PlacedInset {
        Box outer;
        double width, height;  // of its plot
    };
    std::vector<std::optional<PlacedInset>> insets_;  // empty: omitted, it would cover data
    std::vector<Writing> writings_;
    bool settled_ = true;
};

// A panel of shapes, without axes, within the box.
void draw_shapes(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, const Box& box);

}  // namespace beamcam::render::figure
