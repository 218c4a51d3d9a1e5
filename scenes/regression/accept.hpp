// Takes what a regression test drew and recorded, on any machine, as what is expected from now on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace beamcam::scenes {

struct AcceptOptions {
    std::filesystem::path report;          // folder that `beamcam test --report` wrote, or one that holds only that
    std::optional<std::string> baselines;  // absent: the file that the report names
    std::vector<std::string> entries;      // names or patterns; empty: all that are not identical
    bool force = false;                    // references that beamcam did not make may be replaced
};

struct AcceptedEntry {
    std::string name;
    bool replaced = false;  // references and digests; else digests were added for another renderer
};

// Where pictures are equivalent, or of a new renderer, their digests are accepted beside the others. Where they differ,
// or the motion does, the report's pictures and motion replace the references. Throws UsageError for unknown names,
// IoError for a report that is damaged, incomplete, or of other baselines; then nothing is changed.
std::vector<AcceptedEntry> accept_report(const AcceptOptions& options, std::string& baselines);

}  // namespace beamcam::scenes
