// The model `second-order`: all foreshortening terms of T and V.
#pragma once

#include <memory>

#include "sim/beam/model.hpp"

namespace beamcam::sim {

std::unique_ptr<Model> make_second_order_model(const Problem& problem);

// Number of Gauss nodes of the integrals.
int second_order_nodes(const Problem& problem);

}  // namespace beamcam::sim
