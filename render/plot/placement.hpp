// Free places for labels, legends and insets: a grid of cells, each with the weight of the shapes that cover it.
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
    void cover(std::span<const Vec2> curve, double weight = 1);           // NaN breaks it
    void cover_convex(std::span<const Vec2> corners, double weight = 1);  // in their order
    void cover_disc(Vec2 centre, double radius);

    // The sum of the weights of the cells that the box touches; 1e6 if it leaves the area.
    double cost(const Box& box) const;
    // The covered share of the box, if all weights are 1; the outside of the area counts as covered.
    double covered(const Box& box) const;
    // The runs of covered cells of each row; cells with a weight below a half do not count.
    std::vector<Box> covered_boxes() const;
    // The first free place, else the one that is covered least. `places` must not be empty.
    Box choose(std::span<const Box> places) const;
    // The free place nearest to the wanted one, moved by whole cells; if none is free, one that is covered little and
    // near.
    Box nearest_free(const Box& wanted) const;

    const Box& area() const { return area_; }

  private:
    struct Cells {
        int left, top, right, bottom;  // half open
    };
    Cells touched(const Box& box) const;
    void cover(const Cells& cells, double weight);
    void cover_row(int row, double from, double to, double weight);
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
// Places of a box of this size in `room`: its corners, from `first` on, then along its edges.
std::vector<Box> places_along(const Box& room, Vec2 size, Corner first);

}  // namespace beamcam::render
