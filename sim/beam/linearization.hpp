// The linear equations of motion of a model. MODEL.md §13.
#pragma once

#include <Eigen/Core>

namespace beamcam::sim {

// About the straight beam at rest, without gravity: inertia and stiffness of ξ, and the centrifugal stiffness per Ω² of
// a beam that rotates at Ω.
struct Linearization {
    Eigen::MatrixXd mass, stiffness, centrifugal;
    explicit Linearization(Eigen::Index size) { mass = stiffness = centrifugal = Eigen::MatrixXd::Zero(size, size); }
};

}  // namespace beamcam::sim
