// Models whose equations are d'Alembert's principle projected at Gauss nodes, with no hand-expanded
// term: `second-order` (every u_f of T and V) and `exact` (inextensible elastica, any deflection).
// Inertia and forces are sums over the nodes; one dense factorization a right-hand side. MODEL.md §5.
#pragma once

#include <memory>

#include "sim/beam/model.hpp"

namespace beamcam::sim {

// `problem.beam.model` must be second_order or exact.
std::unique_ptr<Model> make_quadrature_model(const Problem& problem);

}  // namespace beamcam::sim
