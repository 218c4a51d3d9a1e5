#include "scenes/format/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "output/files/numbers.hpp"

namespace beamcam::scenes {
namespace {

// JSON if the text is JSON or looks like JSON with an error, which is then reported; else the text itself.
bool parse_value(std::string_view text, Node& value, std::string& problem) {
    Parsed parsed = parse(text);
    if (parsed.is_json && parsed.messages.empty()) {
        value = std::move(parsed.root);
        return true;
    }
    const std::size_t first = text.find_first_not_of(" \t");
    const bool looks_like_json =
        parsed.is_json ||
        (first != std::string_view::npos && std::string_view("{[\"").find(text[first]) != std::string_view::npos);
    double ignored = 0;  // "1e999" is an invalid number, not a word
    const bool is_number = !text.empty() && std::from_chars(text.data(), text.data() + text.size(), ignored).ptr ==
                                                text.data() + text.size();
    if (looks_like_json || is_number) {
        problem = parsed.messages.front().text;
        return false;
    }
    value = Node(std::string(text));
    return true;
}

}  // namespace

void move_to(Node& node, SourcePosition place) {
    node.place = place;
    for (Node& item : node.items) move_to(item, place);
    for (Member& member : node.members) {
        member.key_place = place;
        move_to(member.value, place);
    }
}

Source override_source(const std::string& text) { return {fmt::format("--set {}", text), text, false}; }

std::string problem_with_override(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos && equals > 0) return {};
    return fmt::format("{}; write --set key.path=value, for example --set beam.modes=4",
                       equals == 0 ? "the key is missing before \"=\"" : "\"=\" is missing after the key");
}

void apply_override(Node& root, const std::string& text, std::size_t source, std::vector<Message>& messages) {
    const SourcePosition place{source, 0};
    const auto error = [&](std::string reason) { messages.push_back({place, std::move(reason), true}); };

    if (std::string problem = problem_with_override(text); !problem.empty()) return error(std::move(problem));
    const std::size_t equals = text.find('=');
    Node value;
    std::string problem;
    if (!parse_value(std::string_view(text).substr(equals + 1), value, problem)) return error(problem);
    move_to(value, place);
    set_value(root, std::string_view(text).substr(0, equals), std::move(value), messages);
}

Node value_node(const std::string& text) {
    const auto number = output::number_in<double>(text);
    Node node = number && std::isfinite(*number) ? Node(*number) : Node(text);
    node.text = text;  // as it was written, for messages
    return node;
}

void set_value(Node& root, std::string_view path, Node value, std::vector<Message>& messages) {
    const SourcePosition place = value.place;
    const auto error = [&](std::string text) { messages.push_back({place, std::move(text), true}); };
    const std::vector<std::string> keys = split(path);
    if (std::ranges::find(keys, "") != keys.end()) return error("the path contains an empty key; write key.path=value");

    Node *node = &root, *extended = nullptr;  // extended: the object of the scene that got `added`
    std::string walked, added;
    for (const std::string& key : keys) {
        const std::string here = walked.empty() ? "the scene" : walked;
        // An object that an earlier key added: the entries of an array that the scene lacks are unknown.
        if (extended && key.find_first_not_of("0123456789") == std::string::npos) {
            remove(*extended, added);
            return error(fmt::format("the scene does not contain {}, which entry {} would belong to; set {} itself",
                                     here, in_quotes(key), here));
        }
        walked += (walked.empty() ? "" : ".") + key;
        Node* inner = child(*node, key);
        if (!inner && node->kind == Node::Kind::object) {
            Node empty = object_node();
            empty.place = place;
            inner = &node->members.add({key, place, std::move(empty)}).value;
            if (!extended) extended = node, added = key;
        }
        if (!inner)
            return error(node->kind == Node::Kind::array
                             ? fmt::format("{} has {} entries, counted from 0, but no entry {}", here,
                                           node->items.size(), in_quotes(key))
                             : fmt::format("{} is {}, which has no key {}; set {} itself", here, name(node->kind),
                                           in_quotes(key), here));
        node = inner;
    }
    *node = std::move(value);
}

}  // namespace beamcam::scenes
