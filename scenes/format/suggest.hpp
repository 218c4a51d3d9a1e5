// "Did you mean": the known word that is most similar.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamcam::scenes {

// `; did you mean "length"?` if a known word is similar enough, else "".
std::string suggestion(std::string_view word, const std::vector<std::string>& known);
// The suggestion, or `; the choices are a, b, c` where no word is similar enough.
std::string suggestion_or_list(std::string_view word, const std::vector<std::string>& known);

}  // namespace beamcam::scenes
