// Fills areas between closed contours with exact pixel coverage, by summing the signed areas that edges cut off row by
// row (as font-rs, R. Levien 2016, and libart before it). For the beam and the disc, whose edges move in every frame,
// this is several times faster than Cairo, which samples 15 × 17 points per pixel, and FreeType, which repeats its walk
// through all contours for every few hundred pixels of edge.
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

// A view of pixels 0xAARRGGBB, premultiplied.
struct PixelView {
    std::uint32_t* pixels = nullptr;
    int width = 0, height = 0;  // [px]
    std::ptrdiff_t stride = 0;  // between rows [pixels]
};

class Area {
  public:
    // Contours are closed implicitly and may have either orientation; a contour with a NaN is ignored. Overlapping
    // added contours form a union. Cut contours must lie inside added ones.
    void add(std::span<const Vec2> corners) { put(corners, 1); }
    void cut(std::span<const Vec2> corners) { put(corners, -1); }
    void add_circle(Vec2 centre, double radius);  // ignored unless radius > 0
    void cut_circle(Vec2 centre, double radius);

    // Adds the changed tiles to `touched`, which may be null.
    void paint(const PixelView& picture, Color opaque, DirtyTiles* touched) const;

  private:
    struct Edge {
        Vec2 top, bottom;
        float sense;  // 1: the area begins to the right of the edge; −1: it ends
    };
    void put(std::span<const Vec2> corners, float sense);
    std::vector<Edge> edges_;
    Bounds box_;
};

// Paints the pixels whose centres lie within a quadrilateral, without antialiasing. Quadrilaterals with a common side
// neither share pixels nor leave gaps.
void paint_quadrilateral(const std::array<Vec2, 4>& corners, const PixelView& picture, Color opaque,
                         DirtyTiles* touched);

}  // namespace beamcam::render
