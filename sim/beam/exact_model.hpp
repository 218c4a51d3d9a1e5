// The model `exact`: an inextensible elastica, with any deflection.
#pragma once

#include <memory>

#include "sim/beam/model.hpp"

namespace beamcam::sim {

std::unique_ptr<Model> make_exact_model(const Problem& problem);

// Number of Gauss nodes of the integrals.
int exact_nodes(const Problem& problem);
// The shapes η_j, j = 1…count, and their derivatives by x up to `order` ≤ 6, one row for each order (S18).
inline constexpr int kMaxShapeOrder = 6;
void section_angle_shapes(double x, double length, int count, int order, double* values);

}  // namespace beamcam::sim
