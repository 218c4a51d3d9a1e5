// `beamcam collect`: parts of a sweep joined.
#include <fmt/format.h>

#include "output/data/file_list.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/plan/up_to_date.hpp"
#include "scenes/scene/version.hpp"
#include "scenes/sweep/parts.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

struct CollectArguments {
    Common common;
    std::vector<std::string> parts;
    std::string file;
};

void act(const CollectArguments& args) {
    require_ending("-o", args.file, {".csv", ".npz", ".nc"});
    output::FileList file_list(args.common.force);
    file_list.require_replaceable(args.file);
    CollectedSweep all = collect({args.parts.begin(), args.parts.end()});
    all.scene.set_outputs({SweepOutput{args.file}});
    output::Origin origin{inputs_key(all.scene, 0), std::string(kVersion), metadata_json(all.scene)};
    output::write_sweep(file_list.target(args.file, std::move(origin)), all.data);
    inform(args.common, fmt::format("wrote {} ({} of {})", args.file, counted(all.data.points(), "point"),
                                    counted(args.parts.size(), "part")));
}

}  // namespace

void add_collect(Program& program) {
    const auto [app, args] =
        add_command<CollectArguments>(program, "collect", "Join the parts of a sweep, made with `sweep --shard`", act);
    add_examples(app, {"collect sweep.*of8.points -o sweep.csv"});
    app.add_option("PART", args.parts, "The parts, .points files, in any order")->required();
    add_option(app, "-o,--output", args.file, "FILE", "Table to make: .csv, .npz or .nc")->required();
    add_force(app, args.common);
    add_quiet(app, args.common);
}

}  // namespace beamcam::scenes
