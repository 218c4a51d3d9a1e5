// A motion that an output needs, and what it requests of it.
#pragma once

#include <string>

#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

struct MotionRequest {
    sim::Problem problem;
    std::string key;  // motion_key(problem)
    sim::Request request = {};
    std::string label = {};  // of a compared motion
    std::string file = {};   // precedes warnings about the motion; empty: the motion is the scene's own
};

}  // namespace beamcam::scenes
