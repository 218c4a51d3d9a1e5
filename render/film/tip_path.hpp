// The path of the beam's tip: a fading trail of the last second.
#pragma once

#include <cstddef>
#include <vector>

#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

class TipPath {
  public:
    explicit TipPath(const MechanismView& home);  // the view of the fixed camera, which must outlive it
    void draw_trail(const MechanismScene& s) const;

  private:
    void add(const sim::Pose& pose);
    // From the tip's position at a frame to the next one [px].
    std::vector<Vec2> piece(std::size_t frame) const;

    const MechanismView& home_;
    std::vector<Vec2> places_;         // of the drawn tip at the frames and at the poses between them [px]
    std::vector<double> angles_;       // of the hub there [rad]
    std::vector<std::size_t> frames_;  // the place of each frame
};

}  // namespace beamcam::render
