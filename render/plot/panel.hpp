// One panel on a sheet: its axes laid out in a box, then drawn with everything in them.
#pragma once

#include <string>
#include <vector>

#include "render/plot/figure.hpp"
#include "render/plot/placement.hpp"

namespace beamcam::render::figure {

struct Margins {
    double left = 0, right = 0, top = 0, bottom = 0;  // [pt]
};

class PanelDrawing {
  public:
    // Works the axes out for a plot of about this size; `lowest`: x numbers and label are written here.
    PanelDrawing(const Panel& panel, const Style& style, Sheet& sheet, double width, double height, bool lowest,
                 const std::string& what);

    // Room that numbers, labels, colour bar and a legend above need around the plot.
    Margins margins() const;
    // Fixes the plot; then labels and legends look for their places. False: the legend finds none; its room is in
    // `margins` from now on, so lay out again.
    bool place(const Box& plot);
    void draw();

  private:
    struct Curve {
        const Series* series = nullptr;
        std::vector<Vec2> points;              // on the sheet
        std::vector<std::vector<Vec2>> bands;  // outlines of where it swings too fast to be told apart; not in `line`
        std::vector<Vec2> line;                // what is drawn as a line, for curves without values
        std::vector<double> value;             // colour shares, for curves with values
    };
    struct Writing {
        Vec2 at;
        std::string markup;
        Lettering lettering;
        std::optional<std::pair<Vec2, Vec2>> leader;
    };

    Vec2 at(double x, double y, bool right = false) const;
    Lettering words() const;
    Lettering numbers() const;
    void make_axes(double width, double height);
    void make_curves();
    void lighten(Curve& curve) const;
    static void thin_out_tones(Curve& curve, const std::vector<std::size_t>& kept);
    double place_boxes(bool legend_first);
    Box shown_enlarged(const Inset::Source& source) const;
    double place_insets();
    void place_marks();
    void place_rules();
    bool place_labels();
    bool place_direct();
    bool place_legend();
    Box legend_size();
    double best_direct(const Curve& curve, Writing& out);
    double crowding(const Box& box, const Curve& own) const;

    void draw_grounds();
    void draw_curves();
    void draw_curve(const Curve& curve);
    void draw_bands(const Curve& curve, Pen pen);
    void draw_marks();
    void draw_frame();
    void draw_ticks(const AxisMap& axis, char side, bool labelled);
    void draw_titles();
    void draw_color_bar();
    void draw_insets();
    void draw_legend();
    void legend_sample(const Series& s, Vec2 left, double width);
    void marker(Marker shape, Vec2 p, double radius, Color color, bool hollow);

    const Panel& panel_;
    const Style& style_;
    Sheet& sheet_;
    bool lowest_;
    std::string what_;
    std::vector<AxisMap> x_, y_, right_, bar_;  // one or none
    double widest_y_ = 0, widest_right_ = 0, widest_bar_ = 0;
    Box plot_;
    std::vector<Curve> curves_;
    std::vector<OccupancyGrid> taken_;  // one
    std::vector<Box> inset_outer_;
    std::vector<Writing> writings_;
    bool legend_above_ = false, settled_ = true;
    double legend_above_height_ = 0, legend_entry_ = 0;
    int legend_columns_ = 1;
    std::optional<Box> legend_box_;
};

Pen curve_pen(const Series& series, const Style& style);
Color color_of(const Series& series);

// A panel of shapes, without axes, within the box.
void draw_shapes(const Panel& panel, const Style& style, Sheet& sheet, const Box& box);

}  // namespace beamcam::render::figure
