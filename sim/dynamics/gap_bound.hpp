// Lower bounds of the gap without a search for the foot, and bounds of how far points of the beam move. MODEL.md §12.
#pragma once

#include <vector>

#include "sim/beam/drive.hpp"
#include "sim/beam/model.hpp"
#include "sim/problem/derived.hpp"

namespace beamcam::sim {

class GapBound {
  public:
    GapBound(const Problem& problem, const Model& model);

    // The gap is at least this [m] at all instants up to h from t, with coordinates up to `spread` from ξ.
    double lower_bound(const DriveLaw& drive, double t, double h, const double* xi, const double* spread) const;
    // How far apart two places of a point of the beam are at most, for coordinates that differ by `change` [m]; to
    // first order in the deflection.
    double travel(const double* change) const;
    // Only one foot exists for these coordinates q, wherever the disc is.
    bool nearly_straight(const double* q) const;
    // Of each mode but those of `exact`: the largest displacement per unit of its coordinate, and the wave number
    // [1/m].
    double shape_bound(std::size_t mode) const { return shape_bounds_[mode]; }
    double wave_number(std::size_t mode) const { return wave_numbers_[mode]; }

  private:
    double deflection(const double* xi, const double* spread) const;

    int modes_;
    bool exact_;
    double length_, radius_, offset_;
    Cam cam_;
    std::vector<double> shape_bounds_, wave_numbers_;  // by mode; empty for `exact`
};

}  // namespace beamcam::sim
