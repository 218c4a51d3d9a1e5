// `beamcam check`: validation of scenes.
#include <fmt/format.h>

#include "output/files/standard_output.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {
namespace {

struct CheckArguments {
    Common common;
    std::vector<std::string> scenes;
};

void warn_of_characters(const std::string& path, const Scene& scene) {
    const Scene shown = with_default_output(scene);
    for (const Output& each : shown.outputs)
        if (const auto* picture = std::get_if<PictureOutput>(&each))
            if (const std::string lost = characters_without_font(*picture, shown); !lost.empty())
                output::print_message("{}: warning: {}\n", path, lost);
}

int act(const CheckArguments& args) {
    bool fine = true;
    for (const std::string& path : args.scenes) {
        const Reading reading = read_scene(load_source(path), args.common.overrides);
        output::print_message("{}", reading.report());
        if (!reading.scene) {
            fine = false;
            continue;
        }
        warn_of_characters(path, *reading.scene);
        inform(args.common, fmt::format("{}: fine", path));
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
