#include "output/manifest.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "output/atomic_file.hpp"
#include "output/sha256.hpp"

namespace beamcam::output {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kSaveEvery = 64;  // files: a killed run loses the record of no more

// Held while the manifest of a directory is read, changed and replaced. Where a file system does not lock
// directories, two processes that end in the same instant may lose an entry, never a file.
class DirectoryLock {
  public:
    explicit DirectoryLock(const fs::path& directory)
        : descriptor_(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        if (descriptor_ < 0) return;
        while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
        }
    }
    ~DirectoryLock() {
        if (descriptor_ >= 0) close(descriptor_);
    }
    DirectoryLock(const DirectoryLock&) = delete;
    DirectoryLock& operator=(const DirectoryLock&) = delete;

  private:
    int descriptor_;
};

fs::path directory_of(const fs::path& file) { return fs::absolute(file).lexically_normal().parent_path(); }

MadeFiles load(const fs::path& directory) {
    const fs::path manifest = directory / Manifest::kFileName;
    std::error_code error;
    if (!fs::is_regular_file(manifest, error)) return {};
    return parse_manifest(read_file(manifest)).value_or(MadeFiles{});
}

bool is_unchanged(const fs::path& file, const MadeFile& made) {
    return fs::file_size(file) == made.size && sha256_of_file(file) == made.sha256;
}

void forget_vanished(const fs::path& directory, MadeFiles& files) {
    std::erase_if(files, [&directory](const auto& entry) {
        std::error_code error;
        return !fs::exists(directory / entry.first, error) && !error;
    });
}

}  // namespace

Manifest::~Manifest() {
    try {
        save();
    } catch (const std::exception&) {  // the outputs themselves are whole; only their record is missing
    }
}

const MadeFiles& Manifest::known_in(const fs::path& directory) {
    const auto found = known_.find(directory);
    return found != known_.end() ? found->second : known_.emplace(directory, load(directory)).first->second;
}

void Manifest::require_replaceable(const fs::path& file) {
    std::error_code error;
    if (force_ || !fs::exists(file, error)) return;
    if (!fs::is_regular_file(file, error)) return;  // AtomicFile says what is wrong with it
    const MadeFiles& known = known_in(directory_of(file));
    const auto made = known.find(file.filename().string());
    const char* reason = made == known.end()                 ? "exists and was not made by beamcam"
                         : !is_unchanged(file, made->second) ? "was changed after beamcam made it"
                                                             : nullptr;
    if (reason != nullptr)
        throw WouldOverwrite(file.string() + " " + reason +
                             "; move it, choose another name, or replace it with --force");
}

std::optional<Manifest::Entry> Manifest::find(const fs::path& file) {
    const MadeFiles known = load(directory_of(file));
    const auto made = known.find(file.filename().string());
    if (made == known.end()) return std::nullopt;
    return Entry{made->second, is_unchanged(file, made->second)};
}

void Manifest::record(const fs::path& file, const std::string& version, const std::string& scene) {
    unsaved_[directory_of(file)][file.filename().string()] = {sha256_of_file(file), fs::file_size(file), version,
                                                              scene};
    if (++unsaved_count_ >= kSaveEvery) save();
}

void Manifest::save() {
    for (auto directory = unsaved_.begin(); directory != unsaved_.end(); directory = unsaved_.erase(directory)) {
        const DirectoryLock lock(directory->first);
        MadeFiles files = load(directory->first);
        for (const auto& [name, made] : directory->second) files[name] = made;
        forget_vanished(directory->first, files);
        write_file(directory->first / kFileName, manifest_json(files));
    }
    unsaved_count_ = 0;
}

}  // namespace beamcam::output
