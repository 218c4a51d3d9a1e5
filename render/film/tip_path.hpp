// The path of the beam's tip: a fading trail of the last second, or the whole path.
#pragma once

#include <cstddef>
#include <vector>

#include "render/draw/accumulated.hpp"
#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

class TipPath {
  public:
    // Adds a frame: position of the drawn tip [px] and hub angle [rad]. `moved`: time is later than at the previous
    // frame; a freeze does not shorten the trail.
    void add_frame(Vec2 tip, double angle, bool moved);
    // The curve from the tip's position at a frame to the next one, in the view `home` of the fixed camera.
    std::vector<Vec2> piece(const MechanismView& home, std::size_t frame) const;
    // Computes the whole path from the survey of the motion and the added frames, in pixels of the panel's box.
    void find_whole(const MechanismView& home);
    const TimedPath& whole() const { return whole_; }

    void draw_trail(const MechanismScene& s, const MechanismView& home) const;
    void draw_whole(const MechanismScene& s, const MechanismView& home) const;  // up to the scene's instant

  private:
    std::vector<Vec2> tips_;
    std::vector<double> angles_;
    std::vector<int> moved_;  // number of frames up to this one in which time moved
    TimedPath whole_;
};

}  // namespace beamcam::render
