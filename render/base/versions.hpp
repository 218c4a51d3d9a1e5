// Which libraries draw flat pictures and figures: part of the fingerprint that digests are kept under.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace beamcam::render {

// Name and version of each library that decides about pixels: cairo, pixman, pango, harfbuzz, freetype.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace beamcam::render
