// `--set key.path=value`: changes a scene's tree before it is read.
#pragma once

#include <string>
#include <vector>

#include "output/json/source.hpp"
#include "output/json/tree.hpp"

namespace beamcam::scenes {

// Why the text is not `key.path=value`; empty: it is.
std::string problem_with_override(const std::string& text);

// Applies one override `key.path=value`. The value is JSON or a plain word; a number in the path is the index of an
// array's entry, from 0. `source`: index that the positions carry. An error goes to `messages` and changes nothing.
void apply_override(Node& root, const std::string& text, std::size_t source, std::vector<Message>& messages);

// A number if the text is one, else the text itself, which may have a unit.
Node value_node(const std::string& text);

// Puts `value` at the path and creates missing objects. Errors have the position of `value`.
void set_value(Node& root, std::string_view path, Node value, std::vector<Message>& messages);

// Gives every key and value of the tree this position.
void move_to(Node& node, SourcePosition place);

// The source of an override, named `--set beam.modes=3` in messages.
Source override_source(const std::string& text);

}  // namespace beamcam::scenes
