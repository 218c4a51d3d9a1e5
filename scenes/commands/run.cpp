#include "scenes/run.hpp"

#include <optional>

#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct Arguments {
    Common common;
    std::vector<std::string> scenes;
    std::string directory = ".";
    std::optional<std::string> shard;
};

int act(const Arguments& args) {
    std::vector<Scene> scenes;
    for (const std::string& path : args.scenes)
        scenes.push_back(with_default_output(read_or_refuse(path, args.common)));
    RunOptions options = run_options(args.common, args.directory);
    if (args.shard) options.ask = shard_argument(*args.shard);
    run_or_plan(scenes, options, args.common);
    return 0;
}

}  // namespace

void add_run(Grammar& grammar) {
    auto args = std::make_shared<Arguments>();
    Command& app = grammar.command(
        "run", "Make every output that the scenes list; a scene that lists none: a film named after it");
    app.positional("SCENE", &args->scenes,
                   "Scenes, JSON files; - is standard input. Those of one motion are simulated once")
        .required();
    add_set(app, args->common);
    add_quiet(app, args->common);
    app.option("-o,--output", &args->directory, "DIR", "Directory of the outputs (default: the current one)");
    add_shard(app, args->shard);
    add_work(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
