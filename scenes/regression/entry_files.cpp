#include "scenes/regression/entry_files.hpp"

#include <fmt/format.h>

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

EntryReferences::EntryReferences(const fs::path& all, std::string entry, ReferenceUpdate& update, Change change)
    : folder(all / entry), entry_(std::move(entry)), update_(update), change_(change), marked_(marked_files(folder)) {
    if (change_ == Change::replace) replacement_ = update_.replace(entry_);
}

fs::path EntryReferences::new_folder() const { return is_replaced() ? replacement_ : update_.extend(entry_); }

void EntryReferences::drop() {
    if (change_ != Change::none) update_.drop(entry_);
    change_ = Change::none;
}

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
        if (!is_replaced()) throw;
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
