// The folders of reference pictures and motions, one for each entry of a file of baselines, and their update.
//
// A folder belongs to beamcam if it contains the marker `.beamcam-reference`. The marker lists the files that an update
// may replace or remove if they are unchanged. An update touches no other file in the folder.
//
// An update is atomic: the new files are collected in `.beamcam-update` beside the folders, then a list of tasks is
// written, then the tasks are carried out. If the program is killed before the list exists, the next run removes the
// collection; afterwards the next run completes the update.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenes/regression/update_tasks.hpp"

namespace beamcam::scenes {

struct ReferenceFile {
    std::string sha256;  // of its bytes
    std::string pixels;  // SHA-256 of the decoded pixels; empty: the file is no picture
};
using ReferenceFiles = std::map<std::string, ReferenceFile>;  // by file name

// The files that the marker of a folder lists; none if there is no marker. Throws IoError.
ReferenceFiles marked_files(const std::filesystem::path& folder);

class ReferenceUpdate {
  public:
    // Completes or undoes an update that was killed. Returns a message; empty: there was none.
    static std::string recover(const std::filesystem::path& references);

    // Nothing is written before the first `begin`, `replace` or `extend`. `force`: existing files of the same names may
    // be replaced, whoever made them.
    ReferenceUpdate(std::filesystem::path baselines, std::filesystem::path references, bool force);
    ~ReferenceUpdate();  // undoes an update that is not committed
    ReferenceUpdate(const ReferenceUpdate&) = delete;
    ReferenceUpdate& operator=(const ReferenceUpdate&) = delete;

    // Creates the folder of the update. Throws IoError if another update is in progress.
    void begin();
    // After `begin`: a directory for the pictures and motions of a test; removed with this.
    std::filesystem::path tested() const;
    // Throws WouldOverwrite if the entry's folder does not belong to beamcam or contains changed files.
    void require_replaceable(const std::string& entry) const;
    // The directory for the new files of an entry, which replace all its files. Throws what `begin` and
    // `require_replaceable` throw.
    std::filesystem::path replace(const std::string& entry);
    // The same for files that are added to the entry's files or replace those of the same names.
    std::filesystem::path extend(const std::string& entry);
    // Carries out the update and replaces the text of the baselines file, which must still be `expected`. `pixels`:
    // digests of the new pictures of each entry by file name. False: the text and all files are as before.
    bool commit(const std::string& expected, const std::string& text,
                const std::map<std::string, std::map<std::string, std::string>>& pixels);

  private:
    std::filesystem::path open(const std::string& entry, bool keeps_others);
    void add_tasks(const std::string& entry, bool keeps_others, const std::map<std::string, std::string>& pixels,
                   std::vector<UpdateTask>& tasks) const;
    std::filesystem::path folder_of(const std::string& entry) const { return references_ / entry; }
    std::filesystem::path staged(const std::string& entry) const;

    std::filesystem::path baselines_, references_, staging_;
    bool force_;
    std::unique_ptr<output::Journal> journal_;  // locked as long as this program lives; null: not started
    std::map<std::string, bool> entries_;       // whether the entry's other files are kept
};

}  // namespace beamcam::scenes
