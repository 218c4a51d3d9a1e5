// Writes a resolved scene as a tree that reads back to the same scene.
#include "scenes/format/keys.hpp"

namespace beamcam::scenes {
namespace {

using sim::Length, sim::Range, sim::Unit;

class Writer final : public SceneVisitor {
  public:
    Node take() { return std::move(object_); }

    void number(const Key& key, std::optional<double>& value, const Unit&, const Range&, const char*,
                const char* word) override {
        if (value)
            put(key, *value);
        else if (word)
            put(key, word);
    }
    void numbers(const Key& key, std::vector<double>& values, const Unit&, const Range&, const Length& length,
                 const char*) override {
        if (values.empty()) return;
        if (length.or_one_number && values.size() == 1) return put(key, values.front());
        put(key, values);
    }
    void integer(const Key& key, std::optional<int>& value, int, int, const char*) override {
        if (value) put(key, *value);
    }
    void boolean(const Key& key, bool& value, const char*) override { put(key, value); }
    void text(const Key& key, std::string& value, const char*) override { put(key, value); }
    void keyword(const Key& key, const std::vector<std::string>& words, std::size_t& chosen, const char*) override {
        if (key.written) put(key, words[chosen]);
    }
    void object(const Key& key, const Fields& fields, const char*, bool* present) override {
        if (present && !*present) return put(key, Node{});
        Writer inside;
        if (key.written) fields(inside);
        put(key, inside.take());
    }
    void alternatives(const std::vector<sim::Alternative>& all, bool) override {
        for (const sim::Alternative& each : all) {
            if (!each.chosen) continue;
            for (const auto& [tag, word] : each.tags) put(tag, word);
            return each.fields(*this);
        }
    }
    void value(const Key& key, const ValueFormat& format, const char* meaning, const Fields& fields) override {
        if (!key.written) return;
        if (Node node = format.write(); !node.is_null())
            put(key, std::move(node));
        else if (fields)
            object(key, fields, meaning, nullptr);
    }
    void list(const Key& key, const List& list, const char*) override {
        if (list.size == 0) return;
        Node all = array_node();
        for (std::size_t i = 0; i < list.size; ++i) {
            Writer item;
            list.item(item, i);
            all.items.push_back(item.take());
        }
        put(key, std::move(all));
    }
    void named(const Key&, const NamedItems&, const char*) override {}  // such objects are written by users only
    void exclusive(const char*, const char*) override {}

  private:
    void put(const Key& key, Node value) {
        if (key.written) add(object_, key.name, std::move(value));
    }

    Node object_ = object_node();
};

// Visitors take mutable structs, so this visits a copy.
template <class Struct>
Node written_tree(Struct visited) {
    return tree_of([&visited](SceneVisitor& v) { visit(v, visited); });
}

}  // namespace

Node tree_of(const std::function<void(SceneVisitor& v)>& visit) {
    Writer writer;
    visit(writer);
    return writer.take();
}

Node to_tree(const Scene& scene) { return written_tree(scene); }
Node to_tree(const sim::Problem& problem) { return written_tree(problem); }
Node to_tree(const Output& output) { return written_tree(output); }

std::string to_json(const Scene& scene) { return to_text(to_tree(scene)); }

}  // namespace beamcam::scenes
