// A file of baselines: scenes with one output each, and the accepted digests of their pictures.
//
//     { "references": "golden", "tolerance": {…},
//       "entries": { "fall": { "scene": "fall.json", "set": ["cam.speed=5"], "output": {"type": "still", "at": 0.3},
//                              "tolerance": {…}, "reproducible_until": 0.3,
//                              "accepted": [{"renderer": "0123456789ab", "sha256": ["…"]}] } },
//       "renderers": { "0123456789ab": {"cairo": "1.16.0", …} } }
//
// The syntax is that of scenes: comments and trailing commas are allowed. baseline_keys.cpp describes the keys. The
// program writes `accepted`, `reproducible_until` and `renderers` and leaves the rest of the text unchanged.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "output/json/source.hpp"
#include "scenes/regression/tolerance.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// Pictures that one renderer draws and that were accepted.
struct Accepted {
    std::string renderer;             // a fingerprint's id
    std::vector<std::string> sha256;  // of each picture
};

using RendererParts = std::map<std::string, std::string>;

struct Baseline {
    std::string name;              // and name of its folder of references
    Node scene_key, output_key;    // as the file has them; null: it has none
    std::vector<std::string> set;  // changes of the scene
    Scene scene;                   // with the output of the entry; a sweep has none; unused if `file` is given
    bool is_sweep = false;
    // Pictures of another program in place of a scene: a PNG file, a folder, a sequence or a film.
    std::string file;
    std::string expected;  // expected pictures in place of digests and references: the same kinds of files
    Tolerances tolerances;
    bool physics = true;  // false: only the picture is compared
    std::vector<Accepted> accepted;
    std::optional<double> reproducible_until;  // [s]
    // The error if the scene or its output cannot be read; then only the name is valid. Empty: there is none.
    std::string problem;

    bool has_pictures() const;
    const Picture* picture() const;  // its still picture or frames; null: it has none
    // The first renderer draws this picture so.
    bool is_of_first_renderer(long frame, const std::string& sha256) const;
    bool has_motion() const { return file.empty() && (physics || !has_pictures()); }
    const Output& output() const { return scene.outputs.front(); }
};

void visit(SceneVisitor& v, Baseline& entry);

struct Baselines {
    Source source;
    std::string folder;                // of the references, as the file has it
    std::filesystem::path references;  // folder of reference pictures and motions
    Tolerances tolerances;             // of all entries; each has them, too
    std::vector<Baseline> entries;     // in the order of the file
    std::map<std::string, RendererParts> renderers;
};

void visit(SceneVisitor& v, Baselines& baselines);
std::string baselines_schema_text();

// Throws SceneError with every issue at once, UnreadableFile.
Baselines read_baselines(const std::string& path);

// The entries that names or patterns such as "fall-*" select; without patterns, all. Throws UsageError for a pattern
// that selects none.
std::vector<const Baseline*> chosen_entries(const Baselines& baselines, const std::string& path,
                                            const std::vector<std::string>& patterns);

}  // namespace beamcam::scenes
