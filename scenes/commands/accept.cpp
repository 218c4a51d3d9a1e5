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
        const bool taken = entry.refused.empty();
        (taken ? changed : complete) = taken;
        print_text(fmt::format("{:<8}  {}{}\n",
                               !taken           ? "refused"
                               : entry.replaced ? "replaced"
                                                : "added",
                               entry.name, taken ? "" : ": " + entry.refused));
    }
    say(args.common, changed ? fmt::format("{} was changed; keep it if it is right", done.baselines)
                             : "nothing in the report is to be accepted");
    return complete ? kDone : kDiffers;
}

}  // namespace

void add_accept(Grammar& grammar) {
    auto args = std::make_shared<AcceptArguments>();
    Command& app =
        grammar.command("accept", "Take pictures and motions from the report of a test, once they have been looked at");
    app.positional("REPORT", &args->report, "The folder of beamcam test --report, such as one kept by a CI run")
        .required();
    app.positional("NAME", &args->options.entries, "These entries only; patterns such as 'fall-*' (default: all)");
    app.option("--baselines", &args->options.baselines, "FILE",
               "The baselines (default: the file that the report names)");
    app.flag("--force", args->common.force, "Replace references that beamcam did not make");
    add_quiet(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
