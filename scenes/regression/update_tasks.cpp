#include "scenes/regression/update_tasks.hpp"

#include <fmt/format.h>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUpdateFormat = "beamcam update 1";

void remove_file(const fs::path& file) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw output::write_error(file, error.value());
}

UpdateTasks read_tasks(const fs::path& list) {
    UpdateTasks tasks;
    for (std::istringstream& line : lines_of(list, kUpdateFormat)) {
        const std::string before = word_of(line), after = word_of(line);
        if (tasks.after.empty()) {
            tasks.before = before, tasks.after = after, tasks.baselines = rest_of(line);
        } else {
            const fs::path file = rest_of(line);  // entry/name
            const std::string entry = file.parent_path().string(), name = file.filename().string();
            if (is_file_name(entry) && is_file_name(name)) tasks.files.push_back({entry, name, before, after});
        }
    }
    return tasks;
}

}  // namespace

std::string digest_of(const fs::path& file) {
    return output::path_exists(file) ? output::sha256_of_file(file) : std::string();
}

std::vector<std::istringstream> lines_of(const fs::path& file, const char* format) {
    std::istringstream text(output::read_file(file));
    std::string line;
    if (!std::getline(text, line) || line != format)
        throw output::IoError(fmt::format("cannot read {}: it is damaged; restore it or remove it", file.string()));
    std::vector<std::istringstream> lines;
    while (std::getline(text, line)) lines.emplace_back(line);
    return lines;
}

std::string word_of(std::istringstream& line) {
    std::string word;
    line >> word;
    return word == "-" ? std::string() : word;
}
std::string rest_of(std::istringstream& line) {
    std::string rest;
    std::getline(line >> std::ws, rest);
    return rest;
}
const char* word(const std::string& digest) { return digest.empty() ? "-" : digest.c_str(); }

bool is_file_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

std::string text_of(const UpdateTasks& tasks) {
    std::string text =
        fmt::format("{}\n{} {} {}\n", kUpdateFormat, tasks.before, tasks.after, tasks.baselines.string());
    for (const UpdateTask& task : tasks.files)
        text += fmt::format("{} {} {}/{}\n", word(task.before), word(task.after), task.entry, task.name);
    return text;
}

TaskRunner::TaskRunner(const fs::path& references, const fs::path& staging, output::Journal& journal)
    : references_(references),
      staging_(staging),
      journal_(journal),
      tasks_(read_tasks(staging_ / kUpdateTasks)),
      baselines_((references_ / tasks_.baselines).lexically_normal()) {}

void TaskRunner::carry_out() {
    write_baselines();
    for (const UpdateTask& task : tasks_.files) carry_out(task);
}

void TaskRunner::give_up(const fs::path& file) const {
    throw output::WouldOverwrite(
        fmt::format("{} was changed after an update of the references was interrupted; restore it, or remove {} to "
                    "abandon the update",
                    file.string(), staging_.string()));
}

// Comes first: as long as the new text is in the staging folder, no reference is changed.
void TaskRunner::write_baselines() {
    const fs::path text = staging_ / kNewBaselines;
    if (!output::path_exists(text)) return;
    const std::string now = digest_of(baselines_);
    if (now != tasks_.before && now != tasks_.after) give_up(baselines_);
    if (now != tasks_.after) {
        output::Target target(baselines_);
        target.before_creation = [this](const fs::path& temporary) {
            journal_.add(output::journal_line(temporary.filename().string()));
        };
        output::write_file(target, output::read_file(text));
    }
    remove_file(text);
}

void TaskRunner::carry_out(const UpdateTask& task) {
    const fs::path folder = references_ / task.entry, file = folder / task.name,
                   source = staging_ / kNewFiles / task.entry / task.name;
    const std::string now = digest_of(file);
    if (now == task.after) return;
    if (now != task.before) {
        if (task.after.empty()) return;  // now it is the user's file
        give_up(file);
    }
    if (task.after.empty()) return remove_file(file);
    output::ensure_directory(folder);
    std::error_code error;
    fs::rename(source, file, error);
    if (error) throw output::write_error(file, error.value());
}

}  // namespace beamcam::scenes
