// Models that project d'Alembert's principle at Gauss nodes, without terms expanded by hand: `second-order` (all
// foreshortening terms of T and V) and `exact` (inextensible elastica, any deflection). Inertia and forces are sums
// over the nodes; each right-hand side needs one dense factorization. MODEL.md §5.
#pragma once

#include <memory>

#include "sim/beam/model.hpp"

namespace beamcam::sim {

// `problem.beam.model` must be second_order or exact.
std::unique_ptr<Model> make_quadrature_model(const Problem& problem);

// Number of Gauss nodes of the integrals.
int second_order_nodes(const Problem& problem);
int exact_nodes(const Problem& problem);
// The shapes η_j of `exact`, j = 1…count, and their derivatives by x up to `order`, one row for each order (S18).
void section_angle_shapes(double x, double length, int count, int order, double* values);

}  // namespace beamcam::sim
