#include "scenes/regression/accept.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/files/atomic_file.hpp"
#include "output/files/sha256.hpp"
#include "output/image/digest.hpp"
#include "output/image/png_reader.hpp"
#include "scenes/regression/baselines.hpp"
#include "scenes/regression/entry_pictures.hpp"
#include "scenes/regression/motion_record.hpp"
#include "scenes/regression/references.hpp"
#include "scenes/regression/report.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
class Acceptance {
  public:
    Acceptance(const AcceptOptions& options, const Report& report, const std::string& path)
        : options_(options), report_(report), path_(path), baselines_(read_baselines(path)) {}

    std::vector<AcceptedEntry> carry_out() {
        for (const Baseline* entry : chosen_entries(baselines_, path_, options_.entries))
            if (const auto found = report_.entries.find(entry->name); found != report_.entries.end())
                take(*entry, found->second);
        if (edits_.empty()) return {};
        const std::string text = edited(baselines_, edits_, report_.renderers);
        if (update_)
            update_->commit(baselines_.source.text, text, pixels_);
        else
            output::write_file(path_, text);
        return std::move(accepted_);
    }

  private:
    void take(const Baseline& entry, const ReportedEntry& found) {
        if (!entry.problem.empty() || (found.sha256.empty() && !found.differs)) return;
        BaselineEdit edit{entry.name, entry.accepted, entry.reproducible_until};
        if (found.differs) edit.accepted.clear();
        if (!found.sha256.empty())
            edit.accepted.push_back({found.renderer, found.sha256});
        else
            edit.accepted = entry.accepted;  // its motion alone is another
        if (found.differs) replace_references(entry, found);
        edits_.push_back(std::move(edit));
        accepted_.push_back({entry.name, found.differs});
    }

    void replace_references(const Baseline& entry, const ReportedEntry& found) {
        if (!update_) update_ = std::make_unique<ReferenceUpdate>(path_, baselines_.references, options_.force);
        const fs::path fresh = update_->begin(entry.name), old = baselines_.references / entry.name,
                       reported = report_.folder / entry.name;
        if (found.changed.empty() && !output::is_there(reported / RecordNames(0).table))
            throw output::IoError(fmt::format("the report has nothing of {} to accept: {}", entry.name, found.words));
        std::map<std::string, std::string>& pixels = pixels_[entry.name];
        const std::size_t pictures = found.sha256.empty() ? count_of(entry) : found.sha256.size();
        for (std::size_t k = 0; k < pictures; ++k) {
            const auto frame = static_cast<long>(k);
            const bool changed = std::ranges::count(found.changed, frame) > 0;
            const fs::path source =
                changed ? report_.folder / report_picture(entry.name, frame, "actual") : old / picture_name(frame);
            const std::string digest = output::digest(output::read_png(source));
            if (!found.sha256.empty() && digest != found.sha256[k])
                throw output::IoError(fmt::format("{} is not the picture that was tested: {}", source.string(),
                                                  changed ? "the report is damaged" : "the references are others"));
            output::write_file(fresh / picture_name(frame), output::read_file(source));
            pixels[picture_name(frame)] = digest;
        }
        for (std::size_t motion = 0;; ++motion) {
            const RecordNames names(motion);
            const fs::path& source = output::is_there(reported / names.table) ? reported : old;
            if (!output::is_there(source / names.table)) break;
            for (const std::string& name : {names.table, names.impacts})
                output::write_file(fresh / name, output::read_file(source / name));
        }
    }

    static std::size_t count_of(const Baseline& entry) {
        return entry.accepted.empty() ? 0 : entry.accepted.front().sha256.size();
    }

    const AcceptOptions& options_;
    const Report& report_;
    const std::string path_;
    const Baselines baselines_;
    std::unique_ptr<ReferenceUpdate> update_;
    std::vector<BaselineEdit> edits_;
    std::map<std::string, std::map<std::string, std::string>> pixels_;
    std::vector<AcceptedEntry> accepted_;
};

}  // namespace

std::vector<AcceptedEntry> accept_report(const AcceptOptions& options, std::string& baselines) {
    const Report report = read_report(options.report);
    baselines = options.baselines.value_or(report.baselines);
    return Acceptance(options, report, baselines).carry_out();
}

}  // namespace beamcam::scenes
