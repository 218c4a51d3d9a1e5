// Impacts, collisions and the summary of a run as JSON and CSV, with the names that scripts use; and the text of the
// manifest. Keys have a fixed order; numbers have enough digits to read the same bits back; undefined values are null,
// in CSV an empty cell.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "output/data/agreement.hpp"
#include "output/files/errors.hpp"
#include "output/files/target.hpp"
#include "output/files/work.hpp"
#include "sim/beam/modes.hpp"
#include "sim/observe/channels.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/simulate.hpp"
#include "sim/studies/accuracy.hpp"
#include "sim/studies/stress.hpp"

namespace beamcam::output {

std::string impacts_json(const sim::Result& result);  // {"impacts": […], "collisions": […]}
std::string impacts_csv(const sim::Result& result);   // the impacts alone

// The ending decides: .json or .csv. Throws UnsupportedOption for others, IoError.
void write_impacts(const Target& file, const sim::Result& result);

// `extrema`: the channels of Request::extrema, in the order of result.extrema. "units" lists all channels of the
// problem.
std::string summary_json(const sim::Problem& problem, const sim::Result& result,
                         const std::vector<sim::Channel>& extrema, const Work* work = nullptr,
                         const std::vector<Agreement>& data = {});

// {"modes": [{"omega", "hz", "shape": [[x, y], …]}, …]}; omega and hz are null for a diverging mode.
std::string modes_json(const std::vector<sim::Mode>& modes);

// Every row of the assessment, its conditions and the recommendation.
std::string accuracy_json(const sim::Accuracy& accuracy);

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

// {"plates": […], "cases": [{"plate", "row", "column", "variant", "outcome", "closure", "steps_per_second", …}, …]}
std::string stress_json(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results);

std::string manifest_json(const FileRecords& files);
// Nothing if the text is not a manifest.
std::optional<FileRecords> parse_manifest(const std::string& text);

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
