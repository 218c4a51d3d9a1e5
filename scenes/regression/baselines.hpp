// A file of baselines: scenes with one output each. What they are expected to give lies in plain files beside it
// (references.hpp); the program never writes this file.
//
//     { "references": "golden", "tolerance": {…},
//       "entries": { "fall": { "scene": "fall.json", "set": ["cam.speed=5"], "output": {"type": "still", "at": 0.3},
//                              "tolerance": {…} } } }
//
// The syntax is that of scenes: comments and trailing commas are allowed. baseline_keys.cpp describes the keys.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "output/json/source.hpp"
#include "scenes/format/keys.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// How far pictures and motions may be from the references: differences that count as "equivalent". Absent: the entry's
// default.
struct Tolerance {
    std::optional<int> channel;  // of a pixel's channel, 0…255; default 0 for flat views and figures, 2 for lit views
    std::optional<double> share;    // of the pixels that may differ by more, 0…1; default 0
    std::optional<double> ssim;     // least structural similarity of equivalent pictures, 0…1; default: none
    std::optional<double> motion;   // share of a channel's range, up to the reproducible horizon; default 2e-5
    std::optional<double> impacts;  // relative, of an impact's numbers; default 1e-4

    // The values of `over`; where it has none, the values of this.
    Tolerance overridden_by(const Tolerance& over) const {
        return {over.channel ? over.channel : channel, over.share ? over.share : share, over.ssim ? over.ssim : ssim,
                over.motion ? over.motion : motion, over.impacts ? over.impacts : impacts};
    }
};

void visit(SceneVisitor& v, Tolerance& tolerance);

struct Baseline {
    std::string name;              // and name of its folder of references
    Node scene_key, output_key;    // as the file has them; null: it has none
    std::vector<std::string> set;  // changes of the scene
    Scene scene;                   // with the output of the entry; a sweep has none
    bool is_sweep = false;
    Tolerance tolerance;
    bool physics = true;  // false: only the picture is compared
    // The error if the scene or its output cannot be read; then only the name is valid. Empty: there is none.
    std::string problem;

    bool has_pictures() const;
    const Picture* picture() const;  // its still picture or frames; null: it has none
    bool has_motion() const { return physics || !has_pictures(); }
    const Output& output() const { return scene.outputs.front(); }
};

void visit(SceneVisitor& v, Baseline& entry);

struct Baselines {
    Source source;
    std::string folder;                // of the references, as the file has it
    std::filesystem::path references;  // the folder
    std::filesystem::path root;        // symbolic links among the references must not lead out of this folder
    Tolerance tolerance;               // of all entries; each has it, too
    std::vector<Baseline> entries;     // in the order of the file
};

void visit(SceneVisitor& v, Baselines& baselines);
std::string baselines_schema_text();

// Throws SceneError with every issue at once, output::IoError.
Baselines read_baselines(const std::string& path);

// The entries that names or patterns such as "fall-*" select; without patterns, all. Throws UsageError for a pattern
// that selects none.
std::vector<const Baseline*> chosen_entries(const Baselines& baselines, const std::string& path,
                                            const std::vector<std::string>& patterns);

}  // namespace beamcam::scenes
