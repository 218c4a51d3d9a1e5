#include "sim/beam/modes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "output/data/records.hpp"
#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct ModesArguments {
    Common common;
    std::string scene;
    std::optional<std::string> speed;
};

int act(const ModesArguments& args) {
    const Scene scene = read_or_refuse(args.scene, args.common);
    std::optional<double> speed;
    if (args.speed) {
        const QuantityText read = parse_quantity(*args.speed);
        if (!read.quantity) throw UsageError(fmt::format("--speed {}: {}", *args.speed, read.problem));
        const bool plain = same(read.quantity->dimension, dimension::kNone);
        if (!plain && !same(read.quantity->dimension, dimension::kAngularSpeed))
            throw UsageError(fmt::format("--speed {}: it is measured in rad/s", *args.speed));
        speed = read.quantity->value;
    }
    const std::vector<sim::Mode> modes = sim::natural_modes(scene.problem, speed);
    if (args.common.json) {
        print_json(output::modes_json(modes));
        return 0;
    }
    if (modes.empty()) {
        say(args.common, "a rigid beam has no bending modes");
        return 0;
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
    return 0;
}

}  // namespace

void add_modes(Grammar& grammar) {
    auto args = std::make_shared<ModesArguments>();
    Command& app = grammar.command("modes", "Natural frequencies of beam and hub, at rest or turning");
    add_scene(app, args->scene, args->common);
    app.option(
        "--speed", &args->speed, "RAD_S",
        "The beam turns at this speed, clamped to a hub held at it, for example 300rpm; without it the hub is free");
    app.flag("--json", args->common.json, "As JSON, with mass-normalized shapes");
    app.bind(args, act);
}

}  // namespace beamcam::scenes
