// What the program writes into a file of baselines: digests, horizons and renderers, into the text as people wrote it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/regression/baselines.hpp"

namespace beamcam::scenes {

// What is to be changed: an update of the references that was killed is completed or undone before, which is told.
// Throws what read_baselines and ReferenceUpdate::recover do.
Baselines read_recovered(const std::string& path);

// What changes in one entry.
struct BaselineEdit {
    std::string name;
    std::vector<Accepted> accepted;
    std::optional<double> reproducible_until;
};
// The text with these entries changed and every other byte left as it was, but for "renderers", which lists those that
// some entry names.
std::string edited(const Baselines& baselines, const std::vector<BaselineEdit>& edits,
                   const std::map<std::string, RendererParts>& renderers);

}  // namespace beamcam::scenes
