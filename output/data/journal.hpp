// The journal of a run in one directory, `.beamcam.XXXXXXXX.journal`: it lists each file before the run creates or
// replaces it. If the run is killed, the next run finds in the journal which files beamcam made and which temporary
// files to remove.
//
// The file is locked while its run exists. On file systems without locks every run counts as running, and the files of
// a killed run are not removed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/data/file_records.hpp"
#include "output/files/descriptor.hpp"

namespace beamcam::output {

// A lock for reading and changing the manifest and the journals of a directory, as long as the result exists. On file
// systems that cannot lock directories, two processes that end at the same instant may lose an entry, but never a file.
[[nodiscard]] Descriptor locked_directory(const std::filesystem::path& directory);

class Journal {
  public:
    // Creates a new journal. Throws IoError. The destructor keeps the file; its lines then count as those of a killed
    // run. Call `remove` after the manifest contains them.
    explicit Journal(const std::filesystem::path& directory);

    void add(const std::string& line);  // throws IoError
    void remove();

  private:
    std::filesystem::path path_;
    Descriptor file_;
};

// The journals of all runs in a directory, and whether the run of a journal has ended.
std::vector<std::filesystem::path> journals_in(const std::filesystem::path& directory);
bool is_abandoned(const std::filesystem::path& journal);

// Removes the temporary files that the journal lists.
void remove_temporaries(const std::filesystem::path& directory, const JournalLines& lines);

}  // namespace beamcam::output
