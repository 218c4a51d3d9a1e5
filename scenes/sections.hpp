// The parts of a scene, each read from its place in the tree. Only reader.cpp calls these.
#pragma once

#include "scenes/fields.hpp"
#include "scenes/scene.hpp"

namespace beamcam::scenes {

// hub, beam, cam, contact, gravity, initial, solver, time.
void read_physics(Findings& findings, Fields& root, Scene& scene);

// Needs the scene's name, physics and end time.
void read_outputs(Findings& findings, const Node* node, Scene& scene);

}  // namespace beamcam::scenes
