#include "scenes/regression/accept.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "output/files/atomic_file.hpp"
#include "output/files/sha256.hpp"
#include "output/image/digest.hpp"
#include "output/image/png_reader.hpp"
#include "scenes/regression/baseline_edit.hpp"
#include "scenes/regression/entry_references.hpp"
#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

class Acceptor {
  public:
    Acceptor(const AcceptOptions& options, const Report& report)
        : options_(options),
          report_(report),
          path_(options.baselines.value_or(report.baselines)),
          baselines_(read_recovered(path_)) {}

    Acceptance carry_out() {
        for (const Baseline* entry : chosen_entries(baselines_, path_, options_.entries)) {
            const auto found = report_.entries.find(entry->name);
            if (found == report_.entries.end() || !(found->second.differs || has_pictures(*entry, found->second)))
                continue;
            accepted_.push_back({entry->name, found->second.differs, refusal(*entry, found->second)});
            if (accepted_.back().refused.empty()) take(*entry, found->second);
        }
        if (!edits_.empty()) {
            const std::string text = edited(baselines_, edits_, report_.renderers);
            if (update_)
                update_->commit(baselines_.source.text, text, pixels_);
            else
                output::write_file(path_, text);
        }
        return {path_, std::move(accepted_)};
    }

  private:
    // Those of entries that are held to a file of the user's are never accepted.
    static bool has_pictures(const Baseline& entry, const ReportedEntry& found) {
        return !found.sha256.empty() && entry.expected.empty();
    }

    static std::string refusal(const Baseline& entry, const ReportedEntry& found) {
        if (!entry.problem.empty()) return entry.problem.substr(0, entry.problem.find('\n'));
        if (!has_pictures(entry, found) && found.motion_files.empty())
            return found.words.empty() ? "the report holds nothing of it" : found.words;
        return found.differs ? found.not_reproducible : "";
    }

    void take(const Baseline& entry, const ReportedEntry& found) {
        known_.clear();
        for (const auto& [name, file] : marked_files(folder_of(entry)).value_or(ReferenceFiles()))
            if (!file.pixels.empty()) known_[file.pixels] = folder_of(entry) / name;
        BaselineEdit edit{entry.name, entry.accepted, entry.reproducible_until};
        if (has_pictures(entry, found)) {
            if (found.differs) edit.accepted.clear();
            edit.accepted.push_back({found.renderer, found.sha256});
            found.differs ? replace(entry, found) : add_pictures(entry, found);
        } else {
            take_motion(entry, found, update().extend(entry.name));
        }
        if (found.reproducible_until) edit.reproducible_until = found.reproducible_until;
        pixels_[entry.name];
        edits_.push_back(std::move(edit));
    }

    ReferenceUpdate& update() {
        if (!update_) update_ = std::make_unique<ReferenceUpdate>(path_, baselines_.references, options_.force);
        return *update_;
    }

    fs::path folder_of(const Baseline& entry) const { return baselines_.references / entry.name; }

    void replace(const Baseline& entry, const ReportedEntry& found) {
        const fs::path fresh = update().begin(entry.name), old = folder_of(entry);
        for (std::size_t k = 0; k < found.sha256.size(); ++k)
            put(entry, found, k, fresh / picture_name(static_cast<long>(k)));
        for (const auto& [name, file] : marked_files(old).value_or(ReferenceFiles()))  // the motion
            if (!name.ends_with(".png") && output::path_exists(old / name))
                output::write_file(fresh / name, output::read_file(old / name));
        take_motion(entry, found, fresh);
    }

    // What is not as the first renderer draws it.
    void add_pictures(const Baseline& entry, const ReportedEntry& found) {
        if (entry.accepted.empty() || std::ranges::any_of(entry.accepted, [&](const Accepted& accepted) {
                return accepted.renderer == found.renderer;
            }))
            return;
        const std::vector<std::string>& first = entry.accepted.front().sha256;
        const auto is_kept = [&](std::size_t k) {  // of what others draw alike there may be digests alone
            return is_changed(found, k) || known_.contains(found.sha256[k]);
        };
        for (std::size_t k = 0; k < found.sha256.size(); ++k)
            if ((k >= first.size() || first[k] != found.sha256[k]) && is_kept(k))
                put(entry, found, k, update().extend(entry.name) / picture_name(static_cast<long>(k), found.renderer));
    }

    static bool is_changed(const ReportedEntry& found, std::size_t k) {
        return std::ranges::count(found.changed, static_cast<long>(k)) > 0;
    }

    // A picture from the report where it is not what was accepted before; else from among the references.
    void put(const Baseline& entry, const ReportedEntry& found, std::size_t k, const fs::path& target) {
        const auto frame = static_cast<long>(k);
        const auto known = known_.find(found.sha256[k]);
        const fs::path source = is_changed(found, k)    ? report_.folder / report_picture(entry.name, frame, "actual")
                                : known != known_.end() ? known->second
                                                        : folder_of(entry) / picture_name(frame);
        const std::string digest = output::digest(output::read_png(source));
        if (digest != found.sha256[k])
            throw output::IoError(fmt::format("{} is not the picture that was tested: it is damaged, or of another run",
                                              source.string()));
        output::write_file(target, output::read_file(source));
        pixels_[entry.name][target.filename().string()] = digest;
    }

    void take_motion(const Baseline& entry, const ReportedEntry& found, const fs::path& fresh) {
        for (const auto& [name, sha256] : found.motion_files) {
            const fs::path source = report_.folder / entry.name / name;
            if (output::sha256_of_file(source) != sha256)
                throw output::IoError(fmt::format(
                    "{} is not the motion that was tested: it is damaged, or of another run", source.string()));
            output::write_file(fresh / name, output::read_file(source));
        }
    }

    const AcceptOptions& options_;
    const Report& report_;
    const std::string path_;
    const Baselines baselines_;
    std::unique_ptr<ReferenceUpdate> update_;
    std::map<std::string, fs::path> known_;  // reference pictures of the entry by their digests
    std::vector<BaselineEdit> edits_;
    std::map<std::string, std::map<std::string, std::string>> pixels_;
    std::vector<AcceptedEntry> accepted_;
};

}  // namespace

Acceptance accept_report(const AcceptOptions& options) {
    const Report report = read_report(options.report);
    return Acceptor(options, report).carry_out();
}

}  // namespace beamcam::scenes
