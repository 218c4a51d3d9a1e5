// The keys of a file of baselines, described once: reader, writer and schema follow from `visit`.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/format/description.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/regression/baselines.hpp"

namespace beamcam::scenes {
namespace {

// The value as it stands in the file; read_baselines reads it with the rest of the entry.
ValueFormat node_format(Node& value, const char* type, const char* schema) {
    return {type, schema, [&value](ObjectReader&, const Node& node, const std::string&) { value = node; },
            [&value] { return value; }};
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

void visit(SceneVisitor& v, Tolerance& tolerance) {
    v.integer("channel", tolerance.channel, 0, 255,
              "Largest difference of a colour channel that counts as none; by default 0, for lit views 2.");
    v.number("share", tolerance.share, sim::dimension::kNone, sim::between(0, 1),
             "Share of the pixels that may differ by more; by default 0.");
    v.number("ssim", tolerance.ssim, sim::dimension::kNone, sim::between(0, 1),
             "Pictures of at least this structural similarity (brightness, Wang et al. 2004) are equivalent, whatever "
             "their pixels; by default none are.");
    v.number("motion", tolerance.motion, sim::dimension::kNone, sim::between(0, 1),
             "Largest difference of a channel, as a share of its range, up to the reproducible horizon; of the orbits "
             "of a sweep, as a share of the largest value of a column; by default 2e-5.");
    v.number("impacts", tolerance.impacts, sim::dimension::kNone, sim::between(0, 1),
             "Largest relative difference of an impact's numbers; times of impacts may differ by that "
             "share of a millisecond; by default 1e-4.");
}

void visit(SceneVisitor& v, Baseline& entry) {
    v.value(
        "scene",
        node_format(entry.scene_key, "file name or scene", R"({"anyOf": [{"type": "string"}, {"type": "object"}]})"),
        "A scene file, relative to this one, or a scene.");
    v.value("set", texts_format(entry.set), "Changes of the scene, as --set takes them.");
    v.value("output", node_format(entry.output_key, "object", R"({"type": "object", "required": ["type"]})"),
            "What is tested, as an output of a scene: still, frames, figure (a picture and the motion behind it); "
            "trajectory (by default 1 kHz) and its impacts; or sweep, the scene's own (the attractors).");
    v.boolean("physics", entry.physics, "Whether the motion behind a picture is compared, too.");
    v.object("tolerance", entry.tolerance, "Tolerance of this entry.");
}

void visit(SceneVisitor& v, Baselines& all) {
    std::string schema;
    v.text("$schema", schema, "Location of the JSON Schema, for editors.");
    v.text(sim::derived("references"), all.folder,
           "Folder of the references, relative to this file; by default this file's name without its ending.");
    v.object("tolerance", all.tolerance, "Tolerance of all entries that have none of their own.");
    v.named(sim::required("entries", "{\"fall\": {\"scene\": \"fall.json\", \"output\": {…}}}"),
            named_entries(all.entries), "By name, which is also that of a folder among the references.");
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
