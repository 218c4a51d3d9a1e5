// The list of the files that beamcam made in a directory: `.beamcam.json`, with the SHA-256 of each file and of its
// inputs. An existing file is replaced only if it is listed and unchanged, or with --force. A file that was made from
// the same inputs is up to date.
//
// A file is recorded in a journal (journal.hpp) before it appears. So the next run can tell beamcam's files from the
// user's even if a run is killed at any instant.
//
// The manifest is replaced atomically and under a lock on its directory, so that several processes may use one
// directory. A damaged manifest counts as empty; the next `save` replaces it and keeps it as kDamagedName.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "output/data/file_records.hpp"
#include "output/data/journal.hpp"
#include "output/files/errors.hpp"
#include "output/files/target.hpp"

namespace beamcam::output {

class Manifest {
  public:
    static constexpr const char *kFileName = ".beamcam.json", *kDamagedName = ".beamcam.json.damaged";

    explicit Manifest(bool force) : force_(force) {}
    // Saves unsaved records and ignores errors; call `save` to get them.
    ~Manifest();
    Manifest(const Manifest&) = delete;
    Manifest& operator=(const Manifest&) = delete;

    // To be called for every output before the work begins. Throws WouldOverwrite if the file exists and beamcam did
    // not make it, IoError if it cannot be read.
    void require_replaceable(const std::filesystem::path& file);

    // The file exists, unchanged since it was made from these inputs.
    bool is_up_to_date(const std::filesystem::path& file, const std::string& inputs);

    // The destination for the writer of the file, in any thread. It records the file when it appears, and does not
    // replace a file that beamcam did not make. This object must outlive the writer.
    Target target(const std::filesystem::path& file, Origin origin = {});
    // Writes the records into the manifests.
    void save();

    // Records the files that killed runs finished in this directory, and removes their temporary files.
    void recover(const std::filesystem::path& directory);

    // The record of a file in the manifest beside it; nothing if it is not listed.
    struct Entry : FileRecord {
        bool unchanged = true;
    };
    static std::optional<Entry> find(const std::filesystem::path& file);
    // Why the manifest beside the file cannot be read, for messages; empty: it can, or there is none.
    static std::string damage(const std::filesystem::path& file);

  private:
    // The possible versions of each file, the latest last: a killed run may or may not have replaced it.
    using Versions = std::map<std::string, std::vector<FileRecord>>;
    struct Directory {
        std::optional<Versions> known;  // as first read, and the files of this run
        std::unique_ptr<Journal> journal;
    };

    static Versions load(const std::filesystem::path& directory);
    static void merge_journals(const std::filesystem::path& directory, std::unique_ptr<Journal>& own);

    Versions& known_in(const std::filesystem::path& directory);
    const FileRecord* known(const std::filesystem::path& file);
    Journal& journal_in(const std::filesystem::path& directory);
    void require_own(const std::filesystem::path& file);

    bool force_;
    std::mutex mutex_;  // guards the members below
    std::map<std::filesystem::path, Directory> directories_;
};

}  // namespace beamcam::output
