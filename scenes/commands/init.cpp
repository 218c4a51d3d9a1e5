// `beamcam init`, `examples` and `schema`: scenes to start from.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "output/files/atomic_file.hpp"
#include "output/files/errors.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/description.hpp"
#include "scenes/format/embedded.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/regression/baselines.hpp"

namespace beamcam::scenes {
namespace {

struct InitArguments {
    Common common;
    std::string name, from;
};

// Null if no example has the name.
const EmbeddedText* example(const std::string& name) {
    const auto is_named = [&](const EmbeddedText& scene) {
        return scene.name == name || std::string(scene.name) + ".json" == name;
    };
    const std::span<const EmbeddedText> all = embedded_scenes();
    const auto found = std::ranges::find_if(all, is_named);
    return found == all.end() ? nullptr : &*found;
}

// The example that --from names, else that of the new file's name, else the default one.
const EmbeddedText& example_for(const InitArguments& args) {
    const EmbeddedText* found = example(args.from.empty() ? args.name : args.from);
    if (!found && args.from.empty()) found = example("default");
    if (found) return *found;
    std::vector<std::string> known;
    for (const EmbeddedText& scene : embedded_scenes()) known.emplace_back(scene.name);
    throw UsageError(
        fmt::format("no example is named {}{}", in_quotes(args.from), suggestion_or_list(args.from, known)));
}

// The name as a word of the shell.
std::string shell_word(std::string name) {
    if (name.find_first_of(" \t'\"\\$`&;|<>()*?[]{}!#~") == std::string::npos) return name;
    replace_all(name, "'", "'\\''");
    return "'" + name + "'";
}

int act(const InitArguments& args) {
    const EmbeddedText& example = example_for(args);
    const std::string own = std::filesystem::path(example.name).filename().string();
    const std::string name = !args.name.empty() ? args.name : args.from.empty() ? "scene" : own;
    std::string text(example.text);
    replace_all(text, "\"../beamcam-scene.schema.json\"", "\"beamcam-scene.schema.json\"");
    if (name == "-") {
        print_data(text);
        return 0;
    }
    const std::filesystem::path path(name.ends_with(".json") ? name : name + ".json");
    // Outputs named after the example get the name of the new scene.
    replace_all(text, fmt::format("\"{}.", own), fmt::format("\"{}.", path.stem().string()));
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::symlink_status(path, ignored)) && !args.common.force)
        throw output::WouldOverwrite(
            fmt::format("{} exists; choose another name, or replace it with --force", path.string()));
    output::write_file(path, text);
    inform(args.common, fmt::format("wrote {}; `beamcam run {}` makes its outputs, `beamcam schema > "
                                    "beamcam-scene.schema.json` lets an editor complete its keys",
                                    path.string(), shell_word(path.string())));
    return 0;
}

void list_examples(const Common&) {
    std::size_t width = 0;
    for (const EmbeddedText& scene : embedded_scenes()) width = std::max(width, scene.name.size());
    std::string text;
    for (const EmbeddedText& scene : embedded_scenes())
        text += fmt::format("{:<{}}  {}\n", scene.name, width, scene.summary());
    print_text(text);
}

struct SchemaArguments {
    bool baselines = false;
};

void print_schema(const SchemaArguments& args) {
    print_data(args.baselines ? baselines_schema_text() : schema_text(scene_format(), "beamcam scene"));
}

}  // namespace

void add_init(Program& program) {
    const auto [app, args] =
        add_command<InitArguments>(program, "init", "Write a scene with comments to start from", act);
    add_examples(app, {"init", "init fast-cam", "init fast --from fast-cam"});
    app.add_option("NAME", args.name,
                   "Name of the new file (default: scene, or the name of the example); - is standard output");
    add_option(app, "--from", args.from, "EXAMPLE",
               "Copy this example instead of that of the name; `beamcam examples` lists all");
    app.add_flag("--force", args.common.force, "Replace an existing file");
    add_quiet(app, args.common);
}

void add_examples(Program& program) {
    add_command<Common>(program, "examples", "List the examples that `beamcam init --from` copies", list_examples);
}

void add_schema(Program& program) {
    const auto [app, args] =
        add_command<SchemaArguments>(program, "schema", "Print the JSON Schema of scenes, for editors", print_schema);
    add_examples(app, {"schema > beamcam-scene.schema.json"});
    app.add_flag("--baselines", args.baselines, "Print the schema of the baselines of `beamcam test` instead");
}

}  // namespace beamcam::scenes
