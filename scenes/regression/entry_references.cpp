#include "scenes/regression/entry_references.hpp"

#include <fmt/format.h>

#include "output/files/atomic_file.hpp"
#include "output/files/sha256.hpp"

namespace beamcam::scenes {

namespace fs = std::filesystem;

std::string picture_name(long frame) { return fmt::format("{:04}.png", frame); }
std::string picture_name(long frame, const std::string& renderer) {
    return fmt::format("{:04}-{}.png", frame, renderer);
}

fs::path report_picture(const std::string& entry, long frame, const char* what) {
    return fs::path(entry) / fmt::format("{:04}-{}.png", frame, what);
}

bool EntryReferences::is_as_marked(const std::string& name) const {
    const ReferenceFile* file = marked(name);
    return marked_.empty() || (file && output::sha256_of_file(folder / name) == file->sha256);
}

void EntryReferences::read(const std::function<void()>& work) const {
    try {
        work();
    } catch (const output::IoError&) {
        if (!fresh) throw;
    }
}

output::Target EntryReport::file(const std::string& name) const {
    const fs::path path = *folder / entry / name;
    output::require_within(path, *folder);
    output::ensure_directory(path.parent_path());
    output::Target target = files.target(path);
    target.within = *folder;
    return target;
}

}  // namespace beamcam::scenes
