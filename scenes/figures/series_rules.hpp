// Lines across a series at instants [s]: where impacts begin, where θ ceases to be reproducible, notes.
#pragma once

#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

using Rules = std::vector<render::figure::Rule>;

// Impacts are too many to be told apart: collisions stand for them.
bool marks_collisions(const sim::Result& result, double from, double to);
Rules impact_rules(const sim::Result& result, double from, double to);
// The ends of the intervals in which θ is not reproducible.
Rules horizon_rules(const sim::Result& result, double from, double to);
// Throws PictureError for an event that the motion does not have, or has elsewhere.
Rules note_rules(const std::vector<SeriesNote>& notes, const sim::Result& result, double from, double to,
                 bool with_words);

}  // namespace beamcam::scenes
