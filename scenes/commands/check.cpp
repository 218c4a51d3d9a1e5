#include <fmt/format.h>

#include "output/files/standard_output.hpp"
#include "scenes/commands/cli.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/reader.hpp"

namespace beamcam::scenes {
namespace {

struct CheckArguments {
    Common common;
    std::vector<std::string> scenes;
};

int act(const CheckArguments& args) {
    bool fine = true;
    for (const std::string& path : args.scenes) {
        const Reading reading = read_scene(load_source(path), args.common.overrides);
        output::print_message("{}", reading.report());
        if (reading.scene)
            say(args.common, fmt::format("{}: fine", path));
        else
            fine = false;
    }
    return fine ? kDone : kBadScene;
}

}  // namespace

void add_check(Grammar& grammar) {
    auto args = std::make_shared<CheckArguments>();
    Command& app = grammar.command("check", "Validate scenes: every issue at once, with its place and remedy");
    app.positional("SCENE", &args->scenes, "Scenes, JSON files; - is standard input").required();
    add_set(app, args->common);
    add_quiet(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
