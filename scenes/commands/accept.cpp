// `beamcam accept`: the pictures and motions in the report of a regression test, from any machine, become references.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "scenes/commands/commands.hpp"
#include "scenes/regression/acceptance.hpp"
#include "scenes/regression/baseline_edit.hpp"
#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

struct AcceptArguments {
    Common common;
    std::string report;                    // folder that `beamcam test --report` wrote, or one that contains only it
    std::optional<std::string> baselines;  // absent: the file that the report names
    std::vector<std::string> entries;      // names or patterns; empty: all entries that are not identical
};

struct AcceptedEntry {
    std::string name;
    bool replaced = false;  // references and digests were replaced; else added for another renderer
    std::string rejected;   // the reason if nothing was accepted
};

// Why the entry cannot be accepted; empty: it can.
std::string rejection(const Baseline& entry, const EntryResult& found) {
    if (!entry.problem.empty()) return entry.problem.substr(0, entry.problem.find('\n'));
    if (accepts_pictures(entry, found) || !found.motion_files.empty())
        return found.differs() ? found.not_reproducible : "";
    for (const auto& [verdict, lines] :
         {std::pair(found.motion, &found.motion_lines), {found.picture, &found.picture_lines}})
        if (verdict >= Verdict::different && !lines->empty()) return lines->back();
    return "the report contains neither its pictures nor its motion";
}

// Adds the digests of equivalent pictures and of pictures of a new renderer to the accepted ones, and stores the
// pictures of a new renderer. If pictures or the motion differ, those of the report replace the references. Skips
// entries for which the report contains nothing to accept. Throws UsageError for unknown names, IoError for a report
// that is damaged, incomplete, or of other baselines; then nothing changes.
std::vector<AcceptedEntry> accept(const AcceptArguments& args, const std::string& path, const fs::path& folder,
                                  const RegressionResult& report) {
    const Baselines baselines = read_recovered(path);
    ReferenceUpdate update(path, baselines.references, args.common.force);
    Acceptance acceptance(baselines, update, folder, false);
    std::vector<AcceptedEntry> entries;
    for (const Baseline* entry : chosen_entries(baselines, path, args.entries)) {
        const auto found = std::ranges::find(report.entries, entry->name, &EntryResult::name);
        if (found == report.entries.end() || !(found->differs() || accepts_pictures(*entry, *found))) continue;
        entries.push_back({entry->name, found->differs(), rejection(*entry, *found)});
        if (entries.back().rejected.empty()) acceptance.accept(*entry, *found, found->differs());
    }
    acceptance.commit(report.renderers);
    return entries;
}

int act(const AcceptArguments& args) {
    const fs::path folder = folder_of_report(args.report);
    const RegressionResult report = read_report(folder);
    const std::string path = args.baselines.value_or(report.baselines);
    bool changed = false, complete = true;
    for (const AcceptedEntry& entry : accept(args, path, folder, report)) {
        const bool accepted = entry.rejected.empty();
        (accepted ? changed : complete) = accepted;
        print_text(fmt::format("{:<8}  {}{}\n",
                               !accepted        ? "rejected"
                               : entry.replaced ? "replaced"
                                                : "added",
                               entry.name, accepted ? "" : ": " + entry.rejected));
    }
    inform(args.common, changed ? fmt::format("{} was changed; check it before you keep it", path)
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
    app.positional("NAME", &args.entries, "Only these entries; patterns such as 'fall-*' are allowed (default: all)");
    app.option("--baselines", &args.baselines, "FILE",
               "File of baselines to change (default: the file that the report names)");
    add_force(app, args.common);
    add_quiet(app, args.common);
}

}  // namespace beamcam::scenes
