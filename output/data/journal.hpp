// What a run puts into one directory, line by line, before it does: `.beamcam.XXXXXXXX.journal`. If the run is killed,
// the next one knows from it which files are beamcam's own, by their content, and which half-written ones to remove.
//
// The file is locked as long as its run lives. Where a file system has no locks, every run counts as alive, and what a
// killed one left is not removed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/data/records.hpp"

namespace beamcam::output {

// Held while the manifest and the journals of a directory are read, changed and replaced. Where a file system does not
// lock directories, two processes that end in the same instant may lose an entry, never a file.
class DirectoryLock {
  public:
    explicit DirectoryLock(const std::filesystem::path& directory);
    ~DirectoryLock();
    DirectoryLock(const DirectoryLock&) = delete;
    DirectoryLock& operator=(const DirectoryLock&) = delete;

  private:
    int descriptor_;
};

class Journal {
  public:
    // A new one. Throws IoError.
    explicit Journal(const std::filesystem::path& directory);
    // Leaves the file, whose lines then count as those of a killed run; `remove` it once the manifest has them.
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    void add(const std::string& line);  // throws IoError
    void remove();

  private:
    std::filesystem::path file_;
    int descriptor_ = -1;
};

// Those of a directory, of all runs or of those that are gone.
std::vector<std::filesystem::path> journals_in(const std::filesystem::path& directory);
bool is_abandoned(const std::filesystem::path& journal);

// Removes the half-written files that it lists.
void remove_temporaries(const std::filesystem::path& directory, const JournalLines& lines);

}  // namespace beamcam::output
