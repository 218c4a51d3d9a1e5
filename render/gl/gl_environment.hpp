// Mesa reads its driver and many switches from the environment, and several of them make it crash (GALLIUM_DRIVER=zink,
// DRAW_USE_LLVM=0 …). The lit renderer's context is always llvmpipe, with Mesa's own defaults.
#pragma once

#include <string>
#include <vector>

namespace beamcam::render {

// Sets the process's environment accordingly, once, and returns the user's settings that are ignored, "NAME=value".
// Before threads start: they may read the environment.
const std::vector<std::string>& ignored_gl_settings();

}  // namespace beamcam::render
