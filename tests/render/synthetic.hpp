// A synthetic film for tests of pictures: a rod that falls on the disc, bounces in closed form, comes to rest, and
// vibrates in one hinged–free shape with decaying amplitude. The poses are not simulated, but exact where tests need it
// (a touching pose has a gap of zero).
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
render::FilmSetup flat_film(const Synthetic& how, int width, int height);  // the same in the flat style
// A straight beam that turns about its hub from an angle on [rad, rad/s], without a contact, in 720p.
render::FilmSetup led_rod(double from, double rate, double duration = 1);

}  // namespace beamcam::test
