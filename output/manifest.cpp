#include "output/manifest.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

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

// The file's time stamp [ns]; 0 where it has none.
std::int64_t modified(const fs::path& file) {
    struct stat status;
    if (stat(file.c_str(), &status) != 0) return 0;
    return status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec;
}

std::int64_t now() {
    timespec time;
    // The clock that stamps files: it ticks more coarsely than others, and must not be ahead of them.
    clock_gettime(CLOCK_REALTIME_COARSE, &time);
    return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

// The inode is new whenever a file is replaced, the time whenever it is written to.
std::string stamp_of(const fs::path& file) {
    struct stat status;
    if (stat(file.c_str(), &status) != 0) return {};
    return std::to_string(status.st_ino) + ":" + std::to_string(modified(file));
}

bool is_unchanged(const fs::path& file, const MadeFile& made) {
    if (made.sha256.empty() || fs::file_size(file) != made.size) return false;
    return (!made.stamp.empty() && stamp_of(file) == made.stamp) || sha256_of_file(file) == made.sha256;
}

// Put there by a run that was killed before it could record it.
bool is_left_behind(const fs::path& file, const MadeFile& made) {
    return made.making != 0 && modified(file) >= made.making;
}

void forget_vanished(const fs::path& directory, MadeFiles& files) {
    std::erase_if(files, [&directory](const auto& entry) {
        std::error_code error;
        return entry.second.making == 0 && !fs::exists(directory / entry.first, error) && !error;
    });
}

}  // namespace

Manifest::~Manifest() {
    try {
        save();
        withdraw();
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
    const MadeFile* made = known(file);
    const char* reason = made == nullptr ? "exists and was not made by beamcam"
                         : !is_unchanged(file, *made) && !is_left_behind(file, *made)
                             ? "was changed after beamcam made it"
                             : nullptr;
    if (reason != nullptr)
        throw WouldOverwrite(file.string() + " " + reason +
                             "; move it, choose another name, or replace it with --force");
}

std::optional<Manifest::Entry> Manifest::find(const fs::path& file) {
    const MadeFiles known = load(directory_of(file));
    const auto made = known.find(file.filename().string());
    if (made == known.end() || made->second.sha256.empty()) return std::nullopt;
    return Entry{made->second, is_unchanged(file, made->second)};
}

const MadeFile* Manifest::known(const fs::path& file) {
    const MadeFiles& all = known_in(directory_of(file));
    const auto made = all.find(file.filename().string());
    return made == all.end() ? nullptr : &made->second;
}

bool Manifest::is_made_from(const fs::path& file, const std::string& inputs) {
    std::error_code error;
    if (inputs.empty() || !fs::is_regular_file(file, error)) return false;
    const MadeFile* made = known(file);
    return made != nullptr && made->origin.inputs == inputs && is_unchanged(file, *made);
}

void Manifest::announce(const std::vector<fs::path>& files) {
    std::map<fs::path, std::set<std::string>> by_directory;
    for (const fs::path& file : files) by_directory[directory_of(file)].insert(file.filename().string());
    const std::int64_t since = now();
    for (auto& [directory, names] : by_directory) try {
            const DirectoryLock lock(directory);
            MadeFiles all = load(directory);
            for (const std::string& name : names) all[name].making = since;
            write_file(directory / kFileName, manifest_json(all), Durability::buffered);
            announced_[directory].merge(names);
        } catch (const std::exception&) {  // whoever writes there next tells what is wrong
        }
}

// Takes back what was announced and not made.
void Manifest::withdraw() {
    for (const auto& [directory, names] : announced_) {
        const DirectoryLock lock(directory);
        MadeFiles all = load(directory);
        for (const std::string& name : names)
            if (const auto entry = all.find(name); entry != all.end()) {
                entry->second.making = 0;
                if (entry->second.sha256.empty()) all.erase(entry);
            }
        std::error_code error;
        if (all.empty())
            fs::remove(directory / kFileName, error);
        else
            write_file(directory / kFileName, manifest_json(all));
    }
    announced_.clear();
}

void Manifest::record(const fs::path& file, const Origin& origin) {
    const fs::path directory = directory_of(file);
    const std::string name = file.filename().string();
    unsaved_[directory][name] = {sha256_of_file(file), fs::file_size(file), origin, stamp_of(file), 0};
    if (const auto announced = announced_.find(directory); announced != announced_.end()) {
        announced->second.erase(name);
        if (announced->second.empty()) announced_.erase(announced);
    }
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
