#include <fmt/format.h>

#include "output/files/errors.hpp"
#include "scenes/commands/cli.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/regression/provenance.hpp"

namespace beamcam::scenes {
namespace {

struct InfoArguments {
    Common common;
    std::vector<std::string> files;
    bool scene = false;
};

int act(const InfoArguments& args) {
    if (args.scene && args.files.size() != 1) throw UsageError("--scene prints one scene; name one file");
    for (const std::string& file : args.files) {
        const Provenance found = provenance_of(file);
        if (!args.scene) {
            if (args.common.json)
                print_json(to_json(found));
            else
                print_text(to_text(found));
            continue;
        }
        const std::string scene = runnable_scene(found.scene);
        if (scene.empty())
            throw output::IoError(fmt::format(
                "{} carries no scene: beamcam did not make it, or something that handled it since dropped what "
                "it said of itself",
                file));
        print_json(scene);
    }
    return kDone;
}

}  // namespace

void add_info(Grammar& grammar) {
    auto args = std::make_shared<InfoArguments>();
    Command& app = grammar.command("info", "Where a picture, film, figure or table came from");
    app.positional("FILE", &args->files, "Files that beamcam made").required();
    app.flag("--scene", args->scene, "Print the scene out of it: `beamcam run` makes the same from that");
    app.flag("--json", args->common.json, "As JSON");
    app.bind(args, act);
}

}  // namespace beamcam::scenes
