// `beamcam check`: validation of scenes.
#include <fmt/format.h>

#include "output/files/standard_output.hpp"
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
            inform(args.common, fmt::format("{}: fine", path));
        else
            fine = false;
    }
    return fine ? kDone : kBadScene;
}

}  // namespace

void add_check(Grammar& grammar) {
    const auto [app, args] = grammar.command<CheckArguments>(
        "check", "Validate scenes: print all errors and warnings with line, column and remedy", act);
    app.examples = {"check fall.json"};
    add_scenes(app, args.scenes, args.common);
}

}  // namespace beamcam::scenes
