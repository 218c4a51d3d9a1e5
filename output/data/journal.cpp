#include "output/data/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <random>
#include <string_view>

#include "output/files/errors.hpp"

namespace beamcam::output {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kBegin = ".beamcam.", kEnd = ".journal", kTemporary = ".part";
constexpr std::size_t kDigits = 8;  // hexadecimal, of the random part of a name

bool is_random_part(std::string_view text) {
    return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_journal(std::string_view name) {
    return name.size() == kBegin.size() + kDigits + kEnd.size() && name.starts_with(kBegin) && name.ends_with(kEnd) &&
           is_random_part(name.substr(kBegin.size(), kDigits));
}

// Named by AtomicFile: a journal from elsewhere must not make us remove other files.
bool is_temporary(std::string_view name) {
    if (!name.starts_with('.') || !name.ends_with(kTemporary) || name.find('/') != std::string_view::npos) return false;
    name.remove_suffix(kTemporary.size());
    return name.size() > kDigits + 2 && name[name.size() - kDigits - 1] == '.' &&
           is_random_part(name.substr(name.size() - kDigits));
}

}  // namespace

DirectoryLock::DirectoryLock(const fs::path& directory)
    : descriptor_(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ < 0) return;
    while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
}

DirectoryLock::~DirectoryLock() {
    if (descriptor_ >= 0) close(descriptor_);
}

Journal::Journal(const fs::path& directory) {
    const DirectoryLock lock(directory);  // so that no other run regards it as abandoned before it is locked
    std::random_device random;
    for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
        char digits[kDigits + 1];
        std::snprintf(digits, sizeof digits, "%08x", random());
        file_ = directory / std::string(kBegin).append(digits).append(kEnd);
        descriptor_ = open(file_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ < 0 && errno != EEXIST) throw write_error(file_, errno);
    }
    if (descriptor_ < 0) throw write_error(file_, EEXIST);
    while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
}

Journal::~Journal() {
    if (descriptor_ >= 0) close(descriptor_);
}

void Journal::add(const std::string& line) {
    for (std::string_view rest = line; !rest.empty();) {
        const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw write_error(file_, errno);
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
}

void Journal::remove() { unlink(file_.c_str()); }

std::vector<fs::path> journals_in(const fs::path& directory) {
    std::vector<fs::path> all;
    std::error_code failed;
    for (fs::directory_iterator at(directory, failed), end; !failed && at != end; at.increment(failed))
        if (std::error_code gone; is_journal(at->path().filename().string()) && at->is_regular_file(gone))
            all.push_back(at->path());
    std::sort(all.begin(), all.end());
    return all;
}

bool is_abandoned(const fs::path& journal) {
    const int descriptor = open(journal.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) return false;
    const bool free = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    close(descriptor);
    return free;
}

void remove_temporaries(const fs::path& directory, const JournalLines& lines) {
    for (const std::string& name : lines.temporaries) {
        std::error_code error;
        if (is_temporary(name) && fs::is_regular_file(fs::symlink_status(directory / name, error)))
            fs::remove(directory / name, error);
    }
}

}  // namespace beamcam::output
