// The keys of a problem that are numbers, by their path ("cam.speed", "cam.centre.0", "initial.angle"). A sweep can
// vary them.
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
    bool whole = false;  // only whole numbers are valid
    double value = 0;    // NaN if the key has no value
};
// Includes the keys of the problem's own type of drive, friction and so on.
std::vector<NumberKey> number_keys(const Problem& problem);
std::optional<NumberKey> number_key(const Problem& problem, std::string_view path);

// False if the problem has no such key, or if the key needs a whole number and `value` is not one. `validate` checks
// the ranges.
bool set_number(Problem& problem, std::string_view path, double value);

}  // namespace beamcam::sim
