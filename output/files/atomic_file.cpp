#include "output/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <random>
#include <utility>

namespace beamcam::output {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kPiece = 1 << 18;  // [bytes] read at once
constexpr std::size_t kRandomDigits = 8;
constexpr std::string_view kTemporaryEnding = ".part";

// ".fall.mp4.3f9c01d2.part"; long names are shortened, since file systems allow 255 bytes.
std::string temporary_name(const std::string& file_name) {
    constexpr std::size_t kLongestKept = 200;
    return fmt::format(".{}.{}{}", file_name.substr(0, kLongestKept), random_digits(), kTemporaryEnding);
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

// Locks a new temporary file, which remove_abandoned_parts may have removed before.
bool is_kept(Descriptor& file) {
    file.lock();
    struct stat status = {};
    return fstat(file.number(), &status) != 0 || status.st_nlink > 0;
}

void sync_directory(const fs::path& directory) {
    // If this fails, the file itself is safe; some file systems do not open directories.
    if (const Descriptor opened(directory, O_RDONLY | O_DIRECTORY); opened) fsync(opened.number());
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

AtomicFile::AtomicFile(FileTarget target) : target_(std::move(target)), real_(followed(target_.path)) {
    require_file(target_.path, real_);
    directory_ = Descriptor(real_.parent_path(), O_PATH | O_DIRECTORY);
    if (!directory_) throw write_error(target_.path, errno);
    if (!target_.within.empty())
        require_below(target_.path, path_of(directory_.number(), real_.parent_path()), target_.within);
    create();
}

void AtomicFile::create() {
    if (faccessat(directory_.number(), ".", W_OK | X_OK, AT_EACCESS) != 0) throw write_error(target_.path, errno);
    for (int attempt = 0; attempt < 100 && !file_; ++attempt) {
        temporary_ = real_.parent_path() / temporary_name(real_.filename().string());
        if (std::error_code error; fs::exists(fs::symlink_status(temporary_, error))) continue;
        // Registered first: a signal between the two lines must not leave the file behind.
        registered_.emplace(temporary_);
        file_ = Descriptor(openat(directory_.number(), temporary_.filename().c_str(),
                                  O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));  // less the umask
        if (!file_ && errno != EEXIST) throw write_error(target_.path, errno);
        if (file_ && !is_kept(file_)) file_.close();
    }
    if (!file_) throw write_error(target_.path, EEXIST);
    pending_ = true;
}

AtomicFile::~AtomicFile() {
    file_.close();
    if (pending_) unlinkat(directory_.number(), temporary_.filename().c_str(), 0);
}

void AtomicFile::write(std::string_view bytes) {
    if (!file_.write(bytes)) throw write_error(target_.path, errno);
}

void AtomicFile::write_at(std::uint64_t offset, std::string_view bytes) {
    if (!file_.write_at(offset, bytes)) throw write_error(target_.path, errno);
}

void AtomicFile::commit(Durability durability) {
    if (!pending_) throw std::logic_error("AtomicFile: " + target_.path.string() + " is committed already");
    if (durability == Durability::synced && fsync(file_.number()) != 0) throw write_error(target_.path, errno);
    const Descriptor lock(fcntl(file_.number(), F_DUPFD_CLOEXEC, 0));  // until the file has its name
    if (!file_.close()) throw write_error(target_.path, errno);
    if (target_.before_rename) target_.before_rename(temporary_);
    const int directory = directory_.number();
    if (renameat(directory, temporary_.filename().c_str(), directory, real_.filename().c_str()) != 0)
        throw write_error(target_.path, errno);
    pending_ = false;
    registered_.reset();
    if (durability == Durability::synced) sync_directory(real_.parent_path());
}

void write_file(const FileTarget& target, std::string_view bytes, Durability durability) {
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

void read_pieces(const fs::path& file, const std::function<void(std::string_view piece)>& visit) {
    Descriptor opened(file, O_RDONLY);
    if (!opened) throw read_error(file, errno);
    const auto piece = std::make_unique_for_overwrite<char[]>(kPiece);
    for (;;) {
        const std::ptrdiff_t got = opened.read(piece.get(), kPiece);
        if (got < 0) throw read_error(file, errno);
        if (got > 0) visit({piece.get(), static_cast<std::size_t>(got)});
        if (got < static_cast<std::ptrdiff_t>(kPiece)) return;
    }
}

std::string read_file(const fs::path& file) {
    std::string content;
    read_pieces(file, [&content](std::string_view piece) { content += piece; });
    return content;
}

std::string read_regular_file(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw IoError("cannot read " + file.string() + ": it is not a regular file");
    return read_file(file);
}

std::string random_digits() { return fmt::format("{:0{}x}", std::random_device()(), kRandomDigits); }

bool is_temporary_name(std::string_view name) {
    if (!name.starts_with('.') || !name.ends_with(kTemporaryEnding) || name.find('/') != std::string_view::npos)
        return false;
    name.remove_suffix(kTemporaryEnding.size());
    return name.size() > kRandomDigits + 2 && name[name.size() - kRandomDigits - 1] == '.' &&
           name.substr(name.size() - kRandomDigits).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

void remove_abandoned_parts(const fs::path& directory) {
    constexpr std::time_t kLongestPause = 3600;  // [s] between two writes of a run that lives
    std::error_code failed;
    for (fs::directory_iterator at(directory, failed), end; !failed && at != end; at.increment(failed)) {
        if (!is_temporary_name(at->path().filename().string())) continue;
        Descriptor file(at->path(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
        struct stat status = {};
        if (!file || fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_uid != geteuid())
            continue;
        if (std::time(nullptr) - status.st_mtime <= kLongestPause) continue;
        if (file.try_lock() || errno != EWOULDBLOCK) unlink(at->path().c_str());
    }
}

}  // namespace beamcam::output
