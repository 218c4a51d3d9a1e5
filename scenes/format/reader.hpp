// Reads a scene file into a Scene, or reports every error with its position: the first syntax error, or else all
// invalid keys and values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/json/source.hpp"
#include "output/json/tree.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

struct Reading {
    std::vector<Source> sources;    // the file, then the overrides
    std::vector<Message> messages;  // errors and warnings
    std::optional<Scene> scene;     // present if no message is fatal
    Node root;                      // the tree with the overrides

    std::string report() const { return describe(sources, messages); }
};

// `overrides` are `key.path=value` texts, applied in order.
Reading read_scene(Source file, const std::vector<std::string>& overrides = {});
// Reads a part of a file; `root` has its positions.
Reading read_scene(Source file, Node root, const std::vector<std::string>& overrides);

inline constexpr const char* kNoScene = "`beamcam init` writes a first scene";
// "-" is standard input. `remedy`: end of the message if the file does not exist. Throws output::IoError.
Source load_source(const std::string& path, const char* remedy = kNoScene);

// Reads one output, which becomes the only output of the scene. `scene_name`: paths in the output are relative to its
// folder. `path`: of the output in messages, such as "entries.fall.output"; empty: "the output". False on errors.
bool read_only_output(const Node& output, const std::string& scene_name, const std::string& path, Scene& scene,
                      std::vector<Message>& messages);

}  // namespace beamcam::scenes
