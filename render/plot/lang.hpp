// The language of what a picture says of itself.
#pragma once

#include <string>

namespace beamcam::render {

enum class Lang { en, zh };

// The film's own words, written in English, in this language; what is no word of films stays.
std::string in(Lang lang, std::string english);

}  // namespace beamcam::render
