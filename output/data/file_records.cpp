#include "output/data/file_records.hpp"

#include <fmt/format.h>

#include "output/files/numbers.hpp"
#include "output/json/tree.hpp"

namespace beamcam::output {
namespace {

constexpr const char* kManifestFormat = "beamcam manifest 1";

Node node_of_record(const FileRecord& made) {
    Node entry = object_node({{"sha256", made.sha256}, {"size", made.size}});
    for (const auto& [key, text] : {std::pair{"version", &made.origin.version}, std::pair{"scene", &made.origin.scene},
                                    std::pair{"inputs", &made.origin.inputs}, std::pair{"stamp", &made.stamp}})
        if (!text->empty()) add(entry, key, *text);
    return entry;
}

// The text of a key; nothing if the node has no such text.
std::optional<std::string> text_at(const Node& node, const char* key) {
    const Member* member = node.find(key);
    return member && member->value.kind == Node::Kind::string ? std::optional(member->value.text) : std::nullopt;
}

// Nothing if the entry is invalid.
std::optional<FileRecord> record_of_node(const Node& entry) {
    const Member* size = entry.find("size");
    const auto bytes = size ? number_in<std::uintmax_t>(size->value.text) : std::nullopt;
    const auto digest = text_at(entry, "sha256");
    if (!digest || !bytes) return {};
    const auto text = [&](const char* key) { return text_at(entry, key).value_or(""); };
    return FileRecord{*digest, *bytes, Origin{text("inputs"), text("version"), text("scene")}, text("stamp")};
}

// Null if the text is damaged.
Node parsed(const std::string& text) { return parse(text, 0, text.size()).root; }

}  // namespace

std::string manifest_json(const FileRecords& files) {
    Node records = object_node();
    for (const auto& [name, made] : files) add(records, name, node_of_record(made));
    return to_text(object_node({{"format", kManifestFormat}, {"files", std::move(records)}}));
}

std::optional<FileRecords> parse_manifest(const std::string& text) {
    const Node root = parsed(text);
    const Member* entries = root.find("files");
    if (text_at(root, "format") != kManifestFormat || !entries || entries->value.kind != Node::Kind::object) return {};
    FileRecords files;
    for (const Member& entry : entries->value.members) {
        const auto made = record_of_node(entry.value);
        if (!made) return {};
        files[entry.key] = *made;
    }
    return files;
}

std::string damage_of_manifest(const std::string& text) {
    if (parse_manifest(text)) return {};
    const Parsed read = parse(text, 0, text.size());
    if (read.is_json) return "it is not a list of files";
    const Message& error = read.messages.front();
    return fmt::format("line {}: {}", locate(text, error.place.offset).line, error.text);
}

std::string journal_line(const std::string& temporary) {
    return one_line(object_node({{"temporary", temporary}})) + "\n";
}

std::string journal_line(const std::string& name, const FileRecord& made) {
    return one_line(object_node({{"name", name}, {"made", node_of_record(made)}})) + "\n";
}

JournalLines parse_journal(const std::string& text) {
    JournalLines all;
    for (const std::string& line : split(text, '\n')) {
        const Node root = parsed(line);
        if (auto temporary = text_at(root, "temporary")) all.temporaries.push_back(std::move(*temporary));
        const Member* record = root.find("made");
        const auto made = record ? record_of_node(record->value) : std::nullopt;
        if (const auto name = text_at(root, "name"); name && made) all.placed.emplace_back(*name, *made);
    }
    return all;
}

}  // namespace beamcam::output
