#include "output/data/file_list.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "output/files/atomic_file.hpp"
#include "output/files/descriptor.hpp"
#include "output/files/digest.hpp"
#include "output/files/numbers.hpp"
#include "output/files/owner.hpp"
#include "output/json/tree.hpp"

namespace beamcam::output {

namespace fs = std::filesystem;

namespace {

fs::path directory_of(const fs::path& file) { return fs::absolute(file).lexically_normal().parent_path(); }

struct FileIdentity {
    std::uintmax_t size = 0;
    std::string stamp;  // inode and time of modification: change when the file is replaced or written
};

// Throws IoError if the file does not exist.
FileIdentity identity_of(const fs::path& file) {
    struct stat status;
    if (stat(file.c_str(), &status) != 0) throw read_error(file, errno);
    const std::int64_t modified = status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec;
    return {static_cast<std::uintmax_t>(status.st_size),
            std::to_string(status.st_ino) + ":" + std::to_string(modified)};
}

// The version that the file has; null: none of them.
const FileRecord* present_version(const fs::path& file, const std::vector<FileRecord>& versions) {
    const FileIdentity identity = identity_of(file);
    std::string digest;
    for (auto record = versions.rbegin(); record != versions.rend(); ++record) {
        if (record->size != identity.size) continue;
        if (!record->stamp.empty() && record->stamp == identity.stamp) return &*record;
        if (digest.empty()) digest = sha256_of_file(file);
        if (record->sha256 == digest) return &*record;
    }
    return nullptr;
}

bool is_file(const fs::path& file) {
    std::error_code unreadable;
    return fs::is_regular_file(file, unreadable);
}

// A link, whose target may be anywhere, is no list.
bool is_list(const struct stat& status) { return S_ISREG(status.st_mode) && status.st_nlink == 1; }
bool is_list(const fs::path& list) {
    struct stat status;
    return lstat(list.c_str(), &status) == 0 && is_list(status);
}

// The text of a key; nothing if the node has no such text.
std::optional<std::string> text_at(const Node& node, const char* key) {
    const Member* member = node.find(key);
    return member && member->value.kind == Node::Kind::string ? std::optional(member->value.text) : std::nullopt;
}

// A name that leads to no other directory.
bool is_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos &&
           name.find('\0') == std::string::npos;
}

std::optional<FileRecord> record_of(const std::string& line) {
    const Node root = parse(line).root;
    const Member* size = root.find("size");
    const auto bytes = size ? number_in<std::uintmax_t>(size->value.text) : std::nullopt;
    const auto name = text_at(root, "name"), digest = text_at(root, "sha256");
    if (!name || !is_name(*name) || !digest || !bytes) return {};
    const auto text = [&](const char* key) { return text_at(root, key).value_or(""); };
    return FileRecord{*name,        *digest,       *bytes,
                      text("mark"), text("stamp"), Origin{text("inputs"), text("version"), text("scene")}};
}

// Another user's list becomes this user's, if the folder allows it.
void take_over(const fs::path& list) {
    try {
        write_file(list, read_file(list));
    } catch (const IoError&) {
    }
}

// The list, open and locked; not open if another user's cannot be written. A process that rewrites it replaces the
// file, so the lock of the old one is given up.
Descriptor locked_list(const fs::path& list) {
    for (;;) {
        struct stat own = {}, present = {};
        if (lstat(list.c_str(), &present) == 0 && !is_list(present))
            throw IoError(fmt::format("cannot write {}: it is no plain file; remove it", list.string()));
        Descriptor opened(list, O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK);
        if (!opened && errno == EACCES && is_list(list)) {
            take_over(list);
            opened = Descriptor(list, O_RDWR | O_APPEND | O_NOFOLLOW | O_NONBLOCK);
            if (!opened && errno == EACCES) return opened;
        }
        if (!opened || fstat(opened.number(), &own) != 0) throw write_error(list, errno);
        if (!is_list(own)) continue;  // it was replaced just now
        opened.lock();  // some file systems have no locks; then two processes may lose a line, but never a file
        if (lstat(list.c_str(), &present) == 0 && present.st_ino == own.st_ino && present.st_dev == own.st_dev)
            return opened;
    }
}

void append(const fs::path& directory, const FileRecord& record) {
    const fs::path list = directory / FileList::kFileName;
    Descriptor opened = locked_list(list);
    if (!opened) return;
    char last = '\n';  // a killed run may leave half of a line
    if (opened.size() > 0) opened.read_at(opened.size() - 1, &last, 1);
    if (!opened.write((last == '\n' ? "" : "\n") + line_of(record))) throw write_error(list, errno);
}

}  // namespace

bool FileRecord::is_own() const { return !mark.empty() && mark == owner_mark(name, sha256); }

std::string line_of(const FileRecord& record) {
    Node line = object_node({{"name", record.name}, {"sha256", record.sha256}, {"size", record.size}});
    for (const auto& [key, text] :
         {std::pair{"mark", &record.mark}, std::pair{"stamp", &record.stamp},
          std::pair{"inputs", &record.origin.inputs}, std::pair{"version", &record.origin.version},
          std::pair{"scene", &record.origin.scene}})
        if (!text->empty()) add(line, key, *text);
    return one_line(line) + "\n";
}

std::vector<FileRecord> parse_file_list(const std::string& text) {
    std::vector<FileRecord> all;
    for (const std::string& line : split(text, '\n'))
        if (auto record = record_of(line)) all.push_back(std::move(*record));
    return all;
}

// ---- reading -------------------------------------------------------------------------------------

FileList::Versions FileList::load(const fs::path& directory) {
    Versions all;
    if (!is_list(directory / kFileName)) return all;
    for (FileRecord& record : parse_file_list(read_file(directory / kFileName)))
        all[record.name].push_back(std::move(record));
    return all;
}

const FileRecord* FileList::known(const fs::path& file) {
    const fs::path directory = directory_of(file);
    if (!known_in_.contains(directory)) known_in_[directory] = load(directory);
    const auto versions = known_in_[directory].find(file.filename().string());
    const FileRecord* made = versions == known_in_[directory].end() ? nullptr : present_version(file, versions->second);
    return made && made->is_own() ? made : nullptr;
}

void FileList::require_replaceable(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    if (recovered_.insert(directory_of(file)).second) recover(directory_of(file));
    require_own(file);
    const AtomicFile trial(file);  // created and removed: fails here where it cannot be written
}

void FileList::require_own(const fs::path& file) {
    if (force_ || !path_exists(file) || !is_file(file)) return;  // AtomicFile rejects other things than files
    if (known(file)) return;
    known_in_.erase(directory_of(file));  // another run may have just made it
    if (known(file)) return;
    const Versions& listed = known_in_[directory_of(file)];
    const auto versions = listed.find(file.filename().string());
    const bool was_own = versions != listed.end() && std::ranges::any_of(versions->second, &FileRecord::is_own);
    const char* why =
        was_own                    ? "was changed after beamcam made it"
        : versions == listed.end() ? "exists and was not made by beamcam"
        : owner_mark("", "").empty()
            ? "may be another user's: the folder of XDG_STATE_HOME cannot keep what tells your files"
            : "exists and was not made by a run of yours: the list of files beside it came from elsewhere";
    throw WouldOverwrite(
        fmt::format("{} {}; move it, choose another name, or replace it with --force", file.string(), why));
}

bool FileList::is_up_to_date(const fs::path& file, const std::string& inputs) {
    if (inputs.empty() || !is_file(file)) return false;
    const std::lock_guard lock(mutex_);
    const FileRecord* made = known(file);
    return made != nullptr && made->origin.inputs == inputs;
}

std::optional<FileList::Entry> FileList::find(const fs::path& file) {
    const Versions listed = load(directory_of(file));
    const auto versions = listed.find(file.filename().string());
    if (versions == listed.end()) return std::nullopt;
    const FileRecord* made = present_version(file, versions->second);
    return Entry{made ? *made : versions->second.back(), made != nullptr};
}

// ---- writing -------------------------------------------------------------------------------------

FileTarget FileList::target(const fs::path& file, Origin origin) {
    FileTarget target(file);
    target.before_rename = [this, file, origin = std::move(origin)](const fs::path& temporary) {
        const FileIdentity identity = identity_of(temporary);
        const std::string name = file.filename().string(), digest = sha256_of_file(temporary);
        const FileRecord made{name, digest, identity.size, owner_mark(name, digest), identity.stamp, origin};
        const std::lock_guard lock(mutex_);
        require_own(file);  // the user may have created it in the meantime
        append(directory_of(file), made);
        known_in_[directory_of(file)][name].push_back(made);
    };
    return target;
}

std::string FileList::without_outdated_lines(const fs::path& directory) {
    std::string text;
    for (const auto& [name, versions] : load(directory)) {
        if (!is_file(directory / name)) continue;  // it was removed
        const FileRecord* made = versions.size() > 1 ? present_version(directory / name, versions) : nullptr;
        text += line_of(made ? *made : versions.back());
    }
    return text;
}

// Whether a run writes a file there: its line may be in the list before the file has its name.
static bool is_written_to(const fs::path& directory) {
    std::error_code failed;
    for (fs::directory_iterator at(directory, failed), end; !failed && at != end; at.increment(failed))
        if (is_temporary_name(at->path().filename().string())) return true;
    return false;
}

void FileList::recover(const fs::path& directory) {
    const fs::path place = directory_of(directory / kFileName), list = place / kFileName;
    remove_abandoned_parts(place);
    const auto is_outdated = [&] {
        return is_list(list) && fs::file_size(list) > 2 * without_outdated_lines(place).size();
    };
    if (!is_outdated()) return;
    const Descriptor lock = locked_list(list);
    if (lock && !is_written_to(place) && is_outdated()) write_file(list, without_outdated_lines(place));
}

}  // namespace beamcam::output
