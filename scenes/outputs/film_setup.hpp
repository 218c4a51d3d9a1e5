// Converts the pictures of a plan and the results of its motions to the input of render/.
#pragma once

#include <string>

#include "render/film/film.hpp"
#include "scenes/outputs/plan_motions.hpp"

namespace beamcam::scenes {

// Moves poses and tables out of the results.
render::FilmSetup film_setup(const Plan& plan, std::size_t picture, const Scene& scene, PlanResults& results);

// "rtol 10⁻⁸ · energy closes to 2 × 10⁻⁹ · bends beyond first-order"
std::string accuracy_note(const sim::Problem& problem, const sim::Result& result);

}  // namespace beamcam::scenes
