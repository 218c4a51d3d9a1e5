// Where a label, a legend or an inset has room: a coarse map of what is already drawn in a panel.
#pragma once

#include <span>
#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render::figure {

class Occupancy {
  public:
    // `cell` [pt]: 1.5 resolves letters.
    explicit Occupancy(const Box& area, double cell = 1.5);

    void cover(std::span<const Vec2> curve, double weight = 1);  // NaN breaks it
    void cover(const Box& box, double weight = 4);
    // What would be covered by a box here; outside the area counts as covered.
    double cost(const Box& box) const;

    const Box& area() const { return area_; }

  private:
    void add(int i, int j, double weight);
    void sum() const;

    Box area_;
    double cell_;
    int columns_ = 1, rows_ = 1;
    std::vector<float> cells_;
    mutable std::vector<double> sums_;  // of all cells above and left
    mutable bool summed_ = false;
};

// The best place for a box of this size within the area: corners first, then edges, then anywhere.
struct Place {
    Box box;
    double cost = 0;
};
Place best_place(const Occupancy& taken, double width, double height, double margin);

}  // namespace beamcam::render::figure
