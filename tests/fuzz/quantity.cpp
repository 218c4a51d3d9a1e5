// The parser of quantities with units: a finite value, or a reason.
#include <cmath>

#include "scenes/format/units.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    const scenes::QuantityText read = scenes::parse_quantity(fuzz::text_of(data, size));
    fuzz::claim(read.quantity.has_value() == read.problem.empty(), "a quantity, or the reason why it is none");
    if (!read.quantity) return 0;
    fuzz::claim(std::isfinite(read.quantity->value), "its value is finite");
    fuzz::claim(!scenes::si_unit(read.quantity->dimension).empty(), "its dimension has a unit");
    return 0;
}
