// The part of a mechanism's picture that moving parts cover at some frame: there labels have no place.
//
// In the solid view the parts are bodies in perspective, and their shadows on the wall count a little: a label is in a
// shadow rather than over a body.
#pragma once

#include <span>
#include <vector>

#include "render/film/mechanism_labels.hpp"
#include "render/gl/solid.hpp"
#include "render/plot/placement.hpp"

namespace beamcam::render {

class SweptRegion {
  public:
    // `views`: those of the solid view, the usual one first; empty in flat and lit films. What the camera moves is
    // covered relative to the axis of the cam, beside which labels are placed.
    SweptRegion(const MechanismView& at, OccupancyGrid covered, const std::vector<Perspective>& views);

    void add_beam(const std::vector<Vec2>& face, const std::vector<Vec2>& back);  // edges of a section [px]
    void add_motion(const std::vector<Vec2>& from,
                    const std::vector<Vec2>& to);  // swept by one of the edges between two frames
    void add_shape(const MechanismShape& shape);   // all moving parts of a pose
    void add_disc(Vec2 centre, double radius);     // [px]
    void add_hub(Vec2 centre, double radius);      // [px]
    void add_arrow(const ForceArrow& arrow);
    void add_curve(const std::vector<Vec2>& curve);  // in the plane of the beam's front [px]
    void add_fixed();                                // hubs, supports, the horizontal, and the circles that discs sweep

    OccupancyGrid room;

  private:
    struct Depth {
        double back, front;  // relative to the width of the beam
    };
    struct Seen {
        Perspective view;
        Vec2 shift;  // of the axis of the cam, from its place in the usual view [px]
    };
    static constexpr Depth kBeam{-0.5, 0.5};
    void add_body(std::span<const Vec2> outline, Depth depth, bool casts_shadow = true);
    void add_mount(Vec2 hinge, double hub);
    Vec2 seen(const Seen& by, Vec2 flat, double depth) const;

    const MechanismView& at_;
    std::vector<Seen> views_;
};

}  // namespace beamcam::render
