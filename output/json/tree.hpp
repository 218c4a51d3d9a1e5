// JSON as a tree, for reading and writing. Every key and value that was read remembers its position (reader.cpp); `//`
// and `/* */` comments and trailing commas are accepted.
#pragma once

#include <concepts>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/json/source.hpp"

namespace beamcam {

struct Member;

// The members of an object, in the order of the text, with an index by key.
class Members {
  public:
    const Member* find(std::string_view key) const;
    Member* find(std::string_view key);
    Member& add(Member member);  // at the end; `find` returns the first of equal keys

    std::size_t size() const;
    bool empty() const { return all_.empty(); }
    auto begin() const { return all_.begin(); }
    auto end() const { return all_.end(); }
    auto begin() { return all_.begin(); }
    auto end() { return all_.end(); }

  private:
    std::vector<Member> all_;
    std::map<std::string, std::size_t, std::less<>> index_;  // ordered: fast for any input
};

struct Node {
    enum class Kind { null, boolean, number, string, array, object };

    // Nodes without a position. A value converts to its node: true, 3, 0.5, "text", an array or map of values; an
    // absent one, NaN and infinities are null.
    Node() = default;  // null
    Node(double value);
    Node(std::string value);
    Node(const char* value);
    template <std::same_as<bool> Boolean>  // no pointer
    Node(Boolean value) : kind(Kind::boolean), boolean(value) {}
    template <std::integral Integer>
    requires(!std::same_as<Integer, bool>) Node(Integer value)
        : kind(Kind::number), number(static_cast<double>(value)), text(std::to_string(value)) {}
    template <class Value>
    requires(!std::same_as<Value, Node>) Node(const std::optional<Value>& value)
        : Node(value ? Node(*value) : Node()) {}
    template <class Value>
    Node(const std::vector<Value>& values) : kind(Kind::array), items(values.begin(), values.end()) {}
    template <class Value>
    Node(const std::map<std::string, Value>& values) : kind(Kind::object) {
        for (const auto& [key, value] : values) members.add({key, {}, value});
    }

    Kind kind = Kind::null;
    SourcePosition place;  // first byte of the value
    bool boolean = false;
    double number = 0;
    std::string text;         // the value of a string; a number as it was written
    std::vector<Node> items;  // of an array
    Members members;          // of an object; unique keys

    bool is_null() const { return kind == Kind::null; }
    const Member* find(std::string_view key) const { return members.find(key); }
    Member* find(std::string_view key) { return members.find(key); }
};

struct Member {
    std::string key;
    SourcePosition key_place;
    Node value;
};

inline std::size_t Members::size() const { return all_.size(); }

Node array_node(std::vector<Node> items = {});
// The array of make(value) of each value.
template <class Values, class Make>
Node array_node(const Values& values, Make&& make) {
    Node array = array_node();
    for (const auto& value : values) array.items.push_back(std::invoke(make, value));
    return array;
}
Node object_node(std::vector<std::pair<std::string, Node>> members = {});
void add(Node& object, std::string key, Node value);
void remove(Node& object, std::string_view key);
// JSON: with a line for each value; on one line, without the end of the line; with line breaks only where a line would
// be longer than `width`, without the end of the last one, for a place that is indented.
std::string to_text(const Node& root);
std::string one_line(const Node& root);
std::string folded_text(const Node& root, std::size_t width, std::size_t indent = 0);

const char* name(Node::Kind kind);  // "a number", "an object", …

// "cam.centre.0" as {"cam", "centre", "0"}.
std::vector<std::string> split(std::string_view text, char separator = '.');
std::string_view trimmed(std::string_view text);  // without blanks, tabs and carriage returns at its ends
void replace_all(std::string& text, std::string_view from, std::string_view to);
// The member or, by its index from 0, the item of this name; null if there is none.
const Node* child(const Node& node, std::string_view name);
Node* child(Node& node, std::string_view name);

struct Parsed {
    Node root;
    std::vector<Message> messages;  // one syntax error; or duplicate keys and unusable values
    bool is_json = false;           // false after a syntax error, when `root` is empty
};

// Limits of a scene file.
constexpr std::size_t kLargestScene = 64u << 20;  // [byte]: a drive table of a million points
constexpr int kDeepestScene = 64;                 // nested brackets

// All positions are in source 0.
Parsed parse(std::string_view text);
// Parses JSON that the program itself contains.
Node node_of(std::string_view json);

}  // namespace beamcam
