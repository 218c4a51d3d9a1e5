// What captions and films say of a sweep and its points.
#pragma once

#include "scenes/figures/swept_points.hpp"

namespace beamcam::scenes {

// What is known of the points.
std::string caption_words(const SweptPoints& points);
std::string tolerance_words(const SweptPoints& points);
constexpr int kValueDigits = 6;  // of the swept key's value, wherever a film tells it
// "ω = 45.2 rad/s: period 2, 3 impacts"; plain.
std::string words_of_point(const Swept& swept, std::uint64_t point, Lang lang);

}  // namespace beamcam::scenes
