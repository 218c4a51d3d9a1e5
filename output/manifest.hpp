// Which files beamcam made: `.beamcam.json` beside them, with the SHA-256 of each and of what it was made from. An
// existing file is replaced only if it is listed there and unchanged since, or when the user says --force. One that was
// made from the same inputs need not be made again.
//
// The manifest is rewritten atomically and under a lock on its directory, so that several processes may
// work in one directory. A damaged manifest counts as empty and is replaced at the next `save`.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "output/errors.hpp"
#include "output/records.hpp"

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
    bool is_made_from(const std::filesystem::path& file, const std::string& inputs);

    // These are about to be made: if the program is killed between putting one in its place and recording it, the next
    // run still knows it as beamcam's own, by its time. Call after `require_replaceable`; failing is no error.
    void announce(const std::vector<std::filesystem::path>& files);
    // Call after the file is in its place. Saved every few files and by `save`.
    void record(const std::filesystem::path& file, const Origin& origin = {});
    void save();

    // What the manifest beside a file says of it; nothing when it is not listed.
    struct Entry : MadeFile {
        bool unchanged = true;
    };
    static std::optional<Entry> find(const std::filesystem::path& file);

  private:
    const MadeFiles& known_in(const std::filesystem::path& directory);
    const MadeFile* known(const std::filesystem::path& file);
    void withdraw();

    bool force_;
    std::map<std::filesystem::path, MadeFiles> known_;                  // by directory, as first read
    std::map<std::filesystem::path, MadeFiles> unsaved_;                // by directory
    std::map<std::filesystem::path, std::set<std::string>> announced_;  // by directory, not recorded yet
    std::size_t unsaved_count_ = 0;
};

}  // namespace beamcam::output
