// A series on a page, reduced to its visible detail: a line, bands where it oscillates fast, markers.
#pragma once

#include <vector>

#include "render/plot/plot.hpp"

namespace beamcam::render::figure {

class DrawnCurve {
  public:
    DrawnCurve(const Series& series, const Plot& plot, double grain);

    const Series& series() const { return *series_; }
    void draw(const PlotStyle& style, Painter& on) const;
    // Those in the plot; at its edge they extend over the frame.
    void draw_markers(const Box& plot, const PlotStyle& style, Painter& on) const;

  private:
    const Series* series_;
    std::vector<Vec2> points_;              // on the sheet
    std::vector<std::vector<Vec2>> bands_;  // outlines of unresolved oscillations, which are not in `points_`
    std::vector<Color> colors_;             // of the points, if values give them
};

// The key of a series in a legend or before the name of an axis: its line and its marker.
inline constexpr double kSampleLength = 2.6;  // of the line, in sizes of letters
void draw_sample(Painter& on, const PlotStyle& style, const Series& series, Vec2 from, Vec2 to);
void draw_marker(Painter& on, const PlotStyle& style, Marker shape, Vec2 at, double radius, Color color, bool hollow);
inline bool inside(const Box& b, Vec2 p, double slack = 0) { return b.contains({p.x, p.y, 0, 0}, slack); }

}  // namespace beamcam::render::figure
