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

Descriptor unnamed_file_in(const char* directory) {
    if (!directory || !*directory) return {};
    if (const int file = open(directory, O_TMPFILE | O_RDWR | O_EXCL | O_CLOEXEC, 0600); file >= 0)
        return Descriptor(file);
    // Some file systems, mainly network file systems, have no unnamed files.
    std::string name = std::string(directory) + "/beamcam-XXXXXX";
    Descriptor file(mkostemp(name.data(), O_CLOEXEC));
    if (file) unlink(name.c_str());
    return file;
}

// /var/tmp before /tmp, which is often in memory.
Descriptor unnamed_file() {
    for (const char* directory : {static_cast<const char*>(std::getenv("TMPDIR")), "/var/tmp", "/tmp"})
        if (Descriptor file = unnamed_file_in(directory)) return file;
    return {};
}

// Returns the number of bytes before the end of the file.
std::size_t read_from(const Descriptor& file, std::uint64_t at, std::span<std::byte> into) {
    const std::ptrdiff_t got = file.read_at(at, into.data(), into.size());
    if (got < 0) throw read_error("the temporary file of a motion", errno);
    return static_cast<std::size_t>(got);
}

}  // namespace

void Spool::move_to_file() {
    file_ = unnamed_file();
    if (file_ && !file_.write_at(0, bytes_of(memory_))) file_ = Descriptor();
    no_file_ = !file_;
    if (file_) std::vector<std::byte>().swap(memory_);
}

// The disk is full: copies the content of the file to memory.
void Spool::read_back() {
    memory_.assign(static_cast<std::size_t>(size_), std::byte{0});
    read_from(file_, 0, memory_);
    file_.close();
    no_file_ = true;
}

void Spool::write(std::uint64_t at, std::span<const std::byte> bytes) {
    const std::uint64_t end = at + bytes.size();
    if (!file_ && !no_file_ && end > limit_) move_to_file();
    if (file_ && !file_.write_at(at, bytes_of(bytes))) read_back();
    size_ = std::max(size_, end);
    if (file_) return;
    if (memory_.size() < size_) memory_.resize(static_cast<std::size_t>(size_), std::byte{0});
    std::ranges::copy(bytes, memory_.begin() + static_cast<std::ptrdiff_t>(at));
}

void Spool::read(std::uint64_t at, std::span<std::byte> into) const {
    std::size_t done = 0;
    if (file_) {
        done = read_from(file_, at, into);
    } else if (at < memory_.size()) {
        done = std::min<std::size_t>(into.size(), memory_.size() - static_cast<std::size_t>(at));
        std::copy_n(memory_.begin() + static_cast<std::ptrdiff_t>(at), done, into.begin());
    }
    std::ranges::fill(into.subspan(done), std::byte{0});
}

}  // namespace beamcam::output
