#include <algorithm>

#include "scenes/commands/cli.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/regression/provenance.hpp"

namespace beamcam::scenes {
namespace {

int act(const Common& common) {
    const std::vector<Check> checks = examine_machine();
    if (common.json)
        print_json(to_json(checks));
    else
        print_text(to_text(checks));
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.ok; }) ? kDone : kMissingPart;
}

}  // namespace

void add_doctor(Grammar& grammar) {
    auto args = std::make_shared<Common>();
    Command& app = grammar.command(
        "doctor", "What this machine has for pictures and films, and which package brings what is missing (then 5)");
    app.flag("--json", args->json, "As JSON");
    app.bind(args, act);
}

}  // namespace beamcam::scenes
