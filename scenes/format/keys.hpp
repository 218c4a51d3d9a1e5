// Every key of a scene, once: those of the problem are visited in sim/problem/keys.cpp, those of each type of output in
// its file (outputs/), the others in keys.cpp. What reads scenes, writes them or explains their format is a
// SceneVisitor.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenes/format/tree.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/problem/keys.hpp"

namespace beamcam::scenes {

class ObjectReader;
class SceneVisitor;
using sim::Key;

// A value that scenes spell in a way of its own, such as "1280x720" or "impact:2".
struct ValueFormat {
    const char* type;    // for people: "[width, height]"
    std::string schema;  // of JSON
    std::function<void(ObjectReader& reader, const Node& node, const std::string& key)> read;
    std::function<std::optional<Node>()> write;  // nothing: the key is left out
};

struct List {
    std::size_t size;
    std::function<void(SceneVisitor& v, std::size_t index)> item;  // an object; the one at `size` is added
    std::size_t least = 0, most = std::numeric_limits<std::size_t>::max();
    const char* of = "objects";  // for messages: "2 to 8 motions"
    const char* example = nullptr;
    std::optional<ValueFormat> form = {};  // of items that are no objects
    const char* nested = nullptr;          // the items have the shape of what contains the list; its name in the schema
};

class SceneVisitor : public sim::Visitor {
  public:
    using Fields = std::function<void(Visitor&)>;

    virtual void value(const Key& key, const ValueFormat& form, const char* meaning) = 0;
    virtual void value_or_object(const Key& key, const ValueFormat& form, const Fields& fields,
                                 const char* meaning) = 0;  // or object
    virtual void list(const Key& key, const List& list, const char* meaning) = 0;
    virtual void exclusive(const char* one, const char* other) = 0;
    // JSON Schema of what the keys visited so far ask of each other; `check` judges it.
    virtual void constrain_schema(const char*) {}
    virtual void problem(sim::Problem& problem) { visit(*this, problem); }
    // What the keys visited so far ask of each other and of the scene; only a reader judges it.
    virtual void check(const std::function<void(ObjectReader&)>&) {}

    using Visitor::choice;
    template <class Enum, std::size_t n>
    void choice(const Key& key, Enum& value, const sim::Named<Enum> (&among)[n], const char* meaning) {
        choice(key, value, std::span<const sim::Named<Enum>>(among), meaning);
    }
    void choice(const Key& key, std::string& value, const std::vector<std::string>& words, const char* meaning) {
        auto chosen = static_cast<std::size_t>(std::ranges::find(words, value) - words.begin());
        if (chosen == words.size()) chosen = 0;
        keyword(key, words, chosen, meaning);
        value = words[chosen];
    }

    using Visitor::object;
    template <class Struct>
    void object(const Key& key, Struct& value, const char* meaning) {
        object(
            key, [&value](Visitor& v) { visit(static_cast<SceneVisitor&>(v), value); }, meaning, nullptr);
    }
    template <class Struct>
    static List items_of(std::vector<Struct>& values) {
        return {values.size(), [&values](SceneVisitor& v, std::size_t index) {
                    if (index >= values.size()) values.emplace_back();
                    visit(v, values[index]);
                }};
    }
};

void visit(SceneVisitor& v, Scene& scene);
void visit_outputs(SceneVisitor& v, Scene& scene);
void visit(SceneVisitor& v, Output& output);
void visit(SceneVisitor& v, render::LayoutNode& node);
void visit(SceneVisitor& v, Compared& motion);
void visit(SceneVisitor& v, Measurement& data);
void visit(SceneVisitor& v, Sweep& sweep);

Node to_tree(const Scene& scene);  // every key, defaults too
Node to_tree(const sim::Problem& problem);
Node to_tree(const Output& output);

}  // namespace beamcam::scenes
