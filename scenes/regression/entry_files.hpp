// The files of one entry during a test: its accepted references, their update, and its part of the report; and what
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
    // The effect of the test on the references: nothing, replace all files, or add pictures of a new renderer.
    enum class Change { none, replace, add };

    // Throws IoError for a damaged marker, WouldOverwrite where the files may not be replaced.
    EntryReferences(const std::filesystem::path& all, std::string entry, ReferenceUpdate& update, Change change);

    bool is_replaced() const { return change_ == Change::replace; }
    bool is_extended() const { return change_ == Change::add; }
    // The directory for new files. From any thread.
    std::filesystem::path new_folder() const;
    // Files that the update does not replace are kept.
    void keep_others() { update_.extend(entry_); }
    // The references stay unchanged.
    void drop();

    // The entry of a file in the marker; null: it is not listed.
    const ReferenceFile* marked(const std::string& name) const;
    // Whether the file is as the marker says; true if the folder has no marker.
    bool is_as_marked(const std::string& name) const;
    // Runs `work`, which reads files that may be damaged. If these are to be replaced, the damage is no error.
    void read(const std::function<void()>& work) const;

    const std::filesystem::path folder;

  private:
    const std::string entry_;
    ReferenceUpdate& update_;
    Change change_;
    const ReferenceFiles marked_;
    std::filesystem::path replacement_;
};

struct EntryReport {
    std::optional<std::filesystem::path> folder;  // of all entries; absent: there is no report
    output::Manifest& files;
    std::string entry;

    // A file of the entry; there must be a report.
    output::Target file(const std::string& name) const;
};

// What the judges of an entry's pictures and motion share.
struct EntryContext {
    const Baseline& entry;
    EntryResult& result;
    const std::string renderer;  // id of what draws it
    const Tolerance tolerance;
    EntryReferences references;
    const EntryReport report;
};

}  // namespace beamcam::scenes
