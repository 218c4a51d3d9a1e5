#include "scenes/format/tree.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/files/numbers.hpp"

namespace beamcam::scenes {

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

using Json = nlohmann::ordered_json;

Json json_of(const Node& node) {
    Json out;
    switch (node.kind) {
        case Node::Kind::null:
            break;
        case Node::Kind::boolean:
            return node.boolean;
        case Node::Kind::number:
            return node.text.empty() ? Json(node.number) : Json::parse(node.text);
        case Node::Kind::string:
            return node.text;
        case Node::Kind::array:
            out = Json::array();
            for (const Node& item : node.items) out.push_back(json_of(item));
            break;
        case Node::Kind::object:
            out = Json::object();
            for (const Member& member : node.members) out[member.key] = json_of(member.value);
            break;
    }
    return out;
}

}  // namespace

Node number_node(double value) {
    Node node = of_kind(Node::Kind::number);
    node.number = value;
    return node;
}
Node integer_node(long value) {
    Node node = number_node(static_cast<double>(value));
    node.text = std::to_string(value);
    return node;
}
Node boolean_node(bool value) {
    Node node = of_kind(Node::Kind::boolean);
    node.boolean = value;
    return node;
}
Node text_node(std::string value) {
    Node node = of_kind(Node::Kind::string);
    node.text = std::move(value);
    return node;
}
Node array_node(std::vector<Node> items) {
    Node node = of_kind(Node::Kind::array);
    node.items = std::move(items);
    return node;
}
Node numbers_node(const std::vector<double>& values) {
    Node node = array_node();
    for (const double value : values) node.items.push_back(number_node(value));
    return node;
}
Node object_node() { return of_kind(Node::Kind::object); }
void add(Node& object, std::string key, Node value) { object.members.add({std::move(key), {}, std::move(value)}); }

void remove(Node& object, std::string_view key) {
    Members kept;
    for (Member& member : object.members)
        if (member.key != key) kept.add(std::move(member));
    object.members = std::move(kept);
}

std::string to_text(const Node& root) {
    return json_of(root).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

const char* name(Node::Kind kind) {
    switch (kind) {
        case Node::Kind::null:
            return "null";
        case Node::Kind::boolean:
            return "true or false";
        case Node::Kind::number:
            return "a number";
        case Node::Kind::string:
            return "a text";
        case Node::Kind::array:
            return "an array";
        case Node::Kind::object:
            return "an object";
    }
    return "?";
}

std::vector<std::string> split_path(std::string_view path) {
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        names.emplace_back(path.substr(begin, end - begin));
        begin = end + 1;
    }
    return names;
}

const Node* child(const Node& node, std::string_view name) {
    if (const Member* member = node.find(name)) return &member->value;
    const auto index = output::number_in<std::size_t>(name);
    return node.kind == Node::Kind::array && index && *index < node.items.size() ? &node.items[*index] : nullptr;
}
Node* child(Node& node, std::string_view name) { return const_cast<Node*>(child(std::as_const(node), name)); }

}  // namespace beamcam::scenes
