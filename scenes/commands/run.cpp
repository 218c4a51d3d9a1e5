#include "scenes/run.hpp"

#include "scenes/commands/commands.hpp"
#include "scenes/plan.hpp"

namespace beamcam::scenes {
namespace {

struct Arguments {
    Common common;
    std::string scene, directory = ".";
};

int act(const Arguments& args) {
    const Scene scene = with_default_output(read_or_refuse(args.scene, args.common));
    if (args.common.dry_run)
        show_plan(scene, args.common.json);
    else
        run(plan(scene), scene, run_options(args.common, args.directory));
    return 0;
}

}  // namespace

void add_run(Grammar& grammar) {
    auto args = std::make_shared<Arguments>();
    CLI::App* app =
        grammar.app.add_subcommand("run", "Make every output that the scene lists; none: a film named after the scene");
    add_scene(*app, args->scene, args->common);
    app->add_option("-o,--output", args->directory, "Directory of the outputs (default: the current one)")
        ->type_name("DIR");
    add_work(*app, args->common);
    grammar.bind(app, args, act);
}

}  // namespace beamcam::scenes
