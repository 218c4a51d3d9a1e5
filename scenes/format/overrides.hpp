// `--set key.path=value`: changes a scene's tree before it is read.
#pragma once

#include <string>
#include <vector>

#include "scenes/format/source.hpp"
#include "scenes/format/tree.hpp"

namespace beamcam::scenes {

// Applies one override, given as `key.path=value`; `source` is the index its places will carry.
// The value is JSON, or else a plain word. A number in the path counts an array's entries from 0.
// What cannot be applied is told in `messages` and leaves the tree as it was.
void apply_override(Node& root, const std::string& text, std::size_t source, std::vector<Message>& messages);

// Puts `value` at `path`, its keys joined by dots; objects that are missing are made. What cannot be done is told at
// the value's place.
void set_value(Node& root, std::string_view path, Node value, std::vector<Message>& messages);

// Gives every key and value this place.
void move_to(Node& node, Place place);

// How messages name it: `--set beam.modes=3`.
Source override_source(const std::string& text);

}  // namespace beamcam::scenes
