// Where words, a legend or an inset have room: a grid of cells, each with the weight of what covers it.
#pragma once

#include <span>
#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

class OccupancyGrid {
  public:
    OccupancyGrid(const Box& area, double cell);  // cell > 0: its side

    // A shape covers every cell that it touches; of a cell's weights the largest counts.
    void cover(const Box& box, double weight = 4);
    void cover(std::span<const Vec2> curve, double weight = 1);  // NaN breaks it
    void cover_convex(std::span<const Vec2> corners);            // in their order
    void cover_disc(Vec2 centre, double radius);

    // All weights of the cells that a box here would touch; outside the area counts as covered.
    double cost(const Box& box) const;
    // Share of the box that is covered, where all weights are 1; what lies beyond the area is covered.
    double covered(const Box& box) const;
    // The first of the places (at least one) that is free, else the one that is covered least.
    Box choose(std::span<const Box> places) const;
    // The free place nearest to this one, moved by whole cells; where none is free, one that is covered little and
    // near.
    Box nearest_free(const Box& wanted) const;

    const Box& area() const { return area_; }

  private:
    struct Cells {
        int left, top, right, bottom;  // half open
    };
    Cells touched(const Box& box) const;
    void cover(const Cells& cells, double weight);
    void cover_row(int row, double from, double to);
    double top_of(int row) const { return area_.y + row * cell_; }
    double weight(const Cells& cells) const;
    void sum() const;

    Box area_;
    double cell_;
    int columns_, rows_;
    std::vector<float> cells_;
    mutable std::vector<double> sums_;  // of all cells above and left
    mutable bool summed_ = false;
};

// The best place for a box of this size within the area: corners first, then edges, then anywhere.
struct Place {
    Box box;
    double cost = 0;
};
Place best_place(const OccupancyGrid& taken, double width, double height, double margin);

enum class Corner { top_left, bottom_right };
// Where a box of this size can stand in `room`: its corners, from this one on, then along its edges.
std::vector<Box> places_along(const Box& room, Vec2 size, Corner first);

}  // namespace beamcam::render
