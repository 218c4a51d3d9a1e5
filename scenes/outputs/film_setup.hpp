// Converts the pictures of a plan and the results of its motions to the input of render/.
#pragma once

#include <span>
#include <string>

#include "render/film/film.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// `results`: of the motions of this picture; poses and tables are moved out of them.
render::FilmSetup film_setup(const Plan& plan, const PlannedPictures& p, const Scene& scene,
                             std::span<sim::Result* const> results);

// "rtol 10⁻⁸ · energy closes to 2 × 10⁻⁹ · bends beyond first-order"
std::string accuracy_note(const sim::Problem& problem, const sim::Result& result);

}  // namespace beamcam::scenes
