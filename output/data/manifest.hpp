// Which files beamcam made: `.beamcam.json` beside them, with the SHA-256 of each and of what it was made from. An
// existing file is replaced only if it is listed there and unchanged since, or when the user says --force. One that was
// made from the same inputs need not be made again.
//
// A file is known before it appears: its digest goes into a journal (journal.hpp) before it is put in its place, so
// that a run that is killed at any instant leaves no file that the next one takes for the user's, nor the other way
// round.
//
// The manifest is rewritten atomically and under a lock on its directory, so that several processes may work in one
// directory. A damaged manifest counts as empty and is replaced at the next `save`.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "output/data/journal.hpp"
#include "output/data/records.hpp"
#include "output/files/errors.hpp"
#include "output/files/target.hpp"

namespace beamcam::output {

class Manifest {
  public:
    static constexpr const char* kFileName = ".beamcam.json";

    explicit Manifest(bool force) : force_(force) {}
    // Saves what is not saved yet; an error is lost here, so call `save` where it matters.
    ~Manifest();
    Manifest(const Manifest&) = delete;
    Manifest& operator=(const Manifest&) = delete;

    // Call before work begins, for every output. Throws WouldOverwrite when a file stands there that is not
    // beamcam's own, IoError when it cannot be read.
    void require_replaceable(const std::filesystem::path& file);

    // The file stands there, unchanged since it was made from these inputs.
    bool is_up_to_date(const std::filesystem::path& file, const std::string& inputs);

    // Hand it to the writer of the file, from any thread: the file is recorded as it appears, and not put in the place
    // of one that is not beamcam's own. This object must outlive the writer.
    Target target(const std::filesystem::path& file, Origin origin = {});
    // Writes what was recorded into the manifests.
    void save();

    // Records what runs that were killed have finished in this directory, and removes what they have half written.
    void recover(const std::filesystem::path& directory);

    // What the manifest beside a file says of it; nothing when it is not listed.
    struct Entry : FileRecord {
        bool unchanged = true;
    };
    static std::optional<Entry> find(const std::filesystem::path& file);

  private:
    // All that a file of this name may be, the latest last: a run that was killed may or may not have replaced it.
    using Versions = std::map<std::string, std::vector<FileRecord>>;
    struct Directory {
        std::optional<Versions> known;  // as first read, and what this run has put there
        std::unique_ptr<Journal> journal;
    };

    static Versions load(const std::filesystem::path& directory);
    static void settle(const std::filesystem::path& directory, std::unique_ptr<Journal>& own);

    Versions& known_in(const std::filesystem::path& directory);
    const FileRecord* known(const std::filesystem::path& file);
    Journal& journal_in(const std::filesystem::path& directory);
    void require_own(const std::filesystem::path& file);

    bool force_;
    std::mutex mutex_;  // guards what follows
    std::map<std::filesystem::path, Directory> directories_;
};

}  // namespace beamcam::output
