#include "output/files/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <random>
#include <utility>

namespace beamcam::output {

namespace fs = std::filesystem;

namespace {

// ".fall.mp4.3f9c01d2.part"; long names are shortened, since file systems allow 255 bytes.
std::string hidden_name(const std::string& file_name, unsigned random) {
    constexpr std::size_t kLongestKept = 200;
    char suffix[24];
    std::snprintf(suffix, sizeof suffix, ".%08x.part", random);
    std::string name(1, '.');
    return name.append(file_name, 0, kLongestKept).append(suffix);
}

// The file that a chain of symbolic links ends at, whether it exists yet or not.
fs::path followed(const fs::path& target) {
    constexpr int kLongestChain = 40;  // as in Linux
    fs::path path = fs::absolute(target);
    std::error_code error;
    for (int links = 0; fs::is_symlink(fs::symlink_status(path, error)); ++links) {
        if (links == kLongestChain) throw write_error(target, ELOOP);
        const fs::path next = fs::read_symlink(path, error);
        if (error) throw write_error(target, error.value());
        path = path.parent_path() / next;  // an absolute `next` stands alone
    }
    return path;
}

void require_file(const fs::path& target, const fs::path& real) {
    if (!real.has_filename())
        throw IoError("cannot write " + target.string() + ": it names a directory; add a file name");
    std::error_code error;
    const fs::file_status status = fs::status(real, error);
    if (!fs::exists(status) || fs::is_regular_file(status)) return;
    if (fs::is_directory(status)) throw write_error(target, EISDIR);
    throw IoError("cannot write " + target.string() + ": it is a device or a pipe, which cannot be replaced by a file");
}

void sync_directory(const fs::path& directory) {
    const int descriptor = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;  // the file itself is safe; some file systems do not open directories
    fsync(descriptor);
    close(descriptor);
}

// The path of an open directory, even if its name now leads elsewhere.
fs::path path_of(int directory, const fs::path& name) {
    std::error_code error;
    const fs::path path = fs::read_symlink("/proc/self/fd/" + std::to_string(directory), error);
    return error ? fs::weakly_canonical(name, error) : path;  // no /proc
}

// `real` is the parent directory of the file, links followed.
void require_below(const fs::path& file, const fs::path& real, const fs::path& folder) {
    std::error_code error;
    const fs::path base = fs::weakly_canonical(fs::absolute(folder), error);
    const auto [in_base, in_real] = std::mismatch(base.begin(), base.end(), real.begin(), real.end());
    if (!error && in_base == base.end()) return;
    throw IoError("cannot write " + file.string() + ": a symbolic link leads it out of " + folder.string() + ", to " +
                  real.string() + "; remove the link, or choose that folder with -o");
}

}  // namespace

AtomicFile::AtomicFile(Target target) : target_(std::move(target)), real_(followed(target_.path)) {
    require_file(target_.path, real_);
    directory_ = open(real_.parent_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (directory_ < 0) throw write_error(target_.path, errno);
    try {
        if (!target_.within.empty())
            require_below(target_.path, path_of(directory_, real_.parent_path()), target_.within);
        create();
    } catch (...) {
        close(directory_);
        throw;
    }
}

void AtomicFile::create() {
    if (faccessat(directory_, ".", W_OK | X_OK, AT_EACCESS) != 0) throw write_error(target_.path, errno);
    std::random_device random;
    for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
        temporary_ = real_.parent_path() / hidden_name(real_.filename().string(), random());
        if (std::error_code error; fs::exists(fs::symlink_status(temporary_, error))) continue;
        if (target_.before_creation) target_.before_creation(temporary_);
        // Registered first: a signal between the two lines must not leave the file behind.
        registered_.emplace(temporary_);
        descriptor_ = openat(directory_, temporary_.filename().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                             0666);  // less the umask
        if (descriptor_ < 0 && errno != EEXIST) throw write_error(target_.path, errno);
    }
    if (descriptor_ < 0) throw write_error(target_.path, EEXIST);
    pending_ = true;
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (pending_) unlinkat(directory_, temporary_.filename().c_str(), 0);
    close(directory_);
}

void AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw write_error(target_.path, errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::write_at(std::uint64_t offset, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw write_error(target_.path, errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
        offset += static_cast<std::uint64_t>(written);
    }
}

void AtomicFile::commit(Durability durability) {
    if (!pending_) throw std::logic_error("AtomicFile: " + target_.path.string() + " is committed already");
    if (durability == Durability::synced && fsync(descriptor_) != 0) throw write_error(target_.path, errno);
    // Closed before it is renamed: network file systems report a full disk only here.
    if (close(std::exchange(descriptor_, -1)) != 0) throw write_error(target_.path, errno);
    if (target_.before_rename) target_.before_rename(temporary_);
    if (renameat(directory_, temporary_.filename().c_str(), directory_, real_.filename().c_str()) != 0)
        throw write_error(target_.path, errno);
    pending_ = false;
    registered_.reset();
    if (durability == Durability::synced) sync_directory(real_.parent_path());
}

void write_file(const Target& target, std::string_view bytes, Durability durability) {
    AtomicFile file(target);
    file.write(bytes);
    file.commit(durability);
}

void require_within(const fs::path& file, const fs::path& folder) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(followed(file).parent_path(), error);
    if (error) throw write_error(file, error.value());
    require_below(file, real, folder);
}

bool path_exists(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::none) throw read_error(file, error.value());
    return fs::exists(status);
}

void ensure_directory(const fs::path& directory) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (!error && !fs::is_directory(directory)) error = std::make_error_code(std::errc::not_a_directory);
    if (error) throw IoError("cannot create the directory " + directory.string() + ": " + error.message());
}

std::string read_file(const fs::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) throw read_error(file, errno);
    std::string content;
    constexpr std::size_t kChunk = 1 << 16;  // a megabyte would be cleared twice for every small file
    for (;;) {
        const std::size_t used = content.size();
        content.resize(used + kChunk);
        const ssize_t got = read(descriptor, content.data() + used, kChunk);
        content.resize(used + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
        if (got < 0 && errno == EINTR) continue;
        const int error_number = errno;
        if (got > 0) continue;
        close(descriptor);
        if (got < 0) throw read_error(file, error_number);
        return content;
    }
}

}  // namespace beamcam::output
