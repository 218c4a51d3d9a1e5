// The files of one entry during a test: its accepted references, and the pictures and motions of the test; and what
// else belongs to the entry.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "output/data/manifest.hpp"
#include "scenes/regression/references.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// "0012.png"; of a renderer that draws another picture than the first one: "0012-0123456789ab.png".
std::string picture_name(long frame, const std::string& renderer = {});
// In the folder of a report. `kind`: "actual", "expected", "difference".
std::filesystem::path report_picture(const std::string& entry, long frame, const char* kind);

class EntryReferences {
  public:
    // `replaced`: the test replaces them. Throws IoError for a damaged marker.
    EntryReferences(std::filesystem::path entry_folder, bool replaced);

    // The entry of a file in the marker; null: it is not listed.
    const ReferenceFile* marked(const std::string& name) const;
    // Whether the file is as the marker says; true if the folder has no marker.
    bool is_as_marked(const std::string& name) const;
    // Runs `work`, which reads files that may be damaged. If these are to be replaced, the damage is no error.
    void read(const std::function<void()>& work) const;

    const std::filesystem::path folder;
    const bool are_replaced;

  private:
    const ReferenceFiles marked_;
};

// Pictures and motions of the test: those that differ, for a report or to be accepted.
struct TestedFiles {
    std::optional<std::filesystem::path> folder;  // of all entries; absent: none are written
    output::Manifest* report;                     // null: the folder is no report
    std::string entry;
    bool all;  // also those that do not differ

    // A file of the entry; there must be a folder.
    output::Target file(const std::string& name) const;
};

// What the judges of an entry's pictures and motion share.
struct EntryContext {
    const Baseline& entry;
    EntryResult& result;
    const std::string renderer;  // id of what draws it
    const Tolerance tolerance;
    EntryReferences references;
    const TestedFiles tested;
};

}  // namespace beamcam::scenes
