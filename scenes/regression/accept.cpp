#include "scenes/regression/accept.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/files/atomic_file.hpp"
#include "output/files/sha256.hpp"
#include "output/image/digest.hpp"
#include "output/image/png_reader.hpp"
#include "scenes/regression/baselines.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/regression/entry_pictures.hpp"
#include "scenes/regression/motion_record.hpp"
#include "scenes/regression/references.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kReport = "report.json";

// What the report says of one entry.
struct Reported {
    std::string renderer;
    std::vector<std::string> sha256;  // of all its pictures; empty: it has none, or they are identical
    std::vector<long> changed;        // their numbers
    bool differs = false;             // its pictures or its motion: digests alone will not do
    std::string words;                // why
};

struct Report {
    fs::path folder;
    std::string baselines;
    std::map<std::string, Reported> entries;  // those that are not identical
    std::map<std::string, RendererParts> renderers;
};

bool verdict_is(const Json& part, std::initializer_list<Verdict> verdicts) {
    return std::ranges::any_of(verdicts, [&](Verdict v) { return part.at("verdict") == name(v); });
}

Reported reported(const Json& entry) {
    Reported out;
    out.renderer = entry.value("renderer", "");
    out.sha256 = entry.value("sha256", std::vector<std::string>());
    for (const char* part : {"picture", "motion"})
        if (entry.contains(part) && verdict_is(entry.at(part), {Verdict::different, Verdict::missing})) {
            out.differs = true;
            for (const Json& line : entry.at(part).at("words")) out.words = line.get<std::string>();
        }
    if (entry.contains("picture"))
        for (const auto& [number, frame] : entry.at("picture").at("changed").items())
            out.changed.push_back(std::stol(number));
    return out;
}

// CI services put what they kept into a folder of its own.
fs::path folder_of_report(const fs::path& given) {
    if (output::is_there(given / kReport)) return given;
    std::vector<fs::path> found;
    if (fs::is_directory(given))
        for (const fs::directory_entry& inner : fs::directory_iterator(given))
            if (output::is_there(inner.path() / kReport)) found.push_back(inner.path());
    if (found.size() == 1) return found.front();
    throw output::IoError(
        fmt::format("{} holds no {}; name the folder that beamcam test --report wrote, unpacked if it is an archive",
                    given.string(), kReport));
}

Report read_report(const fs::path& given) {
    Report report{folder_of_report(given), {}, {}, {}};
    const fs::path file = report.folder / kReport;
    try {
        const Json json = Json::parse(output::read_file(file));
        report.baselines = json.at("baselines").get<std::string>();
        report.renderers = json.at("renderers").get<std::map<std::string, RendererParts>>();
        for (const auto& [name, entry] : json.at("entries").items())
            if (!verdict_is(entry, {Verdict::identical})) report.entries[name] = reported(entry);
    } catch (const std::exception& error) {
        throw output::IoError(fmt::format("cannot read {}: {}", file.string(), error.what()));
    }
    return report;
}

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
    void take(const Baseline& entry, const Reported& found) {
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

    void replace_references(const Baseline& entry, const Reported& found) {
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
