// `beamcam accept`: the pictures and motions of a report become references.
#include "scenes/regression/accept.hpp"

#include <fmt/format.h>

#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct AcceptArguments {
    Common common;
    std::string report;
    AcceptOptions options;
};

int act(const AcceptArguments& args) {
    AcceptOptions options = args.options;
    options.report = args.report;
    options.force = args.common.force;
    const Acceptance done = accept_report(options);
    bool changed = false, complete = true;
    for (const AcceptedEntry& entry : done.entries) {
        const bool accepted = entry.rejected.empty();
        (accepted ? changed : complete) = accepted;
        print_text(fmt::format("{:<8}  {}{}\n",
                               !accepted        ? "rejected"
                               : entry.replaced ? "replaced"
                                                : "added",
                               entry.name, accepted ? "" : ": " + entry.rejected));
    }
    inform(args.common, changed ? fmt::format("{} was changed; check it before you keep it", done.baselines)
                                : "the report contains nothing to accept");
    return complete ? kDone : kDiffers;
}

}  // namespace

void add_accept(Grammar& grammar) {
    const auto [app, args] = grammar.command<AcceptArguments>(
        "accept", "Accept the pictures and motions of a test report as references", act);
    app.examples = {"accept report", "accept downloads/report 'fall-*' --baselines tests/baselines.json"};
    app.positional("REPORT", &args.report, "The folder that `beamcam test --report` wrote, here or in a CI run")
        .required();
    app.positional("NAME", &args.options.entries,
                   "Only these entries; patterns such as 'fall-*' are allowed (default: all)");
    app.option("--baselines", &args.options.baselines, "FILE",
               "File of baselines to change (default: the file that the report names)");
    add_force(app, args.common);
    add_quiet(app, args.common);
}

}  // namespace beamcam::scenes
