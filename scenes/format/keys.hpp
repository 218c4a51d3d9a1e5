// Every key of a scene, described once: the keys of the problem in sim/problem/keys.cpp, those of each output type in
// its file in outputs/, the others in keys.cpp. The reader, the writer and the reference are SceneVisitors.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "output/json/tree.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/problem/keys.hpp"

namespace beamcam::scenes {

class ObjectReader;
class SceneVisitor;
using sim::Key;

// A value with a notation of its own, such as "1280x720" or "impact:2".
struct ValueFormat {
    const char* type;    // for the reference: "[width, height]"
    std::string schema;  // JSON Schema
    std::function<void(ObjectReader& reader, const Node& node, const std::string& key)> read;
    std::function<Node()> write;  // null: the key is left out
};

struct List {
    std::size_t size;
    std::function<void(SceneVisitor& v, std::size_t index)> item;  // visits an object; adds one if index == size
    std::size_t min_size = 0, max_size = std::numeric_limits<std::size_t>::max();
    const char* of = "objects";  // for messages: "2 to 8 motions"
    const char* example = nullptr;
    std::optional<ValueFormat> format = {};  // of items that are not objects
    const char* nested = nullptr;            // name in the schema if items have the shape of the list's own object
};

// An object whose keys are names.
struct NamedItems {
    const char* pattern;                                                  // regular expression of the names
    const char* wrong_name;                                               // of another name: "NAME <wrong_name>"
    std::function<void(SceneVisitor& v, const std::string& name)> visit;  // the object of this name; adds one
    std::size_t min_size = 0;
};

class SceneVisitor : public sim::Visitor {
  public:
    using Fields = std::function<void(Visitor&)>;

    // A value with its own notation; with `fields` an object with these keys, too.
    virtual void value(const Key& key, const ValueFormat& format, const char* meaning, const Fields& fields = {}) = 0;
    virtual void list(const Key& key, const List& list, const char* meaning) = 0;
    void list(const Key& key, const sim::Objects& objects, const char* meaning) final {
        List all{objects.size, objects.item, objects.min_size, objects.max_size, objects.of};
        list(key, all, meaning);
    }
    // The keys "file" and "units"; lists that are visited after them may be names of the file's columns.
    void file_of_columns() final;
    virtual void named(const Key& key, const NamedItems& items, const char* meaning) = 0;
    void exclusive(const char* one, const char* other) override = 0;
    virtual void problem(sim::Problem& problem) { visit(*this, problem); }
    // A rule between the keys visited so far, or between them and the scene. Only the reader applies it.
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

    template <class Struct>
    static Fields keys_of(Struct& value) {
        return [&value](Visitor& v) { visit(static_cast<SceneVisitor&>(v), value); };
    }
    // The keys that `visit_some` visits.
    template <class Struct>
    static Fields keys_of(Struct& value, void (*visit_some)(SceneVisitor&, Struct&)) {
        return [&value, visit_some](Visitor& v) { visit_some(static_cast<SceneVisitor&>(v), value); };
    }
    using Visitor::object;
    template <class Struct>
    void object(const Key& key, Struct& value, const char* meaning) {
        object(key, keys_of(value), meaning, nullptr);
    }
    template <class Struct>
    static List items_of(std::vector<Struct>& values) {
        return {values.size(), [&values](SceneVisitor& v, std::size_t index) {
                    if (index >= values.size()) values.emplace_back();
                    visit(v, values[index]);
                }};
    }

  protected:
    struct ColumnsFile {
        std::string file;
        std::vector<std::pair<std::string, std::string>> units;  // by column
    };
    std::optional<ColumnsFile> columns_;  // of the object that is visited
};

ValueFormat column_units_format(std::vector<std::pair<std::string, std::string>>& units);

inline constexpr sim::Named<render::Style> kStyles[] = {
    {render::Style::lit, "lit"}, {render::Style::flat, "flat"}, {render::Style::solid, "solid"}};
inline constexpr sim::Named<Lang> kLanguages[] = {{Lang::en, "en"}, {Lang::zh, "zh"}};

void visit(SceneVisitor& v, Scene& scene);
void visit_outputs(SceneVisitor& v, Scene& scene);
void visit(SceneVisitor& v, Output& output);
void visit(SceneVisitor& v, render::LayoutNode& node);
void visit(SceneVisitor& v, Compared& motion);
void visit(SceneVisitor& v, Measurement& data);
void visit(SceneVisitor& v, PlottedTable& table);
void visit(SceneVisitor& v, Sweep& sweep);

Node tree_of(const std::function<void(SceneVisitor& v)>& visit);
Node to_tree(const Scene& scene);  // all keys, with resolved defaults
Node to_tree(const sim::Problem& problem);
Node to_tree(const Output& output);

}  // namespace beamcam::scenes
