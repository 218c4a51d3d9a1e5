// Changes of a file of baselines: the program writes digests, horizons and renderers and leaves the rest of the text
// unchanged.
#pragma once

#include <string>

#include "scenes/regression/baselines.hpp"

namespace beamcam::scenes {

// Reads the baselines after it has completed or undone an update that was killed, with a message. Throws the errors of
// read_baselines and ReferenceUpdate::recover.
Baselines read_recovered(const std::string& path);

// The text of `before` with what the program writes as in `after`, and with "renderers" reduced to those that entries
// name. All other bytes stay.
std::string edited(const Baselines& before, Baselines after);

}  // namespace beamcam::scenes
