// `beamcam plan`: a dry run.
#include "scenes/commands/commands.hpp"

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
    print_plans(scenes, run_options(args.common, args.directory), args.common.json);
    return code;
}

}  // namespace

void add_plan(Program& program) {
    const auto [app, args] =
        add_command<PlanArguments>(program, "plan", "List the motions and files of a run, and what it would keep", act);
    add_examples(app, {"plan fall.json", "plan fall.json --force"});
    add_scenes(app, args.scenes, args.common);
    add_option(app, "-o,--output", args.directory, "DIR", "Directory for the outputs (default: the current one)");
    app.add_flag("--force", args.common.force, "Plan as if no output existed");
    add_json(app, args.common);
}

}  // namespace beamcam::scenes
