// Films for tests that have every kind of panel, several motions, or measured data.
#pragma once

#include <vector>

#include "render/film/film.hpp"

namespace beamcam::render {

LayoutNode leaf(PanelSpec spec, double share = 1);
LayoutNode grid(LayoutNode::Kind kind, std::vector<LayoutNode> children, double share = 1);
PanelSpec strip(sim::ChannelKind kind);

FilmSetup everything();              // all kinds of panels at once, in 1080p
FilmSetup with_data();               // the same with data as a line, as points and as a straight beam
FilmSetup compared(Comparison how);  // two motions, in 720p

// The pixels of a frame do not depend on the frames that were drawn before.
void same_in_any_order(FilmSetup setup);

}  // namespace beamcam::render
