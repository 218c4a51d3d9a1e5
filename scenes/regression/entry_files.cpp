#include "scenes/regression/entry_files.hpp"

#include <fmt/format.h>

#include <utility>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"

namespace beamcam::scenes {

namespace fs = std::filesystem;

std::string picture_name(long frame, const std::string& renderer) {
    return fmt::format("{:04}{}{}.png", frame, renderer.empty() ? "" : "-", renderer);
}

fs::path report_picture(const std::string& entry, long frame, const char* kind) {
    return fs::path(entry) / picture_name(frame, kind);
}

EntryReferences::EntryReferences(fs::path entry_folder, bool replaced)
    : folder(std::move(entry_folder)), are_replaced(replaced), marked_(marked_files(folder)) {}

const ReferenceFile* EntryReferences::marked(const std::string& name) const {
    const auto file = marked_.find(name);
    return file == marked_.end() ? nullptr : &file->second;
}

bool EntryReferences::is_as_marked(const std::string& name) const {
    const ReferenceFile* file = marked(name);
    return marked_.empty() || (file && output::sha256_of_file(folder / name) == file->sha256);
}

void EntryReferences::read(const std::function<void()>& work) const {
    try {
        work();
    } catch (const output::IoError&) {
        if (!are_replaced) throw;
    }
}

output::Target TestedFiles::file(const std::string& name) const {
    const fs::path path = *folder / entry / name;
    output::require_within(path, *folder);
    output::ensure_directory(path.parent_path());
    output::Target target = report ? report->target(path) : output::Target(path);
    target.within = *folder;
    return target;
}

}  // namespace beamcam::scenes
