// `beamcam accept`: the pictures and motions in the report of a regression test, from any machine, become references.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"
#include "output/image/png_reader.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/regression/baseline_edit.hpp"
#include "scenes/regression/entry_files.hpp"
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

// Adds the digests of equivalent pictures and of pictures of a new renderer to the accepted ones, and stores the
// pictures of a new renderer. If pictures or the motion differ, those of the report replace the references. Skips
// entries for which the report contains nothing to accept. Throws UsageError for unknown names, IoError for a report
// that is damaged, incomplete, or of other baselines; then nothing changes.
class Acceptor {
  public:
    Acceptor(const AcceptArguments& args, const fs::path& folder, const RegressionResult& report)
        : args_(args),
          folder_(folder),
          report_(report),
          path_(args.baselines.value_or(report.baselines)),
          baselines_(read_recovered(path_)),
          update_(path_, baselines_.references, args.common.force) {}

    std::vector<AcceptedEntry> run() {
        for (const Baseline* entry : chosen_entries(baselines_, path_, args_.entries)) {
            const auto found = std::ranges::find(report_.entries, entry->name, &EntryResult::name);
            if (found == report_.entries.end() || !(found->differs() || has_pictures(*entry, *found))) continue;
            accepted_.push_back({entry->name, found->differs(), rejection(*entry, *found)});
            if (accepted_.back().rejected.empty()) accept(*entry, *found);
        }
        if (!edits_.empty())
            update_.commit(baselines_.source.text, edited(baselines_, edits_, report_.renderers), pixels_);
        return std::move(accepted_);
    }

    const std::string& path() const { return path_; }  // of the baselines

  private:
    // Pictures that are compared with a file of the user are never accepted.
    static bool has_pictures(const Baseline& entry, const EntryResult& found) {
        return !found.frames.empty() && entry.expected.empty();
    }

    // Why the entry cannot be accepted; empty: it can.
    static std::string rejection(const Baseline& entry, const EntryResult& found) {
        if (!entry.problem.empty()) return entry.problem.substr(0, entry.problem.find('\n'));
        if (has_pictures(entry, found) || !found.motion_files.empty())
            return found.differs() ? found.not_reproducible : "";
        for (const auto& [verdict, lines] :
             {std::pair(found.motion, &found.motion_lines), {found.picture, &found.picture_lines}})
            if (verdict >= Verdict::different && !lines->empty()) return lines->back();
        return "the report contains neither its pictures nor its motion";
    }

    void accept(const Baseline& entry, const EntryResult& found) {
        by_digest_.clear();
        for (const auto& [name, file] : marked_files(folder_of(entry)))
            if (!file.pixels.empty()) by_digest_[file.pixels] = folder_of(entry) / name;
        if (!has_pictures(entry, found) || has_new_motion_only(entry, found))
            copy_motion(entry, found, update_.extend(entry.name));
        else
            found.differs() ? replace(entry, found) : add_pictures(entry, found);
        pixels_[entry.name];
        edits_.push_back(acceptance_of(entry, found, found.differs()));
    }

    fs::path folder_of(const Baseline& entry) const { return baselines_.references / entry.name; }

    void replace(const Baseline& entry, const EntryResult& found) {
        const fs::path fresh = update_.replace(entry.name), old = folder_of(entry);
        for (const auto& [number, frame] : found.frames)
            copy_picture(entry, number, frame, fresh / picture_name(number));
        for (const auto& [name, file] : marked_files(old))  // the motion
            if (!name.ends_with(".png") && output::path_exists(old / name))
                output::write_file(fresh / name, output::read_file(old / name));
        copy_motion(entry, found, fresh);
    }

    // Stores the pictures that differ from those of the first renderer.
    void add_pictures(const Baseline& entry, const EntryResult& found) {
        if (entry.accepted.empty() || std::ranges::any_of(entry.accepted, [&](const Accepted& accepted) {
                return accepted.renderer == found.renderer;
            }))
            return;
        for (const auto& [number, frame] : found.frames)
            // Of equal pictures of others there may be digests only.
            if (!entry.is_of_first_renderer(number, frame.sha256) &&
                (is_changed(frame) || by_digest_.contains(frame.sha256)))
                copy_picture(entry, number, frame, update_.extend(entry.name) / picture_name(number, found.renderer));
    }

    static bool is_changed(const FrameResult& frame) { return frame.verdict != Verdict::identical; }

    // From the report if it is not one of the accepted pictures, else from the references.
    void copy_picture(const Baseline& entry, long number, const FrameResult& frame, const fs::path& target) {
        const auto reference = by_digest_.find(frame.sha256);
        const fs::path source = is_changed(frame)               ? folder_ / report_picture(entry.name, number, "actual")
                                : reference != by_digest_.end() ? reference->second
                                                                : folder_of(entry) / picture_name(number);
        const std::string digest = output::digest(output::read_png(source));
        if (digest != frame.sha256)
            throw output::IoError(fmt::format(
                "{} is not the picture that was tested: it is damaged or from another run", source.string()));
        output::write_file(target, output::read_file(source));
        pixels_[entry.name][target.filename().string()] = digest;
    }

    void copy_motion(const Baseline& entry, const EntryResult& found, const fs::path& fresh) {
        for (const auto& [name, sha256] : found.motion_files) {
            const fs::path source = folder_ / entry.name / name;
            if (output::sha256_of_file(source) != sha256)
                throw output::IoError(fmt::format(
                    "{} is not the motion that was tested: it is damaged or from another run", source.string()));
            output::write_file(fresh / name, output::read_file(source));
        }
    }

    const AcceptArguments& args_;
    const fs::path& folder_;
    const RegressionResult& report_;
    const std::string path_;
    const Baselines baselines_;
    ReferenceUpdate update_;
    std::map<std::string, fs::path> by_digest_;  // reference pictures of the entry
    std::vector<BaselineEdit> edits_;
    std::map<std::string, std::map<std::string, std::string>> pixels_;
    std::vector<AcceptedEntry> accepted_;
};

int act(const AcceptArguments& args) {
    const fs::path folder = folder_of_report(args.report);
    const RegressionResult report = read_report(folder);
    Acceptor acceptor(args, folder, report);
    bool changed = false, complete = true;
    for (const AcceptedEntry& entry : acceptor.run()) {
        const bool accepted = entry.rejected.empty();
        (accepted ? changed : complete) = accepted;
        print_text(fmt::format("{:<8}  {}{}\n",
                               !accepted        ? "rejected"
                               : entry.replaced ? "replaced"
                                                : "added",
                               entry.name, accepted ? "" : ": " + entry.rejected));
    }
    inform(args.common, changed ? fmt::format("{} was changed; check it before you keep it", acceptor.path())
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
