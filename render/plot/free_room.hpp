// Where words can stand in a mechanism's box: the places that nothing moving ever comes to during the film.
//
// The box is divided into cells; whatever is taken takes every cell that it touches.
#pragma once

#include <span>
#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

class FreeRoom {
  public:
    // `cell` > 0: side of a cell [px].
    FreeRoom(const Box& box, double cell);

    void take(std::span<const Vec2> convex);  // corners of a convex shape, in their order [px]
    void take(Vec2 centre, double radius);
    void take(const Box& box);

    // Share of what this box would cover that is taken; what lies beyond the room is taken.
    double taken(const Box& box) const;
    // The first of the places (at least one) that is free, else the one that is taken least.
    Box choose(std::span<const Box> places) const;

  private:
    struct Cells {
        int left, top, right, bottom;  // half open
    };
    Cells touched(const Box& box) const;
    void take_row(int row, double from, double to);

    Box box_;
    double cell_;
    int columns_, rows_;
    std::vector<bool> taken_;
};

enum class Corner { top_left, bottom_right };

// Where a box of this size can stand in `room`: its corners, from this one on, then along its edges.
std::vector<Box> places_along(const Box& room, Vec2 size, Corner first);

}  // namespace beamcam::render
