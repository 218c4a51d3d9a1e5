#include "scenes/regression/references.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "output/files/atomic_file.hpp"
#include "output/json/tree.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

bool is_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_picture(std::string_view name) {
    return name.size() >= 8 && name.ends_with(".png") && is_digits(name.substr(0, name.size() - 4));
}

// "motion.csv" and "motion-12.csv" for "motion" and ".csv".
bool is_of_series(std::string_view name, std::string_view begin, std::string_view end) {
    if (!name.starts_with(begin) || !name.ends_with(end) || name.size() < begin.size() + end.size()) return false;
    name = name.substr(begin.size(), name.size() - begin.size() - end.size());
    return name.empty() || (name.starts_with('-') && is_digits(name.substr(1)));
}

bool is_reference_name(std::string_view name) {
    return is_picture(name) || is_of_series(name, "motion", ".csv") || is_of_series(name, "impacts", ".json") ||
           name == "sweep.csv" || name == kDigestsFile;
}

// The references in a folder, without links and folders of such names.
std::vector<std::string> references_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code failed;  // no folder, no references
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        if (std::error_code gone; fs::is_regular_file(at->symlink_status(gone)))
            if (std::string name = at->path().filename().string(); is_reference_name(name))
                names.push_back(std::move(name));
    std::ranges::sort(names);
    return names;
}

}  // namespace

void refuse_reference(const fs::path& file, const char* why) {
    throw output::IoError(
        fmt::format("cannot read {}: {}; restore it, or replace it with --update", file.string(), why));
}

std::string picture_name(long frame) { return fmt::format("{:04}.png", frame); }

References::References(const fs::path& folder, const std::string& entry, bool is_updated)
    : folder_(folder / entry), is_updated_(is_updated) {}

bool References::has(const std::string& name) const { return output::path_exists(file(name)); }

std::size_t References::pictures() const {
    return static_cast<std::size_t>(std::ranges::count_if(references_in(folder_), is_picture));
}

Digests References::digests() const {
    Digests all;
    if (!has(kDigestsFile)) return all;
    const Parsed parsed = parse(output::read_file(file(kDigestsFile)));
    if (parsed.root.kind != Node::Kind::object || !parsed.messages.empty()) {
        if (is_updated_) return all;
        refuse_reference(file(kDigestsFile), "it is not an object of digests by renderer, or it is damaged");
    }
    for (const Member& renderer : parsed.root.members)
        for (const Node& digest : renderer.value.items) all[renderer.key].push_back(digest.text);
    return all;
}

void ReferenceUpdate::put(const std::string& name, std::string content) {
    keep(name);
    changed_[name] = std::move(content);
}

void ReferenceUpdate::put_digests(const Digests& digests) {
    put(kDigestsFile, digests.empty() ? "{}\n" : to_text(Node(digests)));
}

void ReferenceUpdate::only_digests() {
    std::erase_if(changed_, [](const auto& file) { return file.first != kDigestsFile; });
}

ReferenceUpdate::Changes ReferenceUpdate::carry_out(const References& references, const fs::path& root,
                                                    bool force) const {
    const std::vector<std::string> existing = references_in(references.folder());
    const bool is_own = std::ranges::find(existing, kDigestsFile) != existing.end();
    Changes changes;
    for (const auto& [name, content] : changed_) changes.written.push_back(name);
    if (is_own)
        std::ranges::copy_if(existing, std::back_inserter(changes.removed),
                             [this](const std::string& name) { return !names_.contains(name); });
    output::require_within(references.file(kDigestsFile), root);
    if (is_own) output::remove_abandoned_parts(references.folder());
    if (changes.empty()) return changes;
    if (!is_own && !existing.empty() && !force)
        throw output::WouldOverwrite(
            fmt::format("{} exists, and its folder has no {}, as folders of references have; move it, choose another "
                        "name of the entry or of \"references\", or replace it with --force",
                        references.file(existing.front()).string(), kDigestsFile));
    output::ensure_directory(references.folder());
    // The digests come first: they make the folder one of references, also if this run is killed.
    std::stable_partition(changes.written.begin(), changes.written.end(),
                          [](const std::string& name) { return name == kDigestsFile; });
    for (const std::string& name : changes.written) {
        output::FileTarget target(references.file(name));
        target.within = root;
        output::write_file(target, changed_.at(name));
    }
    for (const std::string& name : changes.removed) fs::remove(references.file(name));
    return changes;
}

}  // namespace beamcam::scenes
