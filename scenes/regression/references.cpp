#include "scenes/regression/references.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

constexpr const char *kMarker = ".beamcam-reference", *kMarkerFormat = "beamcam reference 1";
constexpr const char *kStaging = ".beamcam-update", *kTested = "tested";

[[noreturn]] void fail(const fs::path& file, const char* why) {
    throw output::WouldOverwrite(fmt::format("{} {}; move it, or replace it with --force", file.string(), why));
}

std::string marker_text(const ReferenceFiles& files) {
    std::string text = fmt::format("{}\n", kMarkerFormat);
    for (const auto& [name, file] : files) text += fmt::format("{} {} {}\n", file.sha256, word(file.pixels), name);
    return text;
}

std::vector<std::string> files_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& file : fs::directory_iterator(folder))
        names.push_back(file.path().filename().string());
    std::ranges::sort(names);
    return names;
}

// beamcam's staging folder contains a journal, or is empty if the run was killed between two system calls.
bool is_own_staging(const fs::path& staging) { return !output::journals_in(staging).empty() || fs::is_empty(staging); }

// Removes the journals last: they mark the folder as beamcam's own until it is empty.
void remove_staging(const fs::path& staging, std::error_code& error) {
    const std::vector<fs::path> journals = output::journals_in(staging);
    std::vector<fs::path> others;
    for (fs::directory_iterator at(staging, error), end; !error && at != end; at.increment(error))
        if (std::ranges::find(journals, at->path()) == journals.end()) others.push_back(at->path());
    for (auto other = others.begin(); !error && other != others.end(); ++other) fs::remove_all(*other, error);
    if (!error) fs::remove_all(staging, error);
}

void remove_staging(const fs::path& staging) {
    std::error_code error;
    remove_staging(staging, error);
    if (error) throw output::write_error(staging, error.value());
}

}  // namespace

ReferenceFiles marked_files(const fs::path& folder) {
    ReferenceFiles files;
    if (!output::path_exists(folder / kMarker)) return files;
    for (std::istringstream& line : lines_of(folder / kMarker, kMarkerFormat)) {
        const ReferenceFile file{word_of(line), word_of(line)};
        if (const std::string name = rest_of(line); is_file_name(name)) files[name] = file;
    }
    return files;
}

std::string ReferenceUpdate::recover(const fs::path& references) {
    const fs::path staging = references / kStaging;
    if (!output::path_exists(staging)) return {};
    const output::Descriptor lock = output::locked_directory(references);
    if (!output::path_exists(staging)) return {};
    if (!is_own_staging(staging))
        throw output::WouldOverwrite(
            fmt::format("{} was not made by beamcam; move it, updates need this name", staging.string()));
    const std::vector<fs::path> journals = output::journals_in(staging);
    if (!std::ranges::all_of(journals, output::is_abandoned)) return {};  // in progress
    const bool listed = output::path_exists(staging / kUpdateTasks);
    if (listed) {
        output::Journal own(staging);
        TaskRunner runner(references, staging, own);
        for (const fs::path& journal : journals)
            output::remove_temporaries(runner.baselines().parent_path(),
                                       output::parse_journal(output::read_file(journal)));
        runner.carry_out();
    }
    remove_staging(staging);
    return listed ? "completed an update of the references that was interrupted"
                  : "removed an update of the references that was interrupted";
}

ReferenceUpdate::ReferenceUpdate(fs::path baselines, fs::path references, bool force)
    : baselines_(std::move(baselines)),
      references_(std::move(references)),
      staging_(references_ / kStaging),
      force_(force) {}

ReferenceUpdate::~ReferenceUpdate() {
    if (!journal_) return;
    // Tasks that are listed must be completed: by the next run if this one could not.
    std::error_code ignored;
    if (!fs::exists(staging_ / kUpdateTasks, ignored)) remove_staging(staging_, ignored);
}

void ReferenceUpdate::begin() {
    if (journal_) return;
    output::ensure_directory(references_);
    const output::Descriptor lock = output::locked_directory(references_);
    if (output::path_exists(staging_) && !fs::is_empty(staging_))
        throw output::IoError(fmt::format("another update of {} is in progress", references_.string()));
    output::ensure_directory(staging_);
    journal_ = std::make_unique<output::Journal>(staging_);
}

fs::path ReferenceUpdate::staged(const std::string& entry) const { return staging_ / kNewFiles / entry; }

fs::path ReferenceUpdate::replace(const std::string& entry) { return open(entry, false); }
fs::path ReferenceUpdate::extend(const std::string& entry) { return open(entry, true); }

fs::path ReferenceUpdate::tested() const { return staging_ / kTested; }

void ReferenceUpdate::require_replaceable(const std::string& entry) const {
    const fs::path folder = folder_of(entry);
    std::error_code error;
    if (fs::is_symlink(folder, error)) fail(folder, "is a symbolic link");
    if (!output::path_exists(folder)) return;
    if (!fs::is_directory(folder)) fail(folder, "is not a directory");
    if (force_) return;
    if (!output::path_exists(folder / kMarker) && !fs::is_empty(folder))
        fail(folder, "is not a folder of references that beamcam made");
    for (const auto& [name, file] : marked_files(folder))
        if (const std::string now = digest_of(folder / name); !now.empty() && now != file.sha256)
            fail(folder / name, "was changed after beamcam made it");
}

fs::path ReferenceUpdate::open(const std::string& entry, bool keeps_others) {
    begin();
    require_replaceable(entry);
    output::ensure_directory(staged(entry));
    entries_[entry] = keeps_others;
    return staged(entry);
}

bool ReferenceUpdate::commit(const std::string& expected, const std::string& text,
                             const std::map<std::string, std::map<std::string, std::string>>& pixels) {
    UpdateTasks tasks{fs::relative(baselines_, references_), output::sha256(expected), output::sha256(text), {}};
    for (const auto& [entry, keeps_others] : entries_) add_tasks(entry, keeps_others, pixels.at(entry), tasks.files);
    if (output::read_file(baselines_) != expected) fail(baselines_, "was changed during the update");
    std::erase_if(tasks.files, [](const UpdateTask& task) { return task.before == task.after; });
    if (text == expected && tasks.files.empty()) return false;
    if (!journal_) return output::write_file(baselines_, text), true;  // no reference changes
    output::write_file(staging_ / kNewBaselines, text);
    output::write_file(staging_ / kUpdateTasks, text_of(tasks));
    TaskRunner(references_, staging_, *journal_).carry_out();
    remove_staging(staging_);
    return true;
}

void ReferenceUpdate::add_tasks(const std::string& entry, bool keeps_others,
                                const std::map<std::string, std::string>& pixels,
                                std::vector<UpdateTask>& tasks) const {
    const fs::path folder = folder_of(entry), fresh_folder = staged(entry);
    const ReferenceFiles old = marked_files(folder);
    ReferenceFiles fresh;
    for (const std::string& name : files_in(fresh_folder)) {
        const auto picture = pixels.find(name);
        fresh[name] = {output::sha256_of_file(fresh_folder / name),
                       picture == pixels.end() ? std::string() : picture->second};
        const std::string now = digest_of(folder / name);
        if (!now.empty() && !force_ && !old.contains(name)) fail(folder / name, "was not made by beamcam");
        tasks.push_back({entry, name, now, fresh[name].sha256});
    }
    for (const auto& [name, file] : old) {
        if (fresh.contains(name)) continue;
        if (keeps_others)
            fresh[name] = file;
        else
            tasks.push_back({entry, name, file.sha256, ""});
    }
    const std::string marker = marker_text(fresh);
    output::write_file(fresh_folder / kMarker, marker);
    tasks.push_back({entry, kMarker, digest_of(folder / kMarker), output::sha256(marker)});
}

}  // namespace beamcam::scenes
