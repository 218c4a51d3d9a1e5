// "Did you mean": the nearest of a set of known words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamcam::scenes {

// Edit distance where exchanging two neighbours counts once (optimal string alignment); in bytes.
std::size_t edit_distance(std::string_view a, std::string_view b);

// `; did you mean "length"?` when a known word is near enough, else nothing.
std::string suggestion(std::string_view word, const std::vector<std::string>& known);
// The same, else `; known are a, b, c`.
std::string suggestion_or_list(std::string_view word, const std::vector<std::string>& known);

}  // namespace beamcam::scenes
