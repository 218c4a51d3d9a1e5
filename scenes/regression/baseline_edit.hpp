// Changes of a file of baselines: the program writes digests, horizons and renderers and leaves the rest of the text
// unchanged.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/regression/baselines.hpp"
#include "scenes/regression/result.hpp"

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
// Only the motion of the entry is new: its accepted pictures, also those of other renderers, stay.
bool has_new_motion_only(const Baseline& entry, const EntryResult& found);
// Accepts the result, whose pictures and motion replace those of the entry, or whose pictures are added to them.
BaselineEdit acceptance_of(const Baseline& entry, const EntryResult& found, bool replaces);
// The text with these entries changed, and with "renderers" reduced to those that entries name. All other bytes stay.
std::string edited(const Baselines& baselines, const std::vector<BaselineEdit>& edits,
                   const std::map<std::string, RendererParts>& renderers);

}  // namespace beamcam::scenes
