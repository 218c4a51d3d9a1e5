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
    bool replaced = false;  // references and digests; else they were added for another renderer
    std::string refused;    // why nothing was accepted; empty: it was
};
struct Acceptance {
    std::string baselines;  // the file
    std::vector<AcceptedEntry> entries;
};

// Where pictures are equivalent, or of a new renderer, their digests are accepted beside the others, and the pictures
// of a new renderer kept. Where they differ, or the motion does, the report's pictures and motion replace the
// references. An entry of which the report has nothing to accept is left as it is. Throws UsageError for unknown names,
// IoError for a report that is damaged, incomplete, or of other baselines; then nothing is changed.
Acceptance accept_report(const AcceptOptions& options);

}  // namespace beamcam::scenes
