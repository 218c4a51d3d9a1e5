// The stretch of the scene that a figure shows, and its poses.
#pragma once

#include "scenes/figures/studies.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

struct Stretch {
    double from, to;           // [s]
    std::size_t study, poses;  // poses: index into the study's Result::poses
};
// `count` poses equally spaced, both ends included, of so many `stations` along the beam.
Stretch stretch(const Scene& scene, const FigureOutput& how, int count, int stations, Studies& studies);

}  // namespace beamcam::scenes
