#include "scenes/format/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "output/files/errors.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/format/presets.hpp"

namespace beamcam::scenes {
namespace {

Scene read_tree(const Node& root, const Source& source, const std::string& scene_name, std::vector<Message>& messages) {
    Scene scene;
    scene.name = scene_name;
    std::map<std::string, OtherScene> others;
    const SceneContext context{scene, root, source, others};
    read_object(
        root, "the scene", [&scene](ObjectReader& r) { visit(r, scene); }, messages, &context);
    return scene;
}

std::string stem(const std::string& path) {
    std::string name = std::filesystem::path(path).stem().string();
    return name.empty() ? "scene" : name;
}

struct CloseFile {
    void operator()(std::FILE* file) const {
        if (file != stdin) std::fclose(file);
    }
};

}  // namespace

bool read_only_output(const Node& output, const std::string& scene_name, const std::string& path, Scene& scene,
                      std::vector<Message>& messages) {
    Node alone = output;
    resolve_preset(alone);
    scene.set_outputs({});
    // Comparisons change sections of the scene: of the resolved scene here, with its overrides.
    const Source resolved{scene_name, to_json(scene), true};
    const Parsed parsed = parse(resolved.text);
    std::map<std::string, OtherScene> others;
    const SceneContext context{scene, parsed.root, resolved, others, path};
    Output read;
    const bool fine = read_object(
        alone, "the output", [&read](ObjectReader& r) { visit(r, read); }, messages, &context);
    scene.set_outputs({std::move(read)});
    return fine;
}

Reading read_scene(Source file, const std::vector<std::string>& overrides) {
    Parsed parsed = parse(file.text);
    Reading reading;
    if (parsed.is_json)
        reading = read_scene(std::move(file), std::move(parsed.root), overrides);
    else
        reading.sources.push_back(std::move(file));
    if (std::ranges::any_of(parsed.messages, &Message::fatal)) reading.scene.reset();
    std::ranges::move(parsed.messages, std::back_inserter(reading.messages));
    std::ranges::stable_sort(reading.messages, {}, &Message::place);
    return reading;
}

Reading read_scene(Source file, Node root, const std::vector<std::string>& overrides) {
    Reading reading;
    const std::string name = stem(file.name);
    reading.sources.push_back(std::move(file));
    reading.root = std::move(root);
    for (const std::string& text : overrides) {
        reading.sources.push_back(override_source(text));
        apply_override(reading.root, text, reading.sources.size() - 1, reading.messages);
    }
    if (Node* outputs = child(reading.root, "outputs")) std::ranges::for_each(outputs->items, resolve_preset);
    Scene scene = read_tree(reading.root, reading.sources.front(), name, reading.messages);
    std::ranges::stable_sort(reading.messages, {}, &Message::place);
    if (std::ranges::none_of(reading.messages, &Message::fatal)) reading.scene = std::move(scene);
    return reading;
}

Source load_source(const std::string& path, const char* remedy) {
    std::error_code ignored;
    if (path != "-" && std::filesystem::is_directory(path, ignored))
        throw output::IoError(fmt::format("{} is a directory; name a scene file inside it", path));
    errno = 0;
    std::unique_ptr<std::FILE, CloseFile> file(path == "-" ? stdin : std::fopen(path.c_str(), "rb"));
    if (!file)
        throw errno == ENOENT ? output::IoError(fmt::format("{} does not exist; {}", path, remedy))
                              : output::read_error(path, errno);
    Source source{path == "-" ? "stdin" : path, {}, true};
    std::array<char, 65536> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) {
        source.text.append(block.data(), n);
        if (source.text.size() > kLargestScene) break;  // the parser reports the size
    }
    if (std::ferror(file.get())) throw output::read_error(path, errno);
    return source;
}

}  // namespace beamcam::scenes
