// Converts the pictures of a plan and the results of its motions to the input of render/.
#pragma once

#include <string>
#include <vector>

#include "render/film/film.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// `results`: of the motions of the plan; poses and tables of this picture are moved out of them.
render::FilmSetup film_setup(const Plan& plan, const PlannedPictures& p, const Scene& scene,
                             std::vector<sim::Result>& results);

// "rtol 10⁻⁸ · energy closes to 2 × 10⁻⁹ · bends beyond first-order"
std::string accuracy_note(const sim::Problem& problem, const sim::Result& result);

}  // namespace beamcam::scenes
