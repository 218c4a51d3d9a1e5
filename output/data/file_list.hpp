// The list of the files that beamcam made in a directory: `.beamcam.jsonl`, a line of JSON for each file, with its
// name, its SHA-256, that of its inputs, and the mark of the user whose run made it. Lines are only appended; of
// several lines with one name the last one counts that has the file's digest.
//
// An existing file is replaced only if its bytes still have a digest of the list and the line has this user's mark
// (owner.hpp), or with --force: a list that came with a folder makes nothing ours. A file that was made from the same
// inputs is up to date.
//
// The line is written before the file appears under its name. So the next run can tell beamcam's files from the user's
// even if a run is killed at any instant. The list is locked while a line is added, so that several processes may use
// one directory, and is rewritten when most of its lines are outdated and no file is being written there. Lines that
// are no records are skipped. In a folder where only its owner may replace the list, other users' files are not
// recorded.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "output/files/errors.hpp"
#include "output/files/target.hpp"

namespace beamcam::output {

// The inputs of a file.
struct Origin {
    std::string inputs;          // digest: files with equal inputs are equal. Empty: unknown
    std::string version, scene;  // of the program; JSON text, if the file itself cannot contain it
    bool operator==(const Origin&) const = default;
};

struct FileRecord {
    std::string name;  // without directory
    std::string sha256;
    std::uintmax_t size = 0;  // [bytes]
    std::string mark;         // owner_mark of the user whose run made the file
    std::string stamp;        // inode and time of the unchanged file, so that it need not be read; empty: unknown
    Origin origin;
    bool is_own() const;  // the mark is that of this user
    bool operator==(const FileRecord&) const = default;
};

std::string line_of(const FileRecord& record);
// The records in the order of the text, without the lines that are no records.
std::vector<FileRecord> parse_file_list(const std::string& text);

class FileList {
  public:
    static constexpr const char* kFileName = ".beamcam.jsonl";

    explicit FileList(bool force) : force_(force) {}
    FileList(const FileList&) = delete;
    FileList& operator=(const FileList&) = delete;

    // To be called for every output before the work begins. Throws WouldOverwrite if the file exists and a run of this
    // user did not make it, IoError if it cannot be read or written.
    void require_replaceable(const std::filesystem::path& file);

    // The file exists, unchanged since a run of this user made it from these inputs.
    bool is_up_to_date(const std::filesystem::path& file, const std::string& inputs);

    // The destination for the writer of the file, in any thread. It records the file before it appears, and does not
    // replace a file of others. This object must outlive the writer.
    FileTarget target(const std::filesystem::path& file, Origin origin = {});

    // Removes what killed runs left half-written in this directory an hour ago, and outdated lines of the list.
    // require_replaceable does so, too.
    static void recover(const std::filesystem::path& directory);

    // The record of a file in the list beside it, whoever made it; nothing if it is not listed.
    struct Entry : FileRecord {
        bool unchanged = true;
    };
    static std::optional<Entry> find(const std::filesystem::path& file);

  private:
    using Versions = std::map<std::string, std::vector<FileRecord>>;  // of each file, the latest last

    static Versions load(const std::filesystem::path& directory);
    static std::string without_outdated_lines(const std::filesystem::path& directory);
    const FileRecord* known(const std::filesystem::path& file);
    void require_own(const std::filesystem::path& file);

    const bool force_;
    std::mutex mutex_;                                    // guards the members below
    std::set<std::filesystem::path> recovered_;           // directories
    std::map<std::filesystem::path, Versions> known_in_;  // by directory, as first read, and the files of this run
};

}  // namespace beamcam::output
