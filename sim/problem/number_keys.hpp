// The numerical keys of a problem by their path ("cam.speed", "cam.centre.0", "initial.angle"). Sweeps vary them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/problem/dimension.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

struct NumberKey {
    std::string path;
    Dimension dimension;
    bool whole = false;  // integers only
    double value = 0;    // NaN where the key is absent
};
// Only the keys of the problem's own variants of drive, friction and so on.
std::vector<NumberKey> number_keys(const Problem& problem);
std::optional<NumberKey> number_key(const Problem& problem, std::string_view path);

// False where the problem has no such key, or the key takes only integers and the value is not one. `validate` checks
// ranges.
bool set_number(Problem& problem, std::string_view path, double value);

}  // namespace beamcam::sim
