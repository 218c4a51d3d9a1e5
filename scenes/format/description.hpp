// The scene format as data: every key with its kind, unit, range, default and meaning, collected by a visitor. The JSON
// Schema, the reference and `beamcam keys` are written from it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "output/json/tree.hpp"
#include "sim/problem/keys.hpp"

namespace beamcam::scenes {

class SceneVisitor;
struct DescribedKey;

// An object with these keys. Tags are keys with a fixed value.
struct DescribedObject {
    std::vector<std::pair<std::string, std::string>> tags;
    bool explicit_tags = false;  // else they may follow from the other keys
    std::string meaning;
    std::vector<DescribedKey> keys;
    std::vector<std::pair<std::string, std::string>> exclusive;  // pairs of keys that exclude each other
};

struct DescribedKey {
    std::string name, type, unit, meaning;
    sim::Range range;
    std::vector<std::string> words;       // allowed values
    Node value;                           // default; null: none, or it depends on other keys
    std::string example;                  // of a required key
    Node schema;                          // of the value
    std::vector<DescribedObject> shapes;  // of an object, or of the objects in a list
    std::vector<DescribedKey> tags;       // of the shapes: the keys that select one
    bool list = false, nullable = false;
    Node item_schema;          // of items that are not objects
    std::string names;         // regular expression of the names of the object's members, which have these shapes
    std::size_t min_size = 0;  // least number of such members
    std::string nested;        // the items of the list have the shapes of what contains it, by that name

    bool required() const { return !example.empty(); }
};

// The schema of a value that has one of these; `choice`: "anyOf" or "oneOf".
Node one_of(const char* choice, std::vector<Node> all);

DescribedObject described(std::string meaning, const std::function<void(SceneVisitor& v)>& visit);
// The scene itself: one shape without tags.
const DescribedObject& scene_format();

std::string schema_text(const DescribedObject& format, const char* title);  // the JSON Schema
std::string reference_text();                                               // Markdown, scenes/FORMAT.md

// A key by its path: "hub.drive.amplitude", "outputs[].size".
struct KeyRow {
    std::string path;
    std::string when;  // tags of its object: "type=torque"
    const DescribedKey* key;
};
std::vector<KeyRow> key_rows();
bool is_of_type(const KeyRow& row, const std::string& type);  // a key of outputs, drives … of this type
// "; its place is "cam.speed"": where a key that an object does not have is a key, the three outermost places; or
// "; it goes with type=torque" if it is a key of that object with other tags. `path`: where it was found,
// "outputs.0.unit". `inside`: only within that object, which has this `type`, or none.
std::string place_of_key(const std::string& path, const std::string& type, bool inside);
std::string range_text(const DescribedKey& key);    // "> 0", "1 … 2"; empty: any
std::string default_text(const DescribedKey& key);  // JSON; empty: none

}  // namespace beamcam::scenes
