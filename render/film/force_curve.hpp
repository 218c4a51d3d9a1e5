// The contact force as a curve against time.
#pragma once

#include "render/film/film.hpp"
#include "render/plot/figure.hpp"

namespace beamcam::render {

// The rows of the tables of chart and trace within `span`, and the peaks of impacts between them, each beside its
// nearest row; an impact between two rows becomes a triangle. Rows keep their values, because they are at the instants
// of frames. An impact that does not end within the rows gets no peak.
figure::Series force_curve(const Motion& motion, Range span);

}  // namespace beamcam::render
