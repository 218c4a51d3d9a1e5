// `beamcam modes`: natural frequencies.
#include "sim/beam/modes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "output/data/records.hpp"
#include "scenes/commands/commands.hpp"
#include "sim/beam/model.hpp"

namespace beamcam::scenes {
namespace {

struct ModesArguments {
    Common common;
    std::string scene;
    std::optional<std::string> speed;
};

void act(const ModesArguments& args) {
    const Scene scene = load_scene(args.scene, args.common);
    std::optional<double> speed;
    if (args.speed) speed = signed_argument("--speed", *args.speed, dimension::kAngularSpeed);
    if (speed && !(std::fabs(*speed) <= sim::kLargestNumber))
        throw UsageError(fmt::format("--speed {}: must lie within ±{:g} rad/s", *args.speed, sim::kLargestNumber));
    const std::vector<sim::Mode> modes = sim::natural_modes(scene.problem, speed);
    std::vector<std::size_t> inaccurate = sim::unconverged_modes(modes, scene.problem, speed);
    for (std::size_t& number : inaccurate) ++number;
    if (!inaccurate.empty())
        inform(args.common,
               fmt::format(
                   "warning: not converged: mode{} {} would change by more than 1 % with more shapes; {}",
                   inaccurate.size() == 1 ? "" : "s", fmt::join(inaccurate, ", "),
                   scene.problem.beam.modes < sim::kMaxModes ? "increase beam.modes" : "no model has more shapes"));
    if (args.common.json) {
        print_json(output::modes_json(modes));
        return;
    }
    if (modes.empty()) {
        inform(args.common, "a rigid beam has no bending modes");
        return;
    }
    std::string text = fmt::format("{:>4}  {:>20}  {:>20}\n", "mode", "omega [rad/s]", "f [Hz]");
    for (std::size_t i = 0; i < modes.size(); ++i) {
        if (std::isnan(modes[i].omega))
            text += fmt::format("{:4}  {:>20}  {:>20}\n", i + 1, "diverges", "-");
        else
            text += fmt::format("{:4}  {:20.12g}  {:20.12g}\n", i + 1, modes[i].omega,
                                modes[i].omega / (2 * std::numbers::pi));
    }
    print_text(text);
}

}  // namespace

void add_modes(Program& program) {
    const auto [app, args] = add_command<ModesArguments>(
        program, "modes",
        "Print the natural frequencies of the beam on its hub, at rest or rotating, as many as beam.modes", act);
    add_examples(app, {"modes fall.json", "modes fall.json --speed 300rpm --json"});
    add_scene(app, args.scene, args.common);
    add_option(app, "--speed", args.speed, "RAD_S",
               "Clamp the beam to a hub that rotates at this speed, for example 300rpm (default: the hub of the scene, "
               "at rest)");
    app.add_flag("--json", args.common.json,
                 "Print JSON, with mass-normalized mode shapes (tip positive) and their coordinates q");
}

}  // namespace beamcam::scenes
