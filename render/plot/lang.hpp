// The language of the texts of pictures.
#pragma once

#include <string>

namespace beamcam::render {

enum class Lang { en, zh };

// Translates the English texts of films into this language; other text stays as it is.
std::string in(Lang lang, std::string english);

}  // namespace beamcam::render
