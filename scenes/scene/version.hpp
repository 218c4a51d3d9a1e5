// The version of the program.
#pragma once

#include <string_view>

namespace beamcam::scenes {

inline constexpr std::string_view kVersion = BEAMCAM_VERSION;

}  // namespace beamcam::scenes
