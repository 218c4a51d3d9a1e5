// The parts of a scene, each read from its place in the tree. Only reader.cpp and baselines.cpp call these.
#pragma once

#include "scenes/fields.hpp"
#include "scenes/scene.hpp"
#include "scenes/scene_files.hpp"
#include "scenes/source.hpp"

namespace beamcam::scenes {

// hub, beam, cam, contact, gravity, initial, solver, time.
void read_physics(Findings& findings, Fields& root, Scene& scene);

// Where the outputs stand: the whole scene, its file, and the files that it compares.
struct SceneContext {
    const Node& root;
    const Source& source;
    SceneFiles& files;
};
// Needs the scene's name, physics and end time.
void read_outputs(const SceneContext& context, Findings& findings, const Node* node, Scene& scene);

// What pictures look like (picture_reader.cpp): layout, compare, comparison; and how time runs in them: speed, events.
struct PictureContext {
    Findings& findings;
    const Scene& scene;
    const SceneContext& file;
};
void read_arrangement(const PictureContext& context, Fields& f, Picture& picture);
void read_pace(const PictureContext& context, Fields& f, FrameSpan& span);
bool read_at(Fields& f, const Node& node, std::string_view key, Instant& out);
// "0.3", "300 ms", "impact:2": nothing if it is none of them.
std::optional<Instant> parse_instant(std::string_view text);

}  // namespace beamcam::scenes
