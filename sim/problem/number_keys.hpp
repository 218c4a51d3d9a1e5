// The keys of a problem that are numbers, by their path ("cam.speed", "cam.centre.0", "initial.angle"): what a sweep
// can vary.
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
    bool whole = false;  // takes whole numbers alone
    double value = 0;    // NaN where the key is not given
};
// Of the problem as it is: the keys of its own drive, friction and so on.
std::vector<NumberKey> number_keys(const Problem& problem);
std::optional<NumberKey> number_key(const Problem& problem, std::string_view path);

// False where the problem has no such key, or the key takes whole numbers alone and this is none. Ranges are judged by
// `validate`.
bool set_number(Problem& problem, std::string_view path, double value);

}  // namespace beamcam::sim
