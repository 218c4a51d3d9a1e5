#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct Arguments {
    Common common;
    std::vector<std::string> scenes;
    std::string directory = ".";
};

int act(const Arguments& args) {
    std::vector<Scene> scenes;
    for (const std::string& path : args.scenes)
        scenes.push_back(with_default_output(read_or_refuse(path, args.common)));
    print_plans(scenes, run_options(args.common, args.directory), args.common.json);
    return 0;
}

}  // namespace

void add_plan(Grammar& grammar) {
    auto args = std::make_shared<Arguments>();
    CLI::App* app = grammar.app.add_subcommand("plan", "Tell what `run` would do, and what it would skip and why");
    app->add_option("SCENE", args->scenes, "Scenes, JSON files; - is standard input")->required()->type_name("");
    add_set(*app, args->common);
    add_quiet(*app, args->common);
    app->add_option("-o,--output", args->directory, "Directory of the outputs (default: the current one)")
        ->type_name("DIR");
    app->add_flag("--force", args->common.force, "As if nothing were there yet");
    app->add_flag("--no-cache", args->common.no_cache, "As if no trajectory were kept");
    app->add_flag("--json", args->common.json, "As JSON");
    grammar.bind(app, args, act);
}

}  // namespace beamcam::scenes
