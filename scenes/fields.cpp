#include "scenes/fields.hpp"

namespace beamcam::scenes {

std::string shown(const Node& node) {
    switch (node.kind) {
        case Node::Kind::null:
            return "null";
        case Node::Kind::boolean:
            return node.boolean ? "true" : "false";
        case Node::Kind::number:
            return shortened(node.text);
        case Node::Kind::string:
            return in_quotes(node.text);
        case Node::Kind::array:
            return fmt::format("an array of {}", node.items.size());
        case Node::Kind::object:
            return "an object";
    }
    return "?";
}

}  // namespace beamcam::scenes
