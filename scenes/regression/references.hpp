// The folders of reference pictures and motions, one for each entry of a file of baselines, and their update.
//
// A folder is beamcam's own if its marker, `.beamcam-reference`, says so; the marker lists the files that an update
// may replace or remove as long as they are unchanged. Nothing else in the folder is touched.
//
// An update appears as a whole: the new files are collected in `.beamcam-update` beside the folders, then a list of
// what is to be done is written, then it is done. If the program is killed before the list is there, the next run
// removes the collection; afterwards it completes the update.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output/data/journal.hpp"

namespace beamcam::scenes {

struct ReferenceFile {
    std::string sha256;  // of its bytes
    std::string pixels;  // SHA-256 of the decoded pixels; empty for what is no picture
};
using ReferenceFiles = std::map<std::string, ReferenceFile>;  // by file name

// What the marker of a folder lists; nothing where there is no marker. Throws IoError.
std::optional<ReferenceFiles> marked_files(const std::filesystem::path& folder);

class ReferenceUpdate {
  public:
    // Completes or undoes an update that was killed. Says what it did; empty: there was none.
    static std::string recover(const std::filesystem::path& references);

    // `force`: files of these names may be replaced whoever made them. Throws IoError when another one is under way.
    ReferenceUpdate(std::filesystem::path baselines, std::filesystem::path references, bool force);
    ~ReferenceUpdate();  // undoes what is not committed
    ReferenceUpdate(const ReferenceUpdate&) = delete;
    ReferenceUpdate& operator=(const ReferenceUpdate&) = delete;

    // Where the new files of an entry are to be written. Throws WouldOverwrite when its folder is not beamcam's own or
    // holds changed files.
    std::filesystem::path begin(const std::string& entry);
    // The same for files that are added to the entry's, or put in the place of some.
    std::filesystem::path extend(const std::string& entry);
    // The entry stays as it is.
    void drop(const std::string& entry);
    // Puts the new files in the place of the old ones, and `text` into the baselines, which still have to read
    // `expected`. `pixels`: digests of the pictures of each entry by file name.
    void commit(const std::string& expected, const std::string& text,
                const std::map<std::string, std::map<std::string, std::string>>& pixels);

    // One file becomes another one: `before` and `after` are digests, empty where there is no file.
    struct Task {
        std::string entry, name, before, after;
    };

  private:
    std::filesystem::path begin(const std::string& entry, bool stay);
    void add_tasks(const std::string& entry, bool stay, const std::map<std::string, std::string>& pixels,
                   std::vector<Task>& tasks) const;
    std::filesystem::path folder_of(const std::string& entry) const { return references_ / entry; }
    std::filesystem::path staged(const std::string& entry) const;

    std::filesystem::path baselines_, references_, staging_;
    bool force_;
    std::unique_ptr<output::Journal> journal_;  // locked as long as this program lives
    std::map<std::string, bool> entries_;       // whether the old files stay
};

}  // namespace beamcam::scenes
