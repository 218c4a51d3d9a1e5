#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct Arguments {
    Common common;
    std::string scene;
};

int act(const Arguments& args) {
    show_plan(with_default_output(read_or_refuse(args.scene, args.common)), args.common.json);
    return 0;
}

}  // namespace

void add_plan(Grammar& grammar) {
    auto args = std::make_shared<Arguments>();
    CLI::App* app = grammar.app.add_subcommand("plan", "Tell what `run` would do, and what it would skip and why");
    add_scene(*app, args->scene, args->common);
    app->add_flag("--json", args->common.json, "As JSON");
    grammar.bind(app, args, act);
}

}  // namespace beamcam::scenes
