// Where a file came from, as it says itself or as the manifest beside it says; and what this machine can do.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace beamcam::scenes {

struct Provenance {
    std::string file, kind;                    // "PNG picture", "film", "SVG figure", "PDF figure", "table", "record"
    std::map<std::string, std::string> facts;  // size, frames, codec …
    std::string version, title, accuracy;
    std::string scene;  // JSON text; empty when the file does not carry one
    bool made_by_beamcam() const { return !version.empty() || !scene.empty(); }
};

// Throws output::IoError, MissingCodec.
Provenance provenance_of(const std::string& file);

// The scene as one that can be run where it is: its outputs stand in the current folder. Nothing when it is no JSON.
std::string runnable_scene(const std::string& scene);

std::string to_text(const Provenance& provenance);
std::string to_json(const Provenance& provenance);

// ---- this machine --------------------------------------------------------------------------------------

struct Check {
    std::string group, what;
    bool ok = true;
    std::string found;   // version, name, or why not
    std::string remedy;  // what brings it
};
std::vector<Check> examine_machine();
std::string to_text(const std::vector<Check>& checks);
std::string to_json(const std::vector<Check>& checks);

}  // namespace beamcam::scenes
