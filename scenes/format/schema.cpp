// Writes a JSON Schema from the description of keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "render/film/layout.hpp"
#include "scenes/format/description.hpp"
#include "scenes/scene/pictures.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::scenes {
namespace {

// Definitions that value formats refer to.
constexpr const char* kDefinitions = R"({
    "withUnit": {
        "description": "A number and a unit: \"12 mm\", \"300 rpm\", \"2.7 g/cm^3\".",
        "type": "string",
        "pattern": "^ *[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)? *([a-zA-Z°%µμ]| 1/).*$"
    },
    "percentage": {
        "description": "A plain number as text, or a percentage: \"5 %\".",
        "type": "string",
        "pattern": "^ *[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)? *%? *$"
    },
    "anchor": {
        "description": "A part of the mechanism, or a place [x, y] of its plane.",
        "anyOf": [
            {"enum": ["all", "tip", "contact", "cam", "hub"]},
            {"type": "array", "minItems": 2, "maxItems": 2, "items": {"anyOf": [{"type": "number"}, {"$ref": "#/$defs/withUnit"}]}}
        ]
    }
})";

Node instant_schema() {
    std::vector<std::string_view> words, alone{"last"};
    for (const EventWord& event : kEventWords) {
        words.push_back(event.word);
        if (event.alone) alone.push_back(event.word);
    }
    const std::string pattern =
        fmt::format("^(({}):[1-9][0-9]{{0,8}}|{})$", fmt::join(words, "|"), fmt::join(alone, "|"));
    return object_node({{"description", fmt::format("A time, \"last\" (the end), or an event, counted from 1: {}.",
                                                    event_notations())},
                        {"anyOf", array_node({object_node({{"type", "number"}, {"minimum", 0}}),
                                              object_node({{"$ref", "#/$defs/withUnit"}}),
                                              object_node({{"type", "string"}, {"pattern", pattern}})})}});
}

// A panel that needs only its name, or a channel in a strip.
Node panel_schema() {
    std::vector<std::string> names;
    for (const render::PanelType& type : render::panel_types())
        if (!type.takes_channels) names.emplace_back(type.name);
    return object_node(
        {{"anyOf", array_node({object_node({{"enum", names}}),
                               node_of(R"({"allOf": [{"$ref": "#/$defs/channel"}, {"not": {"const": "t"}}]})")})}});
}

Node channel_schema() {
    std::vector<std::string> names;
    for (const sim::Channel& channel : sim::all_channels({}))
        if (!sim::traits(channel.kind).of_mode) names.push_back(name(channel));
    return object_node(
        {{"anyOf",
          array_node({object_node({{"enum", names}}),
                      node_of(R"({"description": "A coordinate of the beam, q1 … qN, or its rate, q1_dot … qN_dot.",
        "type": "string", "pattern": "^q[1-9][0-9]*(_dot)?$"})")})}});
}

class SchemaWriter {
  public:
    Node write(const DescribedObject& format, const char* title) {
        definitions_ = node_of(kDefinitions);
        add(definitions_, "instant", instant_schema());
        add(definitions_, "panelName", panel_schema());
        add(definitions_, "channel", channel_schema());
        Node out = object_node({{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}});
        append(out, object(format));
        std::set<std::string> used;
        find_used(out, used);
        Node definitions = object_node();
        for (Member& each : definitions_.members)
            if (used.contains(each.key)) definitions.members.add(std::move(each));
        add(out, "$defs", std::move(definitions));
        return out;
    }

  private:
    static void append(Node& out, Node more) {
        for (Member& member : more.members) out.members.add(std::move(member));
    }
    static Node reference(const std::string& name) { return object_node({{"$ref", "#/$defs/" + name}}); }

    // Adds the names of the definitions to which the schema refers, and to which these refer.
    void find_used(const Node& schema, std::set<std::string>& used) const {
        const std::string text = one_line(schema);
        for (const Member& each : definitions_.members)
            if (text.find(fmt::format("\"#/$defs/{}\"", each.key)) != std::string::npos && used.insert(each.key).second)
                find_used(each.value, used);
    }

    Node object(const DescribedObject& shape) {
        Node properties = object_node(), needed = array_node();
        for (const auto& [tag, word] : shape.tags) {
            add(properties, tag, object_node({{"const", word}}));
            if (shape.explicit_tags) needed.items.emplace_back(tag);
        }
        for (const DescribedKey& key : shape.keys) {
            add(properties, key.name, property(key));
            if (key.required()) needed.items.emplace_back(key.name);
        }
        Node out = object_node({{"description", shape.meaning},
                                {"type", "object"},
                                {"properties", std::move(properties)},
                                {"patternProperties", node_of(R"({"^x-": true})")},
                                {"additionalProperties", false}});
        if (!needed.items.empty()) add(out, "required", std::move(needed));
        const Node& known = out.find("properties")->value;
        std::vector<Node> together;
        for (const auto& [one, other] : shape.exclusive)
            if (known.find(one) && known.find(other))
                together.push_back(node_of(fmt::format(R"({{"required": ["{}", "{}"]}})", one, other)));
        if (!together.empty()) add(out, "not", one_of("anyOf", std::move(together)));
        return out;
    }

    // The schema of an object that has one of these shapes. A recursive one goes into the definitions.
    Node objects(const std::vector<DescribedObject>& shapes) {
        std::vector<Node> all;
        std::string recursive;
        for (const DescribedObject& shape : shapes) {
            all.push_back(object(shape));
            for (const DescribedKey& key : shape.keys)
                if (!key.nested.empty()) recursive = key.nested;
        }
        Node out = one_of("oneOf", std::move(all));
        if (recursive.empty()) return out;
        if (!definitions_.find(recursive)) add(definitions_, recursive, std::move(out));
        return reference(recursive);
    }

    Node value(const DescribedKey& key) {
        if (key.shapes.empty() && !key.list) return key.schema;
        Node inside = key.nested.empty() ? objects(key.shapes) : reference(key.nested);
        if (!key.names.empty()) {
            Node out = object_node({{"type", "object"}});
            if (key.min_size > 0) add(out, "minProperties", key.min_size);
            add(out, "propertyNames", object_node({{"pattern", key.names}}));
            add(out, "additionalProperties", std::move(inside));
            return out;
        }
        if (key.list) {
            Node out = key.schema;
            std::vector<Node> items;
            if (!key.item_schema.is_null()) items.push_back(key.item_schema);
            items.push_back(std::move(inside));
            add(out, "items", one_of("anyOf", std::move(items)));
            return out;
        }
        if (key.nullable) return one_of("oneOf", {node_of(R"({"type": "null"})"), std::move(inside)});
        if (key.schema.kind == Node::Kind::object) return one_of("anyOf", {key.schema, std::move(inside)});
        return inside;
    }

    Node property(const DescribedKey& key) {
        Node schema = value(key);
        std::string meaning = key.meaning;
        if (!key.unit.empty()) meaning += fmt::format(" In {}, or a text with a unit.", key.unit);
        remove(schema, "description");
        Node out = object_node({{"description", meaning}});
        append(out, std::move(schema));
        if (!key.value.is_null() && !key.required()) add(out, "default", key.value);
        return out;
    }

    Node definitions_;
};

}  // namespace

std::string schema_text(const DescribedObject& format, const char* title) {
    return folded_text(SchemaWriter().write(format, title), 120) + "\n";
}

}  // namespace beamcam::scenes
