// From the text of a scene file to a Scene, or to every reason why it is none.
//
// The first syntax error, or else all that is wrong with the meaning, each with its place. The
// keys are those of keys.hpp.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenes/format/scene_files.hpp"
#include "scenes/format/source.hpp"
#include "scenes/format/tree.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

struct Reading {
    std::vector<Source> sources;    // the file, then the overrides
    std::vector<Message> messages;  // errors and warnings
    std::optional<Scene> scene;     // present when no message is fatal
    Node root;                      // the tree that it was read from

    std::string report() const { return describe(sources, messages); }
};

// `overrides` are `key.path=value` texts, applied in order.
Reading read_scene(Source file, const std::vector<std::string>& overrides = {});
// The same within a run that reads several: `files` keeps those that comparisons name.
Reading read_scene(Source file, const std::vector<std::string>& overrides, SceneFiles& files);
// The same of a part of a file, whose places the tree has.
Reading read_scene(Source file, Node root, const std::vector<std::string>& overrides, SceneFiles& files);

// The file cannot be read at all: absent, a directory, no permission, too large.
struct UnreadableFile : std::runtime_error {
    using std::runtime_error::runtime_error;
};
// "-" is standard input. Throws UnreadableFile.
Source load_source(const std::string& path);
// The same of a name that a file gives: pipes and devices, which might never end, and standard input are refused.
Source load_named_source(const std::string& path);

// The outputs of a scene that is read already: `outputs` is their list.
class Diagnostics;
struct SceneContext;
void read_outputs(const SceneContext& context, Diagnostics& diagnostics, const Node& outputs, Scene& scene);
// One output of a scene that stands resolved, as if the scene listed it alone: it becomes the scene's only one.
// `scene_name`: the file beside which others are looked for. Messages name its keys behind `prefix`, such as "--" or
// "entries.fall.output.". False: it cannot be read.
bool read_only_output(const Node& output, const std::string& scene_name, const std::string& prefix, SceneFiles& files,
                      Scene& scene, std::vector<Message>& messages);

}  // namespace beamcam::scenes
