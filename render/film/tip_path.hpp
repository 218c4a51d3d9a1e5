// The path of the beam's tip as a mechanism's panel draws it: over the last of the film, fading, or all of it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/draw/accumulated.hpp"
#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

class TipPath {
  public:
    // Frame by frame: where the tip is drawn [px], and the hub's angle [rad]. `moved`: time went on since the one
    // before, so that a freeze costs the trail nothing.
    void add_frame(Vec2 tip, double angle, bool moved);
    // The way from a frame's place to the next one's, as `home`, a camera that does not move, shows it.
    std::vector<Vec2> piece(const MechanismView& home, std::size_t frame) const;
    // All of it, through the motion's survey and the frames that were added: in the panel's box, a piece of it at the
    // instant of its end.
    void find_whole(const MechanismView& home);
    const TimedPath& whole() const { return whole_; }

    void draw_trail(const MechanismScene& s, const MechanismView& home) const;
    void draw_whole(const MechanismScene& s, const MechanismView& home) const;  // until the scene's instant

  private:
    std::vector<Vec2> tips_;
    std::vector<double> angles_;
    std::vector<int> moved_;  // of every frame: how many until it moved
    TimedPath whole_;
};

}  // namespace beamcam::render
