// A made-up film for the pictures' tests: a rod that falls on the disc, bounces with a closed-form flight, rests, and
// vibrates by one hinged–free shape with a small amplitude that dies away. Not the mechanics: only poses that look
// like them, exact in what the tests ask (touching means a gap of zero).
#pragma once

#include <vector>

#include "render/film/film.hpp"

namespace beamcam::test {

struct Synthetic {
    double duration = 2;  // [s]
    double fps = 60;
    double amplitude = 2e-3;  // of the vibration, tip [m per m of length]
    double size = 1;          // scales every length
    bool cam = true;
    bool half_depth = false;  // contact.offset
    double speed = 5;         // of the cam [rad/s]
};

sim::Pose synthetic_pose(const sim::Problem& problem, const Synthetic& how, double t);
render::FilmSetup synthetic_film(const Synthetic& how = {});

}  // namespace beamcam::test
