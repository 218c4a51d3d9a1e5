// The records of the files that beamcam made, as the manifest (manifest.hpp) and journals (journal.hpp) contain them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace beamcam::output {

// The inputs of a file.
struct Origin {
    std::string inputs;          // digest: files with equal inputs are equal. Empty: unknown
    std::string version, scene;  // of the program; JSON text, if the file itself cannot contain it
    bool operator==(const Origin&) const = default;
};

// The record of a file that beamcam made.
struct FileRecord {
    std::string sha256;
    std::uintmax_t size = 0;  // [bytes]
    Origin origin;
    std::string stamp;  // inode and time of the unchanged file, so that it need not be read; empty: unknown
    bool operator==(const FileRecord&) const = default;
};
using FileRecords = std::map<std::string, FileRecord>;  // by file name, without directory

std::string manifest_json(const FileRecords& files);
// Nothing if the text is not a manifest.
std::optional<FileRecords> parse_manifest(const std::string& text);
// Why it is not: "line 3: a value is missing"; empty: it is.
std::string damage_of_manifest(const std::string& text);

// Lines of a journal: a temporary file that will be created, and a file that will be moved to its place.
std::string journal_line(const std::string& temporary);
std::string journal_line(const std::string& name, const FileRecord& made);
struct JournalLines {
    std::vector<std::string> temporaries;
    std::vector<std::pair<std::string, FileRecord>> placed;  // by file name, in the order of the text
};
// Skips lines that are cut off.
JournalLines parse_journal(const std::string& text);

}  // namespace beamcam::output
