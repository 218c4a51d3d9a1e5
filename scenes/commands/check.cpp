// `beamcam check`: validation of scenes.
#include <fmt/format.h>

#include "scenes/commands/commands.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

struct CheckArguments {
    Common common;
    std::vector<std::string> scenes;
};

void warn_of_characters(const Common& common, const std::string& path, const Scene& scene) {
    for (const Output& each : scene.outputs)
        if (const auto* picture = std::get_if<PictureOutput>(&each))
            if (const std::string lost = characters_without_font(*picture, scene); !lost.empty())
                inform(common, fmt::format("{}: warning: {}", path, lost));
}

int act(const CheckArguments& args) {
    return for_each_file(args.scenes, [&](const std::string& file) {
        const Scene scene = load_scene_with_output(file, args.common);
        const std::string path = is_stdout(file) ? "stdin" : file;
        warn_of_characters(args.common, path, scene);
        for (const std::string& note : scene.notes) inform(args.common, fmt::format("{}: note: {}", path, note));
        inform(args.common, fmt::format("{}: fine", path));
    });
}

}  // namespace

void add_check(Program& program) {
    const auto [app, args] = add_command<CheckArguments>(
        program, "check",
        "Validate scenes: print all errors and warnings with line, column and remedy, and what is assumed", act);
    add_examples(app, {"check fall.json"});
    add_scenes(app, args.scenes, args.common);
}

}  // namespace beamcam::scenes
