// `beamcam plan`: a dry run.
#include "scenes/commands/commands.hpp"
#include "scenes/sweep/sweep_plan.hpp"

namespace beamcam::scenes {
namespace {

struct PlanArguments {
    Common common;
    std::vector<std::string> scenes;
    std::string directory = ".";
};

int act(const PlanArguments& args) {
    const auto [scenes, code] = load_scenes(args.scenes, args.common);
    if (scenes.empty()) return code;
    const RunOptions options = run_options(args.common, args.directory);
    print_plans(scenes, options, args.common.json);
    for (const Scene& scene : scenes)
        if (scene.sweep && !args.common.json) print_text("\n" + sweep_plan(SweepGrid(scene), {}, false));
    return code;
}

}  // namespace

void add_plan(Grammar& grammar) {
    const auto [app, args] =
        grammar.command<PlanArguments>("plan", "Print what `run` would do, what it would skip, and why", act);
    app.examples = {"plan fall.json", "plan fall.json --force"};
    add_scenes(app, args.scenes, args.common);
    app.option("-o,--output", &args.directory, "DIR", "Directory for the outputs (default: the current one)");
    app.flag("--force", args.common.force, "Plan as if no output existed");
    add_json(app, args.common);
}

}  // namespace beamcam::scenes
