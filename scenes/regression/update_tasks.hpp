// The tasks of an update of the references, as its staging folder lists them, and how they are carried out.
#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "output/data/journal.hpp"

namespace beamcam::scenes {

// In the staging folder: the list of tasks, the new text of the baselines, and the new files by entry.
inline constexpr const char *kUpdateTasks = "tasks", *kNewBaselines = "baselines.json", *kNewFiles = "new";

// One file becomes another one: `before` and `after` are digests, empty where there is no file.
struct UpdateTask {
    std::string entry, name, before, after;
};
struct UpdateTasks {
    std::filesystem::path baselines;  // relative to the references
    std::string before, after;        // digests of the baselines
    std::vector<UpdateTask> files;
};

std::string text_of(const UpdateTasks& tasks);

// Carries out the tasks that a staging folder lists; skips those that are done already.
class TaskRunner {
  public:
    // Throws IoError.
    TaskRunner(const std::filesystem::path& references, const std::filesystem::path& staging, output::Journal& journal);

    const std::filesystem::path& baselines() const { return baselines_; }
    // Throws WouldOverwrite where a file was changed since the tasks were listed, IoError.
    void carry_out();

  private:
    [[noreturn]] void give_up(const std::filesystem::path& file) const;
    void write_baselines();
    void carry_out(const UpdateTask& task);

    const std::filesystem::path references_, staging_;
    output::Journal& journal_;
    const UpdateTasks tasks_;
    const std::filesystem::path baselines_;
};

// Empty when there is no file.
std::string digest_of(const std::filesystem::path& file);

// ---- lists of files: a line names the format, others begin with digests --------------------------------

// The lines after the first one. Their last word may contain spaces. Throws IoError.
std::vector<std::istringstream> lines_of(const std::filesystem::path& file, const char* format);
// A digest; "-" stands for none.
std::string word_of(std::istringstream& line);
std::string rest_of(std::istringstream& line);
const char* word(const std::string& digest);
bool is_file_name(const std::string& name);

}  // namespace beamcam::scenes
