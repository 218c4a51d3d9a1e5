// A lower bound of the gap that needs no search for the foot, and an upper bound of displacements. MODEL.md §12.
#pragma once

#include <vector>

#include "sim/beam/drive.hpp"
#include "sim/beam/model.hpp"
#include "sim/cam/turning_cam.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

class GapBound {
  public:
    GapBound(const Problem& problem, const Model& model, const TurningCam& cam);

    // Lower bound of the gap [m] over |t′ − t| <= h and all coordinates within ±spread of ξ.
    double lower_bound(const DriveLaw& drive, double t, double h, const double* xi, const double* spread) const;
    // Upper bound of the displacement of any point of the beam when the coordinates change by `change` [m], to first
    // order in the deflection.
    double travel(const double* change) const;
    // True if the beam has only one foot for these coordinates q, wherever the cam is.
    bool nearly_straight(const double* q) const;

    // Upper bound of the distance of any point from the straight beam at the frame's angle [m].
    double deflection(const double* xi, const double* spread) const;

  private:
    double straight_gap(double angle, double t) const;

    int modes_;
    bool exact_;
    double length_, radius_, offset_;
    TurningCam cam_;
    std::vector<double> shape_bounds_, wave_numbers_;  // per mode; empty for `exact`
};

}  // namespace beamcam::sim
