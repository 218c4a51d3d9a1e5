// The keys of one motion of a comparison.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "output/files/atomic_file.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/format/reader.hpp"

namespace beamcam::scenes {
namespace {

// The sections of a scene in which two compared motions can differ: hub, beam, …
const std::vector<std::string>& mechanics_sections() {
    static const std::vector<std::string> kSections = [] {
        std::vector<std::string> all;
        for (const Member& section : to_tree(sim::Problem{}).members) all.push_back(section.key);
        return all;
    }();
    return kSections;
}

bool is_mechanics(std::string_view section) {
    return std::ranges::find(mechanics_sections(), section) != mechanics_sections().end();
}

// The sections for which `holds` is true.
Node sections_of(const Node& root, bool (*holds)(std::string_view section)) {
    Node out = object_node();
    out.place = root.place;
    for (const Member& member : root.members)
        if (holds(member.key)) out.members.add(member);
    return out;
}
Node mechanics_of(const Node& root) { return sections_of(root, is_mechanics); }

// Its outputs are not read: they may compare it with the scene that names it.
OtherScene read_other(const std::string& path) {
    try {
        Source source{path, output::read_regular_file(path)};
        const Parsed parsed = parse(source.text);
        if (parsed.is_json && parsed.root.kind == Node::Kind::object &&
            std::ranges::none_of(parsed.messages, &Message::fatal)) {
            const Node root = sections_of(parsed.root, [](std::string_view section) { return section != "outputs"; });
            if (read_scene(std::move(source), root, {}).scene) return {mechanics_of(root), {}};
        }
        return {{}, fmt::format("it is not a valid scene; `beamcam check {}` lists its errors", path)};
    } catch (const output::IoError& unreadable) {
        return {{}, unreadable.what()};
    }
}

// The mechanics in another scene file, whose path is relative to this one; nullopt: an error was reported.
std::optional<Node> other_mechanics(ObjectReader& r, const Node& node, const std::string& key) {
    if (node.kind != Node::Kind::string) {
        r.expect(node, key, "a file name in quotes");
        return std::nullopt;
    }
    const auto path = (std::filesystem::path(r.context().source.name).parent_path() / node.text).string();
    auto other = r.context().others.find(path);
    if (other == r.context().others.end()) other = r.context().others.emplace(path, read_other(path)).first;
    if (!other->second.mechanics) r.reject_value(node, key, ": {}", other->second.problem);
    return other->second.mechanics;
}

void set_values(ObjectReader& r, const Node& set, const std::string& key, Node& out) {
    if (set.kind != Node::Kind::object) return r.expect(set, key, "an object such as {{\"cam.speed\": 5}}");
    std::vector<Message> wrong;
    for (const Member& member : set.members)
        if (is_mechanics(member.key.substr(0, member.key.find('.'))))
            set_value(out, member.key, member.value, wrong);
        else
            r.diagnostics().error(
                member.key_place, r.path(key + "." + member.key),
                fmt::format("{}: {} is not part of the mechanics; a comparison can change {}", r.path(key),
                            in_quotes(member.key), fmt::join(mechanics_sections(), ", ")));
    for (const Message& message : wrong) r.diagnostics().error(message.place, r.path(key), message.text);
}

// Reads the problem of these mechanics; errors are reported at the entry of the comparison.
void read_problem(ObjectReader& r, const Node& root, sim::Problem& problem) {
    std::vector<Message> found;
    read_object(
        root, "the scene", [&problem](ObjectReader& sections) { sections.problem(problem); }, found);
    for (const Message& message : found) r.diagnostics().error(message.place, r.path("set"), message.text);
    if (r.diagnostics().failed(r.path("set"))) return;
    std::vector<sim::Issue> findings = sim::validate(problem);
    std::erase_if(findings, [](const sim::Issue& finding) { return !finding.fatal; });
    if (findings.empty()) return;
    const std::vector<sim::Issue> known = sim::validate(r.context().scene.problem);
    const auto of_scene = [&](const sim::Issue& finding) {
        return std::ranges::any_of(known, [&](const sim::Issue& each) {
            return each.path == finding.path && each.message == finding.message;
        });
    };
    for (const sim::Issue& finding : findings)
        if (!of_scene(finding)) r.reject("", ": {}: {}", finding.path, finding.message);
}

}  // namespace

void visit(SceneVisitor& v, Compared& motion) {
    std::optional<Node> base;  // for the reader: the mechanics that `set` changes
    bool readable = true;
    v.text("label", motion.label, "Its name in the picture; by default its number.");
    v.check([&motion](ObjectReader& r) { check_words(r, "label", motion.label); });
    v.check([&](ObjectReader& r) { base = mechanics_of(r.context().root); });
    const auto read_scene_key = [&](ObjectReader& r, const Node& node, const std::string& key) {
        const auto other = other_mechanics(r, node, key);
        readable = other.has_value();
        if (!readable) return;
        base = *other;
        move_to(*base, node.place);
    };
    v.value("scene", {"file name", R"({"type": "string"})", read_scene_key, [] { return Node(); }},
            "File of another scene, relative to this scene's folder; by default this scene.");
    const auto read_set = [&](ObjectReader& r, const Node& node, const std::string& key) {
        if (readable) set_values(r, node, key, *base);
    };
    v.value(sim::derived("set"),
            {"object of key paths",
             fmt::format(R"-({{"type": "object", "propertyNames": {{"pattern": "^({})(\\.|$)"}}}})-",
                         fmt::join(mechanics_sections(), "|")),
             read_set, [&] { return to_tree(motion.problem); }},
            "The changed keys, by path: {\"cam.speed\": 5, \"beam.model\": \"rigid\"}.");
    v.check([&](ObjectReader& r) {
        if (readable) read_problem(r, *base, motion.problem);
    });
}

List compared_motions(std::vector<Compared>& motions) {
    List list = SceneVisitor::items_of(motions);
    list.item = [&motions, visit_item = list.item](SceneVisitor& v, std::size_t index) {
        visit_item(v, index);
        v.check([&](ObjectReader&) {
            if (motions[index].label.empty()) motions[index].label = std::to_string(index + 1);
        });
    };
    list.min_size = 2, list.max_size = kMostCompared, list.of = "motions";
    list.example = "[{\"label\": \"flexible\"}, {\"label\": \"rigid\", \"set\": {\"beam.model\": \"rigid\"}}]";
    return list;
}

}  // namespace beamcam::scenes
