// The keys that several outputs of pictures have.
#pragma once

#include "scenes/format/keys.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

void visit_picture(SceneVisitor& v, Picture& picture);
void visit_theme(SceneVisitor& v, View& view);
void visit_bounds(SceneVisitor& v, FrameSpan& span);  // the part of the motion
void visit_span(SceneVisitor& v, FrameSpan& span);    // how time runs in a film

// The keys of a film that a story makes, and that may not stand beside it.
inline constexpr const char* kKeysOfStories[] = {"to", "speed", "duration", "hold", "events"};

}  // namespace beamcam::scenes
