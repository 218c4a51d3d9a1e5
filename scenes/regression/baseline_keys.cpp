// The keys of a file of baselines, described once: reader, writer and schema follow from `visit`. What the program
// writes there itself (`renderers`) is read leniently.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/format/description.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/regression/baselines.hpp"

namespace beamcam::scenes {
namespace {

// The value as it stands in the file; read_baselines reads it with the rest of the entry.
ValueFormat node_format(Node& value, const char* type, const char* schema) {
    return {type, schema, [&value](ObjectReader&, const Node& node, const std::string&) { value = node; },
            [&value] { return value; }};
}

// `what`, `item`: "KEY must be <what>", "KEY.1 must be <item>".
ValueFormat texts_format(std::vector<std::string>& texts, const char* what, const char* item,
                         const char* item_schema = R"({"type": "string"})",
                         bool (*is_valid)(const std::string& text) = nullptr) {
    const auto read = [&texts, what, item, is_valid](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::array) return r.expect(node, key, "{}", what);
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            const Node& each = node.items[i];
            if (each.kind == Node::Kind::string && (!is_valid || is_valid(each.text)))
                texts.push_back(each.text);
            else
                r.expect(each, fmt::format("{}.{}", key, i), "{}", item);
        }
    };
    return {"list of texts", fmt::format(R"({{"type": "array", "items": {}}})", item_schema), read,
            [&texts] { return Node(texts); }};
}

bool is_digest(const std::string& text) {
    return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

ValueFormat renderers_format(std::map<std::string, RendererParts>& renderers) {
    const auto read = [&renderers](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::object) return r.expect(node, key, "an object {{ … }}");
        for (const Member& member : node.members)
            for (const Member& part : member.value.members) renderers[member.key][part.key] = part.value.text;
    };
    return {
        "object of versions by renderer",
        R"({"type": "object", "additionalProperties": {"type": "object", "additionalProperties": {"type": "string"}}})",
        read, [&renderers] { return renderers.empty() ? Node() : Node(renderers); }};
}

// The names of an object's members are the ids of renderers.
NamedItems tolerances_of_renderers(std::map<std::string, Tolerance>& tolerances) {
    return {"^[0-9a-f]{12}$",  // Fingerprint::id
            "is not the id of a renderer; `beamcam doctor` prints those of this machine",
            [&tolerances](SceneVisitor& v, const std::string& id) { visit(v, tolerances[id]); }};
}

NamedItems named_entries(std::vector<Baseline>& entries) {
    return {"^[A-Za-z0-9_-][A-Za-z0-9_.-]{0,99}$",
            "is the name of files, too: use letters, digits, '-', '_' and '.' only",
            [&entries](SceneVisitor& v, const std::string& name) {
                entries.emplace_back().name = name;
                visit(v, entries.back());
            },
            1};
}

}  // namespace

static void visit(SceneVisitor& v, Accepted& accepted) {
    v.text("renderer", accepted.renderer, "The renderer that draws these pixels.");
    v.value(sim::required("sha256", "[\"0123…\"]"),
            texts_format(accepted.sha256, "an array of digests", "a digest of 64 digits 0…9 a…f",
                         R"({"type": "string", "pattern": "^[0-9a-f]{64}$"})", is_digest),
            "SHA-256 of the decoded RGBA pixels, one for each picture.");
}

void visit(SceneVisitor& v, Tolerance& tolerance) {
    v.integer("channel", tolerance.channel, 0, 255,
              "Largest difference of a colour channel that counts as none; by default 0, for lit views 2.");
    v.number("share", tolerance.share, sim::dimension::kNone, sim::between(0, 1),
             "Share of the pixels that may differ by more; by default 0.");
    v.number("ssim", tolerance.ssim, sim::dimension::kNone, sim::between(0, 1),
             "Pictures of at least this structural similarity (brightness, Wang et al. 2004) are equivalent, whatever "
             "their pixels; by default none are.");
}

void visit(SceneVisitor& v, Tolerances& tolerances) {
    visit(v, tolerances.common);
    v.number("motion", tolerances.common.motion, sim::dimension::kNone, sim::between(0, 1),
             "Largest difference of a channel, as a share of its range, up to the reproducible horizon; of sweeps, "
             "where motions settle; by default 2e-5.");
    v.number("impacts", tolerances.common.impacts, sim::dimension::kNone, sim::between(0, 1),
             "Largest relative difference of an impact's quantities; its times may differ by that share of a "
             "millisecond; by default 1e-4.");
    v.named("renderers", tolerances_of_renderers(tolerances.by_renderer),
            "Others for the pictures of some renderers, by the ids that `beamcam doctor` prints.");
}

void visit(SceneVisitor& v, Baseline& entry) {
    v.value(
        "scene",
        node_format(entry.scene_key, "file name or scene", R"({"anyOf": [{"type": "string"}, {"type": "object"}]})"),
        "A scene file, relative to this one, or a scene.");
    v.text("file", entry.file,
           "Pictures that another program made, in place of a scene, relative to this file: a PNG file, a folder, a "
           "sequence such as \"a-####.png\", or a film.");
    v.text("expected", entry.expected,
           "Pictures that are expected in place of accepted digests, relative to this file: the same kinds of files.");
    v.value("set", texts_format(entry.set, "an array of strings", "a string such as \"cam.speed=5\""),
            "Changes of the scene, as --set takes them.");
    v.value("output", node_format(entry.output_key, "object", R"({"type": "object", "required": ["type"]})"),
            "What is tested, as an output of a scene: still, frames, figure (a picture and the motion behind it); "
            "trajectory, shapes, impacts, summary (the motion); or sweep, the scene's own (the attractors).");
    v.exclusive("file", "scene");
    v.exclusive("file", "output");
    v.constrain_schema(R"({"anyOf": [{"required": ["scene", "output"]}, {"required": ["file"]}]})");
    v.boolean("physics", entry.physics, "Whether the motion behind a picture is compared, too.");
    v.object("tolerance", entry.tolerances, "Tolerances of this entry.");
    v.list("accepted", SceneVisitor::items_of(entry.accepted),
           "Written by the program: the accepted pictures, of each renderer.");
    v.number("reproducible_until", entry.reproducible_until, sim::dimension::kTime, sim::kNotNegative,
             "Written by the program: time up to which the motion is compared.");
}

void visit(SceneVisitor& v, Baselines& all) {
    std::string schema;
    v.text("$schema", schema, "Location of the JSON Schema, for editors.");
    v.text(sim::derived("references"), all.folder,
           "Folder of reference pictures and motions, relative to this file; by default this file's name without its "
           "ending.");
    v.object("tolerance", all.tolerances, "Tolerances of all entries that have none of their own.");
    v.named(sim::required("entries", "{\"fall\": {\"scene\": \"fall.json\", \"output\": {…}}}"),
            named_entries(all.entries), "By name, which is also that of a folder among the references.");
    v.value("renderers", renderers_format(all.renderers),
            "Written by the program: what determines the pixels of the accepted digests.");
}

std::string baselines_schema_text() {
    const DescribedObject format = described(
        "What `beamcam test` renders and simulates again, and what it expects. The program accepts comments and "
        "trailing commas.",
        [](SceneVisitor& v) {
            Baselines all;
            visit(v, all);
        });
    return schema_text(format, "beamcam baselines");
}

}  // namespace beamcam::scenes
