// The text of player.html, made part of the program by CMake.
#pragma once

#include <string_view>

namespace beamcam::render {

std::string_view player_html();

}  // namespace beamcam::render
