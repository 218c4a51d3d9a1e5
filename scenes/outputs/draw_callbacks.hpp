// Stands in for both ends of a run: gives what was simulated and takes the pictures, for commands that compare instead
// of writing files.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "render/draw/image.hpp"
#include "scenes/plan/plan.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

struct DrawCallbacks {
    // Of requests_of the plan: what was integrated once for several plans; taken by the run.
    std::vector<sim::Result> results;
    // Frame numbers count from 0 in each output; several threads call this at once, in any order.
    std::function<void(const Pictures&, long frame, const render::Image&)> picture;
    // A figure as pixels, whatever the ending of its file.
    std::function<void(const render::Image&)> figure;
    // A motion that a picture compares, by the picture's and its own index in the plan; before anything is drawn.
    std::function<void(std::size_t picture, std::size_t index, const sim::Result&)> compared;
};

}  // namespace beamcam::scenes
