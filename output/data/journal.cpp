#include "output/data/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>

#include "output/files/atomic_file.hpp"

namespace beamcam::output {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kBegin = ".beamcam.", kEnd = ".journal";

bool is_journal(std::string_view name) {
    return name.size() > kBegin.size() + kEnd.size() && name.starts_with(kBegin) && name.ends_with(kEnd) &&
           is_random_part(name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size()));
}

}  // namespace

Descriptor locked_directory(const fs::path& directory) {
    Descriptor opened(directory, O_RDONLY | O_DIRECTORY);
    if (opened) opened.lock();
    return opened;
}

Journal::Journal(const fs::path& directory) {
    const Descriptor lock = locked_directory(directory);  // so that no other run regards it as abandoned
    for (int attempt = 0; attempt < 100 && !file_; ++attempt) {
        path_ = directory / fmt::format("{}{}{}", kBegin, random_digits(), kEnd);
        file_ = Descriptor(path_, O_WRONLY | O_APPEND | O_CREAT | O_EXCL);
        if (!file_ && errno != EEXIST) throw write_error(path_, errno);
    }
    if (!file_) throw write_error(path_, EEXIST);
    file_.lock();
}

void Journal::add(const std::string& line) {
    if (!file_.write(line)) throw write_error(path_, errno);
}

void Journal::remove() { unlink(path_.c_str()); }

std::vector<fs::path> journals_in(const fs::path& directory) {
    std::vector<fs::path> all;
    std::error_code failed;
    for (fs::directory_iterator at(directory, failed), end; !failed && at != end; at.increment(failed))
        if (std::error_code gone; is_journal(at->path().filename().string()) && at->is_regular_file(gone))
            all.push_back(at->path());
    std::ranges::sort(all);
    return all;
}

bool is_abandoned(const fs::path& journal) {
    Descriptor file(journal, O_RDONLY | O_NOFOLLOW);
    return file && file.try_lock();
}

void remove_temporaries(const fs::path& directory, const JournalLines& lines) {
    // A journal from elsewhere must not make us remove other files.
    for (const std::string& name : lines.temporaries) {
        std::error_code error;
        if (is_temporary_name(name) && fs::is_regular_file(fs::symlink_status(directory / name, error)))
            fs::remove(directory / name, error);
    }
}

}  // namespace beamcam::output
