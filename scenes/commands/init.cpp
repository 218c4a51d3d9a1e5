#include <fmt/format.h>

#include <filesystem>

#include "output/files/atomic_file.hpp"
#include "output/files/errors.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/description.hpp"
#include "scenes/format/embedded.hpp"

namespace beamcam::scenes {
namespace {

struct Arguments {
    Common common;
    std::string name = "scene";
};

int act(const Arguments& args) {
    std::string text(default_scene_text());
    const std::filesystem::path path(args.name.ends_with(".json") ? args.name : args.name + ".json");
    if (args.name == "-") {
        print_data(text);
        return 0;
    }
    const std::string film = "\"default.mp4\"", title = path.stem().string();
    if (const std::size_t at = text.find(film); at != std::string::npos)
        text.replace(at, film.size(), fmt::format("\"{}.mp4\"", title));
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::symlink_status(path, ignored)) && !args.common.force)
        throw output::WouldOverwrite(
            fmt::format("{} exists; choose another name, or replace it with --force", path.string()));
    output::write_file(path, text);
    say(args.common, fmt::format("wrote {}; `beamcam run {}` films it, `beamcam schema > beamcam-scene.schema.json` "
                                 "lets an editor complete its keys",
                                 path.string(), path.string()));
    return 0;
}

struct SchemaArguments {
    bool baselines = false;
};

int print_schema(const SchemaArguments& args) {
    print_data(args.baselines ? std::string(baselines_schema_text()) : schema_text());
    return 0;
}

}  // namespace

void add_init(Grammar& grammar) {
    auto args = std::make_shared<Arguments>();
    Command& app = grammar.command("init", "Write a commented scene to start from");
    app.positional("NAME", &args->name, "Its name (default: scene); - is standard output");
    app.flag("--force", args->common.force, "Replace an existing file");
    add_quiet(app, args->common);
    app.bind(args, act);
}

void add_schema(Grammar& grammar) {
    Command& app = grammar.command("schema", "Print the JSON Schema of scenes, for editors");
    auto args = std::make_shared<SchemaArguments>();
    app.flag("--baselines", args->baselines, "That of the baselines of `beamcam test`");
    app.bind(args, print_schema);
}

}  // namespace beamcam::scenes
