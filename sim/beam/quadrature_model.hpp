// Models whose equations are d'Alembert's principle projected at Gauss nodes, with no hand-expanded
// term: `second-order` (every u_f of T and V) and `exact` (inextensible elastica, any deflection).
// Inertia and forces are sums over the nodes; one dense factorization a right-hand side. MODEL.md §5.
#pragma once

#include <memory>

#include "sim/beam/model.hpp"

namespace beamcam::sim {

// `problem.beam.model` must be second_order or exact.
std::unique_ptr<Model> make_quadrature_model(const Problem& problem);

// Gauss nodes of the models' integrals.
int second_order_nodes(const Problem& problem);
int exact_nodes(const Problem& problem);
// The shapes η_j of `exact`, j = 1…count, and their derivatives by x up to `order`: row by row (S18).
void section_angle_shapes(double x, double length, int count, int order, double* values);

}  // namespace beamcam::sim
