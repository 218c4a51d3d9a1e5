// Areas between closed contours, painted by exact coverage: each pixel gets as much of the colour as the area covers of
// it. The signed areas that the edges cut off are summed row by row (as in font-rs, R. Levien 2016, and libart before
// it). Cairo, which samples a pixel in 15 × 17 places, and FreeType, which walks through all contours anew for every
// few hundred pixels of edge, take several times as long for the beam and the disc, whose edges are elsewhere in every
// frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/geometry.hpp"

namespace beamcam::render {

// Pixels 0xAARRGGBB, premultiplied, that somebody else holds.
struct PixelView {
    std::uint32_t* pixels = nullptr;
    int width = 0, height = 0;  // [px]
    std::ptrdiff_t stride = 0;  // from row to row [pixels]
};

class Area {
  public:
    // Contours close by themselves and may have either sense; those with a place that is no number are left out.
    // Where contours added overlap, or one overlaps itself, it is inside; holes are to lie within what is added.
    void add(std::span<const Vec2> corners) { put(corners, 1); }
    void cut(std::span<const Vec2> corners) { put(corners, -1); }
    void add_circle(Vec2 centre, double radius);  // radius > 0, otherwise nothing
    void cut_circle(Vec2 centre, double radius);

    // `touched` may be null.
    void paint(const PixelView& picture, Color opaque, DirtyTiles* touched) const;

  private:
    struct Edge {
        Vec2 top, bottom;
        float sense;  // 1: what is to the right of it comes in; −1: goes out
    };
    void put(std::span<const Vec2> corners, float sense);
    std::vector<Edge> edges_;
    Bounds box_;
};

// The pixels whose centres lie within the four sides, one behind the other. Quadrilaterals with a common side have no
// pixel in common and leave none out between them.
void paint_quadrilateral(const std::array<Vec2, 4>& corners, const PixelView& picture, Color opaque,
                         DirtyTiles* touched);

}  // namespace beamcam::render
