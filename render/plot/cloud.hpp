// Clouds of points and grids of coloured cells beneath the axes of a panel: vector shapes if they are few, else images,
// so that files stay small while axes and letters stay vectors.
#pragma once

#include "render/plot/placement.hpp"
#include "render/plot/plot.hpp"

namespace beamcam::render::figure {

void draw_cloud(const Cloud& cloud, const Plot& plot, PageCanvas& sheet);
void cover_cloud(const Cloud& cloud, const Plot& plot, OccupancyGrid& taken);
void draw_cells(const Cells& cells, const Plot& plot, PageCanvas& sheet);
void cover_cells(const Cells& cells, const Plot& plot, OccupancyGrid& taken);

}  // namespace beamcam::render::figure
