// Free places for labels, legends and insets of figures: a grid of cells, each with the weight of the shapes that cover
// it.
#pragma once

#include <span>
#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

class OccupancyGrid {
  public:
    OccupancyGrid(const Box& area, double cell);  // cell > 0: its side

    // A shape covers every cell that it touches; a cell has the largest of its weights.
    void cover(const Box& box, double weight = 4);
    void cover(std::span<const Vec2> curve, double weight = 1);  // NaN breaks it

    // The sum of the weights of the cells that the box touches; 1e6 if it leaves the area.
    double cost(const Box& box) const;

    const Box& area() const { return area_; }

  private:
    struct Cells {
        int left, top, right, bottom;  // half open
    };
    Cells touched(const Box& box) const;
    void cover(const Cells& cells, double weight);
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

}  // namespace beamcam::render
