// Versions of the drawing libraries: part of the fingerprint of digests of references.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace beamcam::render {

// Name and version of each library that determines pixels: cairo, pixman, pango, harfbuzz, freetype.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace beamcam::render
