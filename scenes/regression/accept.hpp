// Accepts the pictures and motions in the report of a regression test, from any machine, as references.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace beamcam::scenes {

struct AcceptOptions {
    std::filesystem::path report;  // folder that `beamcam test --report` wrote, or a folder that contains only it
    std::optional<std::string> baselines;  // absent: the file that the report names
    std::vector<std::string> entries;      // names or patterns; empty: all entries that are not identical
    bool force = false;                    // replace references that beamcam did not make, too
};

struct AcceptedEntry {
    std::string name;
    bool replaced = false;  // references and digests were replaced; else added for another renderer
    std::string rejected;   // the reason if nothing was accepted
};
struct Acceptance {
    std::string baselines;  // the file
    std::vector<AcceptedEntry> entries;
};

// Adds the digests of equivalent pictures and of pictures of a new renderer to the accepted ones, and stores the
// pictures of a new renderer. If pictures or the motion differ, those of the report replace the references. Skips
// entries for which the report contains nothing to accept. Throws UsageError for unknown names, IoError for a report
// that is damaged, incomplete, or of other baselines; then nothing changes.
Acceptance accept_report(const AcceptOptions& options);

}  // namespace beamcam::scenes
