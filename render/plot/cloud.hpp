// Very many points, and grids of coloured cells, under the axes of a panel: shapes while they are few, else pictures,
// so that a file stays small and its axes and letters stay lines.
#pragma once

#include "render/plot/placement.hpp"
#include "render/plot/plot_axes.hpp"

namespace beamcam::render::figure {

void draw_cloud(const Cloud& cloud, const PlotAxes& axes, PageCanvas& sheet);
void cover_cloud(const Cloud& cloud, const PlotAxes& axes, OccupancyGrid& taken);
void draw_cells(const Cells& cells, const PlotAxes& axes, PageCanvas& sheet);
void cover_cells(const Cells& cells, const PlotAxes& axes, OccupancyGrid& taken);

}  // namespace beamcam::render::figure
