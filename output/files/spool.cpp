#include "output/files/spool.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>

#include "output/files/errors.hpp"

namespace beamcam::output {
namespace {

int unnamed_file_in(const char* directory) {
    if (!directory || !*directory) return -1;
    if (const int file = open(directory, O_TMPFILE | O_RDWR | O_EXCL | O_CLOEXEC, 0600); file >= 0) return file;
    // Some file systems, mainly network file systems, have no unnamed files.
    std::string name = std::string(directory) + "/beamcam-XXXXXX";
    const int file = mkostemp(name.data(), O_CLOEXEC);
    if (file >= 0) unlink(name.c_str());
    return file;
}

// /var/tmp before /tmp, which is often in memory.
int unnamed_file() {
    for (const char* directory : {static_cast<const char*>(std::getenv("TMPDIR")), "/var/tmp", "/tmp"})
        if (const int file = unnamed_file_in(directory); file >= 0) return file;
    return -1;
}

// Returns the number of bytes before the end of the file.
std::size_t read_from(int file, std::uint64_t at, std::span<std::byte> into) {
    std::size_t done = 0;
    while (done < into.size()) {
        const ssize_t got = pread(file, into.data() + done, into.size() - done, static_cast<off_t>(at + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw read_error("the temporary file of a motion", errno);
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

}  // namespace

Spool::~Spool() {
    if (descriptor_ >= 0) close(descriptor_);
}

bool Spool::write_to_file(std::uint64_t at, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
        at += static_cast<std::uint64_t>(written);
    }
    return true;
}

// The disk is full: copies the content of the file to memory.
void Spool::read_back() {
    memory_.assign(static_cast<std::size_t>(size_), std::byte{0});
    read_from(descriptor_, 0, memory_);
    close(descriptor_);
    descriptor_ = -1;
    no_file_ = true;
}

void Spool::write(std::uint64_t at, std::span<const std::byte> bytes) {
    const std::uint64_t end = at + bytes.size();
    if (descriptor_ < 0 && !no_file_ && end > limit_) {
        descriptor_ = unnamed_file();
        no_file_ = descriptor_ < 0;
        if (descriptor_ >= 0 && !write_to_file(0, memory_)) {
            close(descriptor_);
            descriptor_ = -1;
            no_file_ = true;
        }
        if (descriptor_ >= 0) std::vector<std::byte>().swap(memory_);
    }
    if (descriptor_ >= 0 && !write_to_file(at, bytes)) read_back();
    size_ = std::max(size_, end);
    if (descriptor_ >= 0) return;
    if (memory_.size() < size_) memory_.resize(static_cast<std::size_t>(size_), std::byte{0});
    std::ranges::copy(bytes, memory_.begin() + static_cast<std::ptrdiff_t>(at));
}

void Spool::read(std::uint64_t at, std::span<std::byte> into) const {
    std::size_t done = 0;
    if (descriptor_ >= 0) {
        done = read_from(descriptor_, at, into);
    } else if (at < memory_.size()) {
        done = std::min<std::size_t>(into.size(), memory_.size() - static_cast<std::size_t>(at));
        std::copy_n(memory_.begin() + static_cast<std::ptrdiff_t>(at), done, into.begin());
    }
    std::ranges::fill(into.subspan(done), std::byte{0});
}

}  // namespace beamcam::output
