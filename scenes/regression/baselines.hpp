// A file of baselines: what is to be rendered and simulated again, and which pixels and motion are expected.
//
//     { "references": "golden", "tolerance": {…},
//       "entries": { "fall": { "scene": "fall.json", "set": ["cam.speed=5"], "output": {"type": "still", "at": 0.3},
//                              "tolerance": {…}, "reproducible_until": 0.3,
//                              "accepted": [{"renderer": "0123456789ab", "sha256": ["…"]}] } },
//       "renderers": { "0123456789ab": {"cairo": "1.16.0", …} } }
//
// The format is that of scenes (comments, trailing commas, places in messages); beamcam-baselines.schema.json describes
// it key by key. `accepted`, `reproducible_until` and `renderers` are written by the program, into the text as people
// wrote it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/format/source.hpp"
#include "scenes/regression/tolerance.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// Pixels that one kind of machine makes, and that are right.
struct Accepted {
    std::string renderer;             // a fingerprint's id
    std::vector<std::string> sha256;  // one a picture
};

struct Baseline {
    std::string name;  // also of its folder among the references
    Scene scene;       // with the one output of the entry, none of a sweep; of no meaning where there is a file
    bool is_sweep = false;
    // Pictures that another tool made, to be judged instead of a scene: a PNG file, a folder, a sequence or a film.
    std::string file;
    std::string expected;  // the same: pictures that somebody accepted, instead of digests and references
    Tolerances tolerances;
    bool physics = true;  // false: only the picture is guarded
    std::vector<Accepted> accepted;
    std::optional<double> reproducible_until;  // [s]
    // Why the scene or its output cannot be read, with its place; then the entry has a name only. Empty: it can.
    std::string problem;

    bool has_pictures() const;
    const Picture* picture() const;  // its still or frames; null: it has none
    bool has_motion() const { return file.empty() && (physics || !has_pictures()); }
    const Output& output() const { return scene.outputs.front(); }
};

using RendererParts = std::map<std::string, std::string>;

struct Baselines {
    Source source;
    std::filesystem::path references;  // folder of reference pictures and motions
    std::vector<Baseline> entries;     // in the order of the file
    std::map<std::string, RendererParts> renderers;
};

// Throws SceneError with every issue at once, UnreadableFile.
Baselines read_baselines(const std::string& path);

// The entries that are meant by names or patterns such as "fall-*"; all if there are none. Throws UsageError for a
// pattern that means nothing.
std::vector<const Baseline*> chosen_entries(const Baselines& baselines, const std::string& path,
                                            const std::vector<std::string>& patterns);

}  // namespace beamcam::scenes
