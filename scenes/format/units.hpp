// Quantities in texts of scenes: "12 mm", "300 rpm", "2.7 g/cm^3", "1e8 N/m^1.5".
//
// A unit is a product of named units with exponents. Its dimension is checked against the one that the key has.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sim/problem/dimension.hpp"

namespace beamcam::scenes {

using sim::Dimension, sim::same, sim::si_unit;
namespace dimension = sim::dimension;

struct Quantity {
    double value = 0;  // in SI
    Dimension dimension;
};

// A quantity, or the reason why the text is not one.
struct QuantityText {
    std::optional<Quantity> quantity;
    std::string problem;
};
// `expected`: the dimension of the units that messages suggest; null: any.
QuantityText parse_quantity(std::string_view text, const Dimension* expected = nullptr);
// The factor from a unit to another one of the same dimension; nothing: they are not.
std::optional<double> factor_between(std::string_view unit, std::string_view other);

}  // namespace beamcam::scenes
