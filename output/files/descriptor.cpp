#include "output/files/descriptor.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace beamcam::output {
namespace {

// Calls transfer(done) for the bytes after the first `done`, until there are no more; −1 after an error.
template <class Transfer>
std::ptrdiff_t transferred(std::size_t size, Transfer transfer) {
    std::size_t done = 0;
    while (done < size) {
        const ssize_t now = transfer(done);
        if (now < 0 && errno == EINTR) continue;
        if (now < 0) return -1;
        if (now == 0) break;
        done += static_cast<std::size_t>(now);
    }
    return static_cast<std::ptrdiff_t>(done);
}

}  // namespace

Descriptor::Descriptor(const std::filesystem::path& file, int flags)
    : number_(open(file.c_str(), flags | O_CLOEXEC, 0666)) {}  // less the umask

bool Descriptor::close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

bool Descriptor::write(std::string_view bytes) {
    const auto rest = [&](std::size_t done) { return ::write(number_, bytes.data() + done, bytes.size() - done); };
    return transferred(bytes.size(), rest) == static_cast<std::ptrdiff_t>(bytes.size());
}

bool Descriptor::write_at(std::uint64_t at, std::string_view bytes) {
    const auto rest = [&](std::size_t done) {
        return pwrite(number_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(at + done));
    };
    return transferred(bytes.size(), rest) == static_cast<std::ptrdiff_t>(bytes.size());
}

std::ptrdiff_t Descriptor::read(void* to, std::size_t size) {
    return transferred(
        size, [&](std::size_t done) { return ::read(number_, static_cast<std::byte*>(to) + done, size - done); });
}

std::ptrdiff_t Descriptor::read_at(std::uint64_t at, void* to, std::size_t size) const {
    return transferred(size, [&](std::size_t done) {
        return pread(number_, static_cast<std::byte*>(to) + done, size - done, static_cast<off_t>(at + done));
    });
}

std::uint64_t Descriptor::size() const {
    struct stat status = {};
    return fstat(number_, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

bool Descriptor::lock() {
    int result = -1;
    do result = flock(number_, LOCK_EX);
    while (result != 0 && errno == EINTR);
    return result == 0;
}

bool Descriptor::try_lock() { return flock(number_, LOCK_EX | LOCK_NB) == 0; }

}  // namespace beamcam::output
