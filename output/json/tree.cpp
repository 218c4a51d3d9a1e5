#include "output/json/tree.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/files/numbers.hpp"

namespace beamcam {

static constexpr std::size_t kFewMembers = 16;  // up to this size a linear search is fastest

const Member* Members::find(std::string_view key) const {
    if (all_.size() > kFewMembers) {
        const auto position = index_.find(key);
        return position == index_.end() ? nullptr : &all_[position->second];
    }
    for (const Member& member : all_)
        if (member.key == key) return &member;
    return nullptr;
}

Member* Members::find(std::string_view key) { return const_cast<Member*>(std::as_const(*this).find(key)); }

Member& Members::add(Member member) {
    all_.push_back(std::move(member));
    if (all_.size() > kFewMembers)
        for (std::size_t i = all_.size() == kFewMembers + 1 ? 0 : all_.size() - 1; i < all_.size(); ++i)
            index_.try_emplace(all_[i].key, i);
    return all_.back();
}

namespace {

Node of_kind(Node::Kind kind) {
    Node node;
    node.kind = kind;
    return node;
}

using Json = nlohmann::json;

// JSON of a value that is neither an array nor an object.
std::string scalar_text(const Node& node) {
    const auto text = [](const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); };
    switch (node.kind) {
        case Node::Kind::boolean:
            return node.boolean ? "true" : "false";
        case Node::Kind::number:
            return text(node.text.empty() ? Json(node.number) : Json::parse(node.text));
        case Node::Kind::string:
            return text(node.text);
        default:
            return "null";
    }
}

constexpr std::size_t kOneLine = std::string::npos;

// Lines are at most `width` long where that is possible; 0: each value has its line.
std::string json_text(const Node& node, std::size_t indent, std::size_t width) {
    const bool array = node.kind == Node::Kind::array;
    if (!array && node.kind != Node::Kind::object) return scalar_text(node);
    const auto joined = [&](const std::string& between, std::size_t inner, std::size_t inner_width) {
        std::string out;
        for (const Node& item : node.items) out += (out.empty() ? "" : between) + json_text(item, inner, inner_width);
        for (const Member& member : node.members)
            out += (out.empty() ? "" : between) + scalar_text(member.key) + ": " +
                   json_text(member.value, inner, inner_width);
        return out;
    };
    const char *open = array ? "[" : "{", *close = array ? "]" : "}";
    const bool empty = node.items.empty() && node.members.empty();
    if (width > 0 || empty) {
        std::string line = open + joined(", ", 0, kOneLine) + close;
        if (empty || width == kOneLine || indent + line.size() <= width) return line;
    }
    const std::string margin = "\n" + std::string(indent + 2, ' ');
    return open + margin + joined("," + margin, indent + 2, width) + "\n" + std::string(indent, ' ') + close;
}

}  // namespace

Node::Node(double value) : kind(Kind::number), number(value) {}
Node::Node(std::string value) : kind(Kind::string), text(std::move(value)) {}
Node::Node(const char* value) : Node(std::string(value)) {}

Node array_node(std::vector<Node> items) {
    Node node = of_kind(Node::Kind::array);
    node.items = std::move(items);
    return node;
}
Node object_node(std::vector<std::pair<std::string, Node>> members) {
    Node node = of_kind(Node::Kind::object);
    for (auto& member : members) add(node, std::move(member.first), std::move(member.second));
    return node;
}
void add(Node& object, std::string key, Node value) { object.members.add({std::move(key), {}, std::move(value)}); }

void remove(Node& object, std::string_view key) {
    Members kept;
    for (Member& member : object.members)
        if (member.key != key) kept.add(std::move(member));
    object.members = std::move(kept);
}

std::string to_text(const Node& root) { return json_text(root, 0, 0) + "\n"; }
std::string one_line(const Node& root) { return json_text(root, 0, kOneLine); }
std::string folded_text(const Node& root, std::size_t width, std::size_t indent) {
    return json_text(root, indent, width);
}

const char* name(Node::Kind kind) {
    static constexpr const char* kNames[] = {"null", "true or false", "a number", "a text", "an array", "an object"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(separator, begin), text.size());
        parts.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::string_view(" \t\r").find(text.front()) != text.npos) text.remove_prefix(1);
    while (!text.empty() && std::string_view(" \t\r").find(text.back()) != text.npos) text.remove_suffix(1);
    return text;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

const Node* child(const Node& node, std::string_view name) {
    if (const Member* member = node.find(name)) return &member->value;
    const auto index = output::number_in<std::size_t>(name);
    return node.kind == Node::Kind::array && index && *index < node.items.size() ? &node.items[*index] : nullptr;
}
Node* child(Node& node, std::string_view name) { return const_cast<Node*>(child(std::as_const(node), name)); }

}  // namespace beamcam
