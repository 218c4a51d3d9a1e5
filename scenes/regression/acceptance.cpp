#include "scenes/regression/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"
#include "output/image/png_reader.hpp"
#include "scenes/regression/baseline_edit.hpp"
#include "scenes/regression/entry_files.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Only the motion of the entry is new: its accepted pictures, also those of other renderers, stay.
bool has_new_motion_only(const Baseline& entry, const EntryResult& found) {
    return found.picture == Verdict::identical && found.motion && accepts_pictures(entry, found) &&
           !entry.accepted.empty();
}

bool is_changed(const FrameResult& frame) { return frame.verdict != Verdict::identical; }

}  // namespace

bool accepts_pictures(const Baseline& entry, const EntryResult& found) {
    return !found.frames.empty() && entry.expected.empty();
}

Acceptance::Acceptance(const Baselines& baselines, ReferenceUpdate& update, fs::path tested, bool complete)
    : baselines_(baselines), changed_(baselines), update_(update), tested_(std::move(tested)), complete_(complete) {}

void Acceptance::accept(const Baseline& entry, const EntryResult& found, bool replaces) {
    by_digest_.clear();
    for (const auto& [name, file] : marked_files(folder_of(entry)))
        if (!file.pixels.empty()) by_digest_[file.pixels] = folder_of(entry) / name;
    pixels_[entry.name];
    Baseline& changed = *std::ranges::find(changed_.entries, entry.name, &Baseline::name);
    if (found.reproducible_until) changed.reproducible_until = found.reproducible_until;
    if (has_new_motion_only(entry, found)) return copy_motion(entry, found, update_.extend(entry.name));
    replaces ? replace(entry, found) : add_pictures(entry, found);
    if (!accepts_pictures(entry, found)) return;
    if (replaces) changed.accepted.clear();
    changed.accepted.push_back({found.renderer, found.digests()});
}

bool Acceptance::commit(const std::map<std::string, RendererParts>& renderers) {
    if (pixels_.empty()) return false;
    for (const auto& [id, parts] : renderers) changed_.renderers[id] = parts;
    return update_.commit(baselines_.source.text, edited(baselines_, changed_), pixels_);
}

void Acceptance::replace(const Baseline& entry, const EntryResult& found) {
    const fs::path fresh = update_.replace(entry.name), old = folder_of(entry);
    if (accepts_pictures(entry, found))
        for (const auto& [number, frame] : found.frames)
            copy_picture(entry, number, frame, fresh / picture_name(number));
    if (!complete_)
        for (const auto& [name, file] : marked_files(old))  // the motion
            if (!name.ends_with(".png") && output::path_exists(old / name))
                output::write_file(fresh / name, output::read_file(old / name));
    copy_motion(entry, found, fresh);
}

// Stores the pictures that differ from those of the first renderer.
void Acceptance::add_pictures(const Baseline& entry, const EntryResult& found) {
    if (entry.accepted.empty() ||
        std::ranges::find(entry.accepted, found.renderer, &Accepted::renderer) != entry.accepted.end())
        return;
    for (const auto& [number, frame] : found.frames)
        // Of equal pictures of others there may be digests only.
        if (!entry.is_of_first_renderer(number, frame.sha256) &&
            (is_changed(frame) || by_digest_.contains(frame.sha256)))
            copy_picture(entry, number, frame, update_.extend(entry.name) / picture_name(number, found.renderer));
}

// From the test if it has the picture, else from the references.
void Acceptance::copy_picture(const Baseline& entry, long number, const FrameResult& frame, const fs::path& target) {
    const auto reference = by_digest_.find(frame.sha256);
    const fs::path source = is_changed(frame) || complete_  ? tested_ / report_picture(entry.name, number, "actual")
                            : reference != by_digest_.end() ? reference->second
                                                            : folder_of(entry) / picture_name(number);
    if (output::digest(output::read_png(source)) != frame.sha256)
        throw output::IoError(
            fmt::format("{} is not the picture that was tested: it is damaged or from another run", source.string()));
    output::write_file(target, output::read_file(source));
    pixels_[entry.name][target.filename().string()] = frame.sha256;
}

void Acceptance::copy_motion(const Baseline& entry, const EntryResult& found, const fs::path& target) {
    for (const auto& [name, sha256] : found.motion_files) {
        const fs::path source = tested_ / entry.name / name;
        if (output::sha256_of_file(source) != sha256)
            throw output::IoError(fmt::format("{} is not the motion that was tested: it is damaged or from another run",
                                              source.string()));
        output::write_file(target / name, output::read_file(source));
    }
}

}  // namespace beamcam::scenes
