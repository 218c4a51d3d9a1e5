// The contact force as a curve against time, and its peaks.
#pragma once

#include <vector>

#include "render/film/panel.hpp"
#include "render/plot/figure.hpp"

namespace beamcam::render {

// The rows of the tables of chart and trace within `span`, and the peaks of impacts between them, each beside its
// nearest row; an impact between two rows becomes a triangle. Rows keep their values, because they are at the instants
// of frames. An impact that does not end within the rows gets no peak.
figure::Series force_curve(const Motion& motion, Range span);

// The largest forces of the motions within parts of `span`.
class Peaks {
  public:
    Peaks(const FilmContext& context, Range span);
    Vec2 of(int member, Range part) const;  // instant and force [s, N]; NaN: none

  private:
    std::vector<figure::Series> forces_;  // of each motion
};

}  // namespace beamcam::render
