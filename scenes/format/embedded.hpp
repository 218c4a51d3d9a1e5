// Texts that the program carries inside, so that it needs no files of its own to start a scene.
#pragma once

#include <span>
#include <string_view>

namespace beamcam::scenes {

std::string_view baselines_schema_text();  // beamcam-baselines.schema.json
std::string_view default_scene_text();     // default.json

// The scenes of the paper's figures, paper/*.json, by name.
struct EmbeddedScene {
    std::string_view name;  // "free-fall.json"
    std::string_view text;
};
std::span<const EmbeddedScene> paper_scenes();

}  // namespace beamcam::scenes
