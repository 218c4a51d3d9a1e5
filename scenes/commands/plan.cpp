#include "scenes/commands/commands.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/sweep/sweep_plan.hpp"

namespace beamcam::scenes {
namespace {

struct PlanArguments {
    Common common;
    std::vector<std::string> scenes;
    std::string directory = ".";
};

int act(const PlanArguments& args) {
    std::vector<Scene> scenes;
    for (const std::string& path : args.scenes)
        scenes.push_back(with_default_output(read_or_refuse(path, args.common)));
    const RunOptions options = run_options(args.common, args.directory);
    print_plans(scenes, options, args.common.json);
    for (const Scene& scene : scenes)
        if (scene.sweep && !args.common.json)
            print_text("\n" + sweep_plan(SweepGrid(scene), {}, thread_count(options.threads), false));
    return 0;
}

}  // namespace

void add_plan(Grammar& grammar) {
    auto args = std::make_shared<PlanArguments>();
    Command& app = grammar.command("plan", "Tell what `run` would do, and what it would skip and why");
    app.positional("SCENE", &args->scenes, "Scenes, JSON files; - is standard input").required();
    add_set(app, args->common);
    add_quiet(app, args->common);
    app.option("-o,--output", &args->directory, "DIR", "Directory of the outputs (default: the current one)");
    app.flag("--force", args->common.force, "As if nothing were there yet");
    app.flag("--no-cache", args->common.no_cache, "As if no trajectory were kept");
    app.flag("--json", args->common.json, "As JSON");
    app.bind(args, act);
}

}  // namespace beamcam::scenes
