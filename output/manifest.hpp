// Which files beamcam made: `.beamcam.json` beside them, with the SHA-256 of each. An existing file is replaced
// only if it is listed there and unchanged since, or when the user says --force.
//
// The manifest is rewritten atomically and under a lock on its directory, so that several processes may
// work in one directory. A damaged manifest counts as empty and is replaced at the next `save`.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
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

    // Call after the file is in its place. Saved every few files and by `save`.
    // Version and scene, for files that cannot say themselves where they came from.
    void record(const std::filesystem::path& file, const std::string& version = "", const std::string& scene = "");
    void save();

    // What the manifest beside a file says of it; nothing when it is not listed.
    struct Entry : MadeFile {
        bool unchanged = true;
    };
    static std::optional<Entry> find(const std::filesystem::path& file);

  private:
    const MadeFiles& known_in(const std::filesystem::path& directory);

    bool force_;
    std::map<std::filesystem::path, MadeFiles> known_;    // by directory, as first read
    std::map<std::filesystem::path, MadeFiles> unsaved_;  // by directory
    std::size_t unsaved_count_ = 0;
};

}  // namespace beamcam::output
