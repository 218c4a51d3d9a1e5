// A JSON text as a tree that remembers where every key and value stands.
//
// nlohmann-json decides what JSON is and what the values are; it keeps no positions, so the text is
// walked in step with its SAX events, between which only white space, ',' and ':' can occur.
// `//` and `/* */` comments and trailing commas are blanked out beforehand, byte for byte.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "output/data/name_index.hpp"
#include "scenes/format/source.hpp"

namespace beamcam::scenes {

struct Member;

// Of an object, in the order of the text; found by key without walking them all.
class Members {
  public:
    const Member* find(std::string_view key) const;
    Member* find(std::string_view key);
    Member& add(Member member);  // at the end; `find` gives the first of equal keys
    void drop_last();

    std::size_t size() const { return all_.size(); }
    bool empty() const { return all_.empty(); }
    auto begin() const { return all_.begin(); }
    auto end() const { return all_.end(); }
    auto begin() { return all_.begin(); }
    auto end() { return all_.end(); }
    const Member& back() const { return all_.back(); }
    Member& back() { return all_.back(); }

  private:
    std::vector<Member> all_;
    output::NameIndex index_;
};

struct Node {
    enum class Kind { null, boolean, number, string, array, object };

    Kind kind = Kind::null;
    Place place;  // first byte of the value
    bool boolean = false;
    double number = 0;
    std::string text;         // a string's value; a number as it was written
    std::vector<Node> items;  // of an array
    Members members;          // of an object, keys unique

    const Member* find(std::string_view key) const { return members.find(key); }
    Member* find(std::string_view key) { return members.find(key); }
};

struct Member {
    std::string key;
    Place key_place;
    Node value;
};

// Values that are written; numbers of a tree that was read keep their spelling.
Node number_node(double value);
Node integer_node(long value);
Node boolean_node(bool value);
Node text_node(std::string value);
Node array_node(std::vector<Node> items = {});
Node object_node();
void add(Node& object, std::string key, Node value);
void remove(Node& object, std::string_view key);
std::string to_text(const Node& root);  // JSON, two spaces a level

const char* name(Node::Kind kind);  // "a number", "an object", …

struct Parsed {
    Node root;
    std::vector<Message> messages;  // one syntax error, or duplicate keys and unusable numbers
    bool is_json = false;           // false: a syntax error; `root` means nothing
};

// Largest text and deepest nesting that a scene can need; above them the file is not a scene.
constexpr std::size_t kLargestScene = 64u << 20;  // [byte]: a drive table of a million points
constexpr int kDeepestScene = 64;

// `source` is the index that the places will carry.
Parsed parse(std::string_view text, std::size_t source = 0);
// Of a text that the program itself brings, which has no errors.
Node node_of(std::string_view json);

// The text with comments and trailing commas turned into spaces; every other byte stays in place.
// An unclosed comment is left as it is, for the parser to refuse.
std::string blank_comments(std::string_view text);

}  // namespace beamcam::scenes
