// Soft shadows in a plane, as triangles of the picture.
//
// The penumbra of an edge runs from full light to full shadow by a smooth step of the distance from it. The shadow of a
// strip is the light that both of its edges take away, so that a strip narrower than its penumbra casts a faint one.
#pragma once

#include <array>
#include <vector>

#include "render/gl/bodies.hpp"

namespace beamcam::render {

// In the wall z = level or on the floor y = level, in which points are (x, y) or (x, z).
struct SoftShadows {
    const Projection& view;
    Ground ground;
    double level;
    std::vector<ShadowVertex> corners = {};

    struct Station {
        Vec2 low, high;   // the edges
        double soft = 1;  // half the width of the penumbra [px]
    };
    // A strip through these stations; `grey`: 0 black, 1 white.
    void ribbon(const std::vector<Station>& line, double opacity, double grey);
    // A convex outline with its outward normals.
    void polygon(const std::vector<Vec2>& outline, const std::vector<Vec2>& outward, double soft, double opacity);
    void rectangle(Vec2 low, Vec2 high, double soft, double opacity, double grey = 0);

  private:
    ShadowVertex vertex(Vec2 at, std::array<double, 4> inside, double opacity, double grey) const;
};

}  // namespace beamcam::render
