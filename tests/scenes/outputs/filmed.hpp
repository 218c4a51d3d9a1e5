// A film of the default problem, for what is made from films and is no picture.
#pragma once

#include <cmath>

#include "render/film/film.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes::testing {

inline render::FilmSetup filmed_until(double end, double rate) {
    render::FilmSetup setup;
    sim::Request request;
    request.end_time = end;
    request.poses.emplace_back();
    for (int k = 0; k <= std::lround(end * rate); ++k) request.poses[0].times.push_back(k / rate);
    sim::Result result = sim::simulate(setup.problem, request);
    setup.poses = std::move(result.poses[0]);
    setup.impacts = std::move(result.impacts);
    return setup;
}

}  // namespace beamcam::scenes::testing
