// Looks at what is there: which outputs were made from the same inputs already, and which motion is kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/data/manifest.hpp"
#include "scenes/motions/cache.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

struct UpToDate {
    ExistingWork existing;
    std::vector<std::string> inputs;  // key of each output of the scene; empty for standard output
    std::string motion;               // key of the motion
};

// `directory` as in RunOptions. `cache`: null when there is none. `afresh`: nothing that is there counts.
UpToDate check_up_to_date(const Scene& scene, const Selection& selection, const std::string& directory,
                          output::Manifest& manifest, const Cache* cache, bool afresh);

// Where an output's file is; `directory` empty: as it is named.
std::filesystem::path place_of(const std::string& directory, const std::string& file);

// The cache of this user, unless there is none or `no_cache`.
std::optional<Cache> open_cache(bool no_cache);

}  // namespace beamcam::scenes
