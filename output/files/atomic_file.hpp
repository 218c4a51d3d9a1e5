// A file that appears whole or not at all. It is written under a hidden name beside its target; `commit` flushes and
// renames it, otherwise the destructor removes it. The list of files (file_list.hpp) decides whether the target may be
// replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "output/files/descriptor.hpp"
#include "output/files/errors.hpp"
#include "output/files/interrupt.hpp"
#include "output/files/target.hpp"

namespace beamcam::output {

// Whether `commit` waits until the disk has stored the bytes. With `buffered`, a power failure may lose the newest
// files, but an interrupted or killed program does not; use it for hundreds of frames.
enum class Durability { synced, buffered };

class AtomicFile {
  public:
    // Throws IoError if the directory is missing or read-only, or if the target is a directory or a device, or outside
    // FileTarget::within. Follows a symbolic link: the file that it points to is replaced, and the link stays.
    explicit AtomicFile(FileTarget target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);                           // throws IoError
    void write_at(std::uint64_t offset, std::string_view bytes);  // throws IoError; does not move `write`
    void commit(Durability durability = Durability::synced);      // throws IoError; at most once

    const std::filesystem::path& target() const { return target_.path; }
    // The path for libraries that open files themselves. It exists, empty, until they write to it.
    const std::filesystem::path& temporary_path() const { return temporary_; }

  private:
    void create();

    FileTarget target_;                // its path as the user wrote it, for messages
    std::filesystem::path real_;       // absolute, links followed
    std::filesystem::path temporary_;  // absolute
    std::optional<TemporaryName> registered_;
    Descriptor directory_;  // of both: stays the same if a link in the path is changed
    Descriptor file_;       // the temporary file
    bool pending_ = false;  // it exists
};

// Writes the whole of `bytes` to `target`, atomically.
void write_file(const FileTarget& target, std::string_view bytes, Durability durability = Durability::synced);

// Throws IoError if symbolic links lead from `file`, which need not exist, to a place outside the folder.
void require_within(const std::filesystem::path& file, const std::filesystem::path& folder);

// Whether something exists at `file`, links followed. Throws IoError if that cannot be found out.
bool path_exists(const std::filesystem::path& file);

// Creates the directory and those above it. Throws IoError.
void ensure_directory(const std::filesystem::path& directory);

// The whole content, in one piece or in several. Throws IoError.
std::string read_file(const std::filesystem::path& file);
std::string read_regular_file(const std::filesystem::path& file);  // also throws for a pipe, which might never end
void read_pieces(const std::filesystem::path& file, const std::function<void(std::string_view piece)>& visit);

// Removes the temporary files that killed runs of this user left in a directory: those that nobody wrote to for an hour
// and that no living run has locked.
void remove_abandoned_parts(const std::filesystem::path& directory);

// Eight hexadecimal digits, for names of files that no other run uses.
std::string random_digits();
bool is_temporary_name(std::string_view name);  // of AtomicFile

}  // namespace beamcam::output
