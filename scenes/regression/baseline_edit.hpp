// Changes of a file of baselines: the program writes digests, horizons and renderers and leaves the rest of the text
// unchanged.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/regression/baselines.hpp"

namespace beamcam::scenes {

// Reads the baselines after it has completed or undone an update that was killed, with a message. Throws the errors of
// read_baselines and ReferenceUpdate::recover.
Baselines read_recovered(const std::string& path);

// New values of one entry.
struct BaselineEdit {
    std::string name;
    std::vector<Accepted> accepted;
    std::optional<double> reproducible_until;
};
// The text with these entries changed, and with "renderers" reduced to those that entries name. All other bytes stay.
std::string edited(const Baselines& baselines, const std::vector<BaselineEdit>& edits,
                   const std::map<std::string, RendererParts>& renderers);

}  // namespace beamcam::scenes
