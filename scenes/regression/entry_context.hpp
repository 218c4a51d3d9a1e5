// The judges of an entry's pictures and motion share this context.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "output/data/file_list.hpp"
#include "scenes/regression/references.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// The path of a picture in the folder of a report. `kind`: "actual", "expected", "difference".
std::filesystem::path report_picture(const std::string& entry, long frame, const char* kind);

struct EntryContext {
    const Baseline& entry;
    EntryResult& result;
    const std::string renderer;  // id of what draws it
    const Tolerance& tolerance;
    const References references;
    ReferenceUpdate update;
    std::optional<std::filesystem::path> report;  // folder of the report, for pictures that are not identical
    output::FileList& report_files;
};

}  // namespace beamcam::scenes
