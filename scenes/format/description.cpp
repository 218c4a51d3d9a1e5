#include "scenes/format/description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenes/format/keys.hpp"

namespace beamcam::scenes {
namespace {

using sim::Length, sim::Range, sim::Unit;

Node bounded(const Range& range) {
    Node number = object_node();
    add(number, "type", "number");
    if (std::isfinite(range.min)) add(number, range.exclusive_min ? "exclusiveMinimum" : "minimum", range.min);
    if (std::isfinite(range.max)) add(number, range.exclusive_max ? "exclusiveMaximum" : "maximum", range.max);
    return number;
}

Node with_text(const Unit& unit) {
    return node_of(same(unit.dimension, sim::dimension::kNone) ? R"({"$ref": "#/$defs/percentage"})"
                                                               : R"({"$ref": "#/$defs/withUnit"})");
}

std::string symbol(const Unit& unit) {
    const std::string text = unit.symbol();
    return text == "1" ? "" : text;
}

// The keys that select one of the shapes.
std::vector<DescribedKey> tags_of(const std::vector<DescribedObject>& shapes) {
    std::vector<DescribedKey> tags;
    for (const DescribedObject& shape : shapes)
        for (const auto& [name, word] : shape.tags) {
            auto tag = std::ranges::find(tags, name, &DescribedKey::name);
            if (tag == tags.end()) {
                tag = tags.insert(tag, DescribedKey{});
                tag->name = name;
                tag->type = "word";
                if (shape.explicit_tags) tag->example = fmt::format("\"{}\"", word);
                if (!shape.explicit_tags) tag->meaning = "May be left out where the other keys leave only one choice.";
            }
            const bool is_new = std::ranges::find(tag->words, word) == tag->words.end();
            if (is_new) tag->words.push_back(word);
            if (!tag->meaning.empty()) tag->meaning += ' ';
            tag->meaning += is_new ? fmt::format("{}: {}", word, shape.meaning) : shape.meaning;
        }
    return tags;
}

class Describer final : public SceneVisitor {
  public:
    explicit Describer(std::string meaning) { common_.meaning = std::move(meaning); }

    // The shapes of the object, each with the common keys.
    std::vector<DescribedObject> take() {
        if (shapes_.empty()) return {std::move(common_)};
        for (DescribedObject& shape : shapes_) {
            shape.keys.insert(shape.keys.end(), common_.keys.begin(), common_.keys.end());
            shape.exclusive.insert(shape.exclusive.end(), common_.exclusive.begin(), common_.exclusive.end());
        }
        return std::move(shapes_);
    }

    void number(const Key& key, std::optional<double>& value, const Unit& unit, const Range& range, const char* meaning,
                const char* word) override {
        DescribedKey& d = number_key(key, unit, range, meaning, word);
        d.value = !value && word ? Node(word) : Node(value);
    }
    void numbers(const Key& key, std::vector<double>& values, const Unit& unit, const Range& range,
                 const Length& length, const char* meaning) override {
        const bool fixed = length.min == length.max;
        DescribedKey& d = add_key(key,
                                  length.or_one_number ? "number or numbers"
                                  : fixed              ? fmt::format("{} numbers", length.min)
                                  : columns_           ? "numbers, name of a column, or @FILE.csv:COLUMN"
                                                       : "numbers, or @FILE.csv:COLUMN",
                                  meaning);
        d.unit = symbol(unit);
        d.range = range;
        Node item = one_of("anyOf", {bounded(range), with_text(unit)}), list = node_of(R"({"type": "array"})");
        if (length.min > 0) add(list, "minItems", length.min);
        if (fixed) add(list, "maxItems", length.max);
        add(list, "items", item);
        const char* column = columns_ ? R"({"type": "string"})" : R"({"type": "string", "pattern": "^@.+:.+$"})";
        if (!fixed) list = one_of("anyOf", {std::move(list), node_of(column)});
        d.schema = length.or_one_number ? one_of("anyOf", {bounded(range), with_text(unit), std::move(list)})
                                        : std::move(list);
        if (!values.empty()) d.value = values;
    }
    void integer(const Key& key, std::optional<int>& value, int min, int max, const char* meaning) override {
        DescribedKey& d = add_key(key, "whole number", meaning);
        d.range = sim::between(min, max);
        d.schema = node_of(fmt::format(R"({{"type": "integer", "minimum": {}, "maximum": {}}})", min, max));
        d.value = value;
    }
    void boolean(const Key& key, bool& value, const char* meaning) override {
        DescribedKey& d = add_key(key, "true or false", meaning);
        d.schema = node_of(R"({"type": "boolean"})");
        d.value = value;
    }
    void text(const Key& key, std::string& value, const char* meaning) override {
        DescribedKey& d = add_key(key, "text", meaning);
        d.schema = node_of(R"({"type": "string"})");
        if (!key.derived) d.value = value;
    }
    void keyword(const Key& key, const std::vector<std::string>& words, std::size_t& chosen,
                 const char* meaning) override {
        DescribedKey& d = add_key(key, "word", meaning);
        d.words = words;
        d.schema = object_node({{"enum", words}});
        if (!key.derived && chosen < words.size()) d.value = words[chosen];
    }
    void object(const Key& key, const Fields& fields, const char* meaning, bool* present) override {
        Describer inside(meaning);
        fields(inside);
        DescribedKey& d = add_key(key, present ? "object or null" : "object", meaning);
        add_shapes(d, inside.take());
        d.nullable = present;
    }
    void alternatives(const std::vector<sim::Alternative>& all, bool explicit_tags) override {
        for (const sim::Alternative& each : all) {
            Describer inside(each.meaning);
            each.fields(inside);
            DescribedObject shape = std::move(inside.take().front());
            for (const auto& [tag, word] : each.tags) shape.tags.emplace_back(tag, word);
            shape.explicit_tags = explicit_tags;
            shapes_.push_back(std::move(shape));
        }
    }
    void value(const Key& key, const ValueFormat& format, const char* meaning, const Fields& fields) override {
        DescribedKey& d = add_key(key, format.type, meaning);
        d.schema = node_of(format.schema);
        if (!key.derived) d.value = format.write();
        if (!fields) return;
        Describer inside(meaning);
        fields(inside);
        add_shapes(d, inside.take());
    }
    void list(const Key& key, const List& list, const char* meaning) override {
        std::vector<DescribedObject> shapes;
        if (!list.nested) {
            Describer item(meaning);
            list.item(item, list.size);
            shapes = item.take();
        }
        DescribedKey& d = add_key(key, fmt::format("list of {}", list.of), meaning);
        add_shapes(d, std::move(shapes));
        d.list = true;
        d.nested = list.nested ? list.nested : "";
        if (list.format) d.item_schema = node_of(list.format->schema);
        d.schema = node_of(R"({"type": "array"})");
        if (list.min_size > 0) {
            add(d.schema, "minItems", list.min_size);
            add(d.schema, "maxItems", list.max_size);
        }
    }
    void named(const Key& key, const NamedItems& items, const char* meaning) override {
        Describer item(meaning);
        items.visit(item, "");
        DescribedKey& d = add_key(key, "object of objects", meaning);
        d.shapes = item.take();
        d.names = items.pattern;
        d.min_size = items.min_size;
    }
    void exclusive(const char* one, const char* other) override { common_.exclusive.emplace_back(one, other); }

  private:
    static void add_shapes(DescribedKey& key, std::vector<DescribedObject> shapes) {
        key.shapes = std::move(shapes);
        key.tags = tags_of(key.shapes);
    }
    DescribedKey& add_key(const Key& key, std::string type, const char* meaning) {
        DescribedKey& d = common_.keys.emplace_back();
        d.name = key.name;
        d.type = std::move(type);
        d.meaning = meaning;
        if (key.example) d.example = key.example;
        return d;
    }
    DescribedKey& number_key(const Key& key, const Unit& unit, const Range& range, const char* meaning,
                             const char* word) {
        DescribedKey& d = add_key(key, word ? fmt::format("number or \"{}\"", word) : "number", meaning);
        d.unit = symbol(unit);
        d.range = range;
        std::vector<Node> choices{bounded(range)};
        if (word) choices.push_back(node_of(fmt::format(R"({{"const": "{}"}})", word)));
        if (!unit.plain) choices.push_back(with_text(unit));
        d.schema = one_of("anyOf", std::move(choices));
        return d;
    }

    DescribedObject common_;
    std::vector<DescribedObject> shapes_;
};

}  // namespace

Node one_of(const char* choice, std::vector<Node> all) {
    return all.size() == 1 ? std::move(all.front()) : object_node({{choice, array_node(std::move(all))}});
}

DescribedObject described(std::string meaning, const std::function<void(SceneVisitor& v)>& visit) {
    Describer describer(std::move(meaning));
    visit(describer);
    return std::move(describer.take().front());
}

const DescribedObject& scene_format() {
    static const DescribedObject kFormat = described(
        "A flexible beam on a hub that falls on a rotating cam, and the files to write. Plain numbers are in "
        "SI units; a text may have a unit. Every key has a default: {} is a complete scene. Keys that begin with x- "
        "are ignored.",
        [](SceneVisitor& v) {
            Scene scene;
            visit(v, scene);
        });
    return kFormat;
}

}  // namespace beamcam::scenes
