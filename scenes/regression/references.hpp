// The references of one entry: plain files in references/ENTRY, which git shows, commits and undoes.
//
//     0000.png, 0001.png …   the pictures
//     motion.csv             the motion of the scene, or the one behind the picture; motion-1.csv … of compared motions
//     impacts.json           its impacts, and the time up to which it is reproducible; impacts-1.json …
//     sweep.csv              the samples of a sweep
//     digests.json           {"RENDERER": ["SHA-256 of the pixels", …]}: the pixels that renderers drew when they were
//                            accepted. They only tell "identical" from "equivalent"; the pictures decide.
//
// An update writes these files and no others. A folder without digests.json may be the user's: an update replaces no
// file in it without --force.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace beamcam::scenes {

using Digests = std::map<std::string, std::vector<std::string>>;  // of the pixels of each picture, by renderer

inline constexpr const char* kDigestsFile = "digests.json";
std::string picture_name(long frame);  // "0012.png"
// Throws IoError: a reference cannot be read.
[[noreturn]] void refuse_reference(const std::filesystem::path& file, const char* why);

class References {
  public:
    // `folder`: of all entries. `is_updated`: the test replaces the references; damaged ones are then no error.
    References(const std::filesystem::path& folder, const std::string& entry, bool is_updated);

    std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    bool has(const std::string& name) const;
    const std::filesystem::path& folder() const { return folder_; }
    std::size_t pictures() const;
    // Throws IoError if digests.json is damaged.
    Digests digests() const;
    bool is_updated() const { return is_updated_; }

  private:
    const std::filesystem::path folder_;
    const bool is_updated_;
};

// The update of one entry, collected in memory until the entry is judged.
class ReferenceUpdate {
  public:
    // The references have, or get, a file of this name. Those that nothing names are removed.
    void keep(const std::string& name) { names_.insert(name); }
    void put(const std::string& name, std::string content);
    void put_digests(const Digests& digests);
    void withdraw(const std::string& name) { changed_.erase(name); }
    void only_digests();  // withdraws all others

    struct Changes {
        std::vector<std::string> written, removed;  // file names
        bool empty() const { return written.empty() && removed.empty(); }
    };
    // Each file appears complete or not at all. `root`: symbolic links must not lead out of it. Throws WouldOverwrite
    // before the first change, and IoError.
    Changes carry_out(const References& references, const std::filesystem::path& root, bool force) const;

  private:
    std::set<std::string> names_;
    std::map<std::string, std::string> changed_;  // content by file name
};

}  // namespace beamcam::scenes
