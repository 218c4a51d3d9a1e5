// `beamcam run`: all outputs of scenes.
#include "scenes/outputs/run.hpp"

#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct RunArguments {
    Common common;
    std::vector<std::string> scenes;
    std::string directory = ".";
};

int act(const RunArguments& args) {
    const auto [scenes, code] = load_scenes(args.scenes, args.common);
    if (scenes.empty()) return code;
    run_or_plan(scenes, run_options(args.common, args.directory), args.common);
    return code;
}

}  // namespace

void add_run(Program& program) {
    const auto [app, args] = add_command<RunArguments>(
        program, "run", "Make all outputs that scenes list; of a scene without outputs, a film", act);
    add_examples(app, {"run fall.json -o out", "run *.json -n"});
    add_scenes(app, args.scenes, args.common);
    add_option(app, "-o,--output", args.directory, "DIR", "Directory for the outputs (default: the current one)");
    add_work(app, args.common);
    add_note(app, "Scenes with the same mechanics are simulated once.");
}

}  // namespace beamcam::scenes
