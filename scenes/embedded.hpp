// Texts that the program carries inside, so that it needs no files of its own to start a scene.
#pragma once

#include <string_view>

namespace beamcam::scenes {

std::string_view schema_text();            // beamcam-scene.schema.json
std::string_view baselines_schema_text();  // beamcam-baselines.schema.json
std::string_view default_scene_text();     // default.json

}  // namespace beamcam::scenes
