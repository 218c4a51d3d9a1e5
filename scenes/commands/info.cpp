// `beamcam info`: the provenance of a file, from its metadata or from the list of files beside it.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "output/data/file_list.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/errors.hpp"
#include "output/files/text_safety.hpp"
#include "output/film/video_library.hpp"
#include "output/image/png_reader.hpp"
#include "output/json/tree.hpp"
#include "render/base/error.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

struct Provenance {
    std::string file, kind;                    // "PNG picture", "film", "SVG figure", "PDF figure", "table", "record"
    std::map<std::string, std::string> facts;  // size, frames, codec …
    std::string version, title, accuracy;
    std::string scene;    // JSON text; empty: the file contains none
    bool listed = false;  // in the list of files beside it
    bool made_by_beamcam() const { return listed || !version.empty() || !scene.empty(); }
};

// ---- reading ---------------------------------------------------------------------------------------

// The value of a key in lower case: containers change the case.
std::string find(const std::map<std::string, std::string>& metadata, std::string_view key) {
    for (const auto& [name, value] : metadata)
        if (lowered(name) == key) return value;
    return {};
}

// "beamcam 0.1.0" → "0.1.0".
std::string version_in(const std::string& text) {
    const std::size_t at = text.find("beamcam ");
    return at == std::string::npos ? std::string() : text.substr(at + 8);
}

void read_own_keys(const std::map<std::string, std::string>& metadata, Provenance& p) {
    p.scene = find(metadata, "beamcam-scene");
    p.accuracy = find(metadata, "beamcam-accuracy");
    p.title = find(metadata, "title");
    p.version = find(metadata, "beamcam-version");
    for (const char* key : {"software", "comment", "creator"})
        if (p.version.empty()) p.version = version_in(find(metadata, key));
}

void read_png_info(const std::string& file, Provenance& p) {
    p.kind = "PNG picture";
    const output::PngInfo info = output::read_png_info(file);
    p.facts["size"] = fmt::format("{}x{}", info.width, info.height);
    read_own_keys(info.metadata, p);
    // The frames of a sequence name the first one, which has the scene.
    const std::string first = find(info.metadata, "beamcam-scene-in");
    if (first.empty() || first.find('/') != std::string::npos) return;
    p.facts["scene_in"] = first;
    const fs::path beside = fs::path(file).parent_path() / first;
    std::error_code unreadable;
    if (fs::is_regular_file(beside, unreadable))
        p.scene = find(output::read_png_info(beside).metadata, "beamcam-scene");
}

void read_film(const std::string& file, Provenance& p) {
    const output::VideoInfo info = output::video_library().info(file);
    p.kind = "film";
    p.facts["size"] = fmt::format("{}x{}", info.width, info.height);
    p.facts["codec"] = info.codec;
    if (info.frames > 0) p.facts["frames"] = std::to_string(info.frames);
    if (info.seconds > 0) p.facts["duration"] = fmt::format("{:.6g} s", info.seconds);
    read_own_keys(info.metadata, p);
}

// Tables contain only numbers; the list of files beside them describes them.
void read_file_list(const std::string& file, Provenance& p) {
    const auto record = output::FileList::find(file);
    if (!record) return;
    p.listed = true;
    p.version = record->origin.version;
    p.scene = record->origin.scene;
    p.facts["changed_since"] = record->unchanged ? "no" : "yes";
}

void read_table(const std::string& file, Provenance& p) {
    read_file_list(file, p);
    const output::ColumnTable table = output::read_table(file);
    const bool texts = std::ranges::any_of(table.columns, [](const auto& column) { return !column.texts.empty(); });
    p.kind = texts ? "table with texts" : "table";  // texts: such as the data of a figure
    p.facts["rows"] = std::to_string(table.rows());
    p.facts["columns"] = std::to_string(table.columns.size());
}

Provenance provenance_of(const std::string& file) {
    std::error_code error;
    if (fs::is_directory(file, error)) throw output::IoError(fmt::format("{} is a directory; name a file in it", file));
    if (!fs::exists(file, error)) throw output::read_error(file, ENOENT);
    Provenance p;
    p.file = file;
    const std::string ending = lowered(ending_of(file));
    if (output::is_png(file)) {
        read_png_info(file, p);
    } else if (ending == ".csv" || ending == ".npz") {
        read_table(file, p);
    } else if (const char* kind = kind_without_scene(ending)) {
        p.kind = kind;
        read_file_list(file, p);
        if (ending == ".nc") p.facts["content"] = "not read: beamcam writes NetCDF files only";
    } else {
        read_film(file, p);
    }
    return p;
}

std::string provenance_text(const Provenance& p) {
    std::string text = fmt::format("{}: {}\n", output::one_line(p.file), p.kind);
    auto line = [&](std::string_view key, std::string_view value) {
        if (!value.empty()) text += fmt::format("  {:<14} {}\n", key, output::one_line(value));
    };
    for (const auto& [key, value] : p.facts) {
        std::string words = key;
        std::ranges::replace(words, '_', ' ');
        line(words, value);
    }
    line("title", p.title);
    if (!p.made_by_beamcam()) {
        line("made by", "not by beamcam, or the metadata is lost");
        return text;
    }
    line("made by", p.version.empty() ? "beamcam" : "beamcam " + p.version);
    line("accuracy", p.accuracy);
    line("scene", p.scene.empty() ? "none" : "--scene prints it");
    return text;
}

// The scene without outputs on standard output, so that it can be run; empty: it is not JSON.
std::string runnable_scene(const std::string& scene) {
    Parsed parsed = parse(scene);
    if (!parsed.is_json || parsed.root.kind != Node::Kind::object) return {};
    if (Member* outputs = parsed.root.find("outputs"))
        for (Node& output : outputs->value.items) {
            const Member* file = output.find("file");
            if (file && file->value.kind == Node::Kind::string && file->value.text == "-") remove(output, "file");
        }
    return to_text(parsed.root);
}

Node provenance_node(const Provenance& p) {
    Node out = object_node({{"file", p.file}, {"kind", p.kind}});
    for (const auto& [key, value] : p.facts) add(out, key, value);
    add(out, "made_by_beamcam", p.made_by_beamcam());
    for (const auto& [key, value] :
         {std::pair{"version", &p.version}, std::pair{"accuracy", &p.accuracy}, std::pair{"title", &p.title}})
        if (!value->empty()) add(out, key, *value);
    if (p.scene.empty()) return out;
    Parsed scene = parse(p.scene);
    add(out, "scene", scene.is_json ? std::move(scene.root) : Node(p.scene));
    return out;
}

struct InfoArguments {
    Common common;
    std::vector<std::string> files;
    bool scene = false;
};

void print_info(const InfoArguments& args, const std::string& file) {
    const Provenance found = provenance_of(file);
    if (!args.scene) return print_result(args.common, to_text(provenance_node(found)), provenance_text(found));
    const std::string scene = runnable_scene(found.scene);
    if (scene.empty())
        throw output::IoError(fmt::format(
            "{} contains no scene: beamcam did not make it, or another program removed its metadata", file));
    print_json(scene);
}

int act(const InfoArguments& args) {
    if (args.scene && args.files.size() != 1) throw UsageError("--scene prints one scene; name one file");
    return for_each_file(args.files, [&](const std::string& file) { print_info(args, file); });
}

}  // namespace

void add_info(Program& program) {
    const auto [app, args] =
        add_command<InfoArguments>(program, "info", "Print the provenance of a picture, film, figure or table", act);
    add_examples(app, {"info fall.mp4", "info fall.mp4 --scene > fall.json"});
    app.add_option("FILE", args.files, "Files that beamcam made")->required();
    app.add_flag("--scene", args.scene,
                 "Print the scene that the file was made from; `beamcam run` makes the same file from it");
    add_json(app, args.common);
}

}  // namespace beamcam::scenes
