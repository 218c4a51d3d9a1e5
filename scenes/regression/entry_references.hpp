// The folder of an entry's references, where new ones go, and the entry's part of a report.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "output/data/manifest.hpp"
#include "scenes/regression/references.hpp"

namespace beamcam::scenes {

// "0012.png"; of a renderer whose picture is another one than that: "0012-0123456789ab.png".
std::string picture_name(long frame);
std::string picture_name(long frame, const std::string& renderer);
// Of a report, below its folder; `what`: "actual", "expected", "difference".
std::filesystem::path report_picture(const std::string& entry, long frame, const char* what);

class EntryReferences {
  public:
    // Throws IoError for a damaged marker.
    explicit EntryReferences(const std::filesystem::path& where)
        : folder(where), marked_(marked_files(where).value_or(ReferenceFiles{})) {}

    const ReferenceFile* marked(const std::string& name) const {
        const auto file = marked_.find(name);
        return file == marked_.end() ? nullptr : &file->second;
    }
    // Folders that were made before there were markers tell nothing.
    bool is_as_marked(const std::string& name) const;
    // Reads what may be damaged; then an update replaces it.
    void read(const std::function<void()>& work) const;

    const std::filesystem::path folder;
    std::optional<std::filesystem::path> fresh;      // of an update, which replaces all
    std::function<std::filesystem::path()> further;  // begins an update that adds; from any thread; empty: none may

  private:
    const ReferenceFiles marked_;
};

struct EntryReport {
    std::optional<std::filesystem::path> folder;  // of all entries; absent: there is no report
    output::Manifest& files;
    std::string entry;

    // A file of the entry; there must be a report.
    output::Target file(const std::string& name) const;
};

}  // namespace beamcam::scenes
