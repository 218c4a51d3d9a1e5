#include "output/data/manifest.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"

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
        if (record->sha256.empty() || record->size != identity.size) continue;
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

// Empty if there is no manifest.
std::string manifest_text(const fs::path& directory) {
    const fs::path manifest = directory / Manifest::kFileName;
    return path_exists(manifest) && is_file(manifest) ? read_file(manifest) : std::string();
}

FileRecords read_manifest(const fs::path& directory) {
    return parse_manifest(manifest_text(directory)).value_or(FileRecords{});
}

}  // namespace

Manifest::~Manifest() {
    try {
        save();
    } catch (const std::exception&) {  // the outputs themselves are whole, and the journal lists them
    }
}

// ---- reading -------------------------------------------------------------------------------------

Manifest::Versions Manifest::load(const fs::path& directory) {
    Versions all;
    for (auto& [name, made] : read_manifest(directory)) all[name].push_back(made);
    for (const fs::path& journal : journals_in(directory)) {
        std::string text;
        try {
            text = read_file(journal);
        } catch (const IoError&) {  // its run has just ended
            continue;
        }
        for (auto& [name, made] : parse_journal(text).placed) all[name].push_back(made);
    }
    return all;
}

Manifest::Versions& Manifest::known_in(const fs::path& directory) {
    std::optional<Versions>& known = directories_[directory].known;
    if (!known) known = load(directory);
    return *known;
}

const FileRecord* Manifest::known(const fs::path& file) {
    const Versions& all = known_in(directory_of(file));
    const auto versions = all.find(file.filename().string());
    return versions == all.end() ? nullptr : present_version(file, versions->second);
}

void Manifest::require_replaceable(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    require_own(file);
}

void Manifest::require_own(const fs::path& file) {
    if (force_ || !path_exists(file) || !is_file(file)) return;  // AtomicFile rejects other things than files
    if (known(file)) return;
    Directory& directory = directories_[directory_of(file)];
    directory.known = load(directory_of(file));  // another run may have just made it
    if (known(file)) return;
    if (const std::string why = damage(file); !why.empty())
        throw WouldOverwrite(
            fmt::format("{} exists, and {}; restore it, or replace the file with --force", file.string(), why));
    throw WouldOverwrite(
        file.string() +
        (directory.known->contains(file.filename().string()) ? " was changed after beamcam made it"
                                                             : " exists and was not made by beamcam") +
        (path_exists(directory_of(file) / kDamagedName)
             ? std::string(" (as far as known: a damaged list of files is kept as ") + kDamagedName + ")"
             : "") +
        "; move it, choose another name, or replace it with --force");
}

bool Manifest::is_up_to_date(const fs::path& file, const std::string& inputs) {
    if (inputs.empty() || !is_file(file)) return false;
    const std::lock_guard lock(mutex_);
    const FileRecord* made = known(file);
    return made != nullptr && made->origin.inputs == inputs;
}

std::string Manifest::damage(const fs::path& file) {
    const std::string text = manifest_text(directory_of(file)), why = text.empty() ? "" : damage_of_manifest(text);
    if (why.empty()) return {};
    return fmt::format("{}, the list of the files that beamcam made, is damaged ({})",
                       (file.parent_path() / kFileName).string(), why);
}

std::optional<Manifest::Entry> Manifest::find(const fs::path& file) {
    const Versions known = load(directory_of(file));
    const auto versions = known.find(file.filename().string());
    if (versions == known.end()) return std::nullopt;
    const FileRecord* made = present_version(file, versions->second);
    return Entry{made ? *made : versions->second.back(), made != nullptr};
}

// ---- writing -------------------------------------------------------------------------------------

Journal& Manifest::journal_in(const fs::path& directory) {
    std::unique_ptr<Journal>& journal = directories_[directory].journal;
    if (!journal) journal = std::make_unique<Journal>(directory);
    return *journal;
}

Target Manifest::target(const fs::path& file, Origin origin) {
    Target target(file);
    target.before_creation = [this](const fs::path& temporary) {
        const std::lock_guard lock(mutex_);
        journal_in(directory_of(temporary)).add(journal_line(temporary.filename().string()));
    };
    target.before_rename = [this, file, origin = std::move(origin)](const fs::path& temporary) {
        const FileIdentity identity = identity_of(temporary);
        const FileRecord made{sha256_of_file(temporary), identity.size, origin, identity.stamp};
        const std::string name = file.filename().string();
        const std::lock_guard lock(mutex_);
        require_own(file);  // the user may have created it in the meantime
        journal_in(directory_of(file)).add(journal_line(name, made));
        known_in(directory_of(file))[name].push_back(made);
    };
    return target;
}

void Manifest::save() {
    const std::lock_guard lock(mutex_);
    for (auto& [directory, state] : directories_)
        if (state.journal) merge_journals(directory, state.journal);
}

void Manifest::recover(const fs::path& directory) {
    const std::lock_guard lock(mutex_);
    const fs::path place = directory_of(directory / Manifest::kFileName);
    for (const fs::path& journal : journals_in(place))
        if (is_abandoned(journal)) {
            journal_in(place);
            return merge_journals(place, directories_[place].journal);
        }
}

// Adds the records of the journals to the manifest. Removes the journals of ended runs, with their temporary files.
void Manifest::merge_journals(const fs::path& directory, std::unique_ptr<Journal>& own) {
    const Descriptor lock = locked_directory(directory);
    std::vector<fs::path> abandoned;
    for (const fs::path& journal : journals_in(directory))
        if (is_abandoned(journal)) abandoned.push_back(journal);
    FileRecords files;
    for (const auto& [name, versions] : load(directory)) {
        if (!is_file(directory / name)) continue;  // it was removed
        const FileRecord* made = versions.size() > 1 ? present_version(directory / name, versions) : nullptr;
        files[name] = made ? *made : versions.back();
    }
    if (files != read_manifest(directory)) {
        if (!damage(directory / kFileName).empty()) fs::rename(directory / kFileName, directory / kDamagedName);
        Target manifest(directory / kFileName);
        manifest.before_creation = [&](const fs::path& temporary) {
            own->add(journal_line(temporary.filename().string()));
        };
        write_file(manifest, manifest_json(files));
    }
    for (const fs::path& journal : abandoned) {
        remove_temporaries(directory, parse_journal(read_file(journal)));
        std::error_code ignored;
        fs::remove(journal, ignored);
    }
    own->remove();
    own.reset();
}

}  // namespace beamcam::output
