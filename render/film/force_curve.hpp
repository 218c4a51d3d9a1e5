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

// The largest forces so far: of the motions' latest collisions, or of the whole film.
class Peaks {
  public:
    enum class Of { collision, film };
    Peaks(const FilmContext& context, Of part);
    // Instant and force [s, N], by linear interpolation at t; NaN: none.
    Vec2 of(int member, double t) const;

  private:
    const FilmContext& context_;
    Of part_;
    std::vector<figure::Series> forces_;  // of each motion
};

}  // namespace beamcam::render
