// Clouds of points and grids of coloured cells beneath the axes of a panel: vector shapes if they are few, else images,
// so that files stay small while axes and letters stay vectors.
#pragma once

#include "render/plot/plot.hpp"

namespace beamcam::render::figure {

void draw_cloud(const Cloud& cloud, const Plot& plot, PageCanvas& sheet);
void draw_cells(const Cells& cells, const Plot& plot, PageCanvas& sheet);

}  // namespace beamcam::render::figure
