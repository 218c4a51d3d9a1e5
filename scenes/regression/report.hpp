// How the result of a regression test is told: to people, to programs and to continuous integration.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "output/data/manifest.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// "picture different: 12 of 129600 pixels …"; empty without a verdict.
std::string in_words(const char* what, const std::optional<Verdict>& verdict, const std::vector<std::string>& lines);
// Of its picture and its motion.
std::string in_words(const EntryResult& entry, const char* between);

// `failures_only`: entries that pass are left out.
std::string to_text(const RegressionResult& result, const PassRule& rule, bool failures_only);
std::string to_json(const RegressionResult& result);
// A test case for each picture and each motion.
std::string to_junit(const RegressionResult& result, const std::string& suite, const PassRule& rule);
// Workflow commands of GitHub Actions, one for each entry that fails: they are shown beside the change.
std::string to_annotations(const RegressionResult& result, const PassRule& rule);
// A table in Markdown, for the summary of a step.
std::string to_markdown(const RegressionResult& result, const std::string& title, const PassRule& rule);

inline constexpr const char* kReportFile = "report.json";

// Writes a page about the entries into a folder that holds their pictures already (RegressionOptions::report):
// index.html, report.css and report.json, which `beamcam accept` reads. The page works without scripts and without
// anything inline, as servers with a strict content policy demand.
void write_page(const std::filesystem::path& folder, const RegressionResult& result, const std::string& title,
                const PassRule& rule, output::Manifest& manifest);

// ---- read again -----------------------------------------------------------------------------------

// What the report says of one entry.
struct ReportedEntry {
    std::string renderer;
    std::vector<std::string> sha256;                  // of all its pictures; empty: it has none, or they are identical
    std::vector<long> changed;                        // their numbers
    bool differs = false;                             // its pictures or its motion: digests alone will not do
    std::map<std::string, std::string> motion_files;  // SHA-256 by name; empty: it has none, or nothing moved
    std::optional<double> reproducible_until;         // [s]
    std::string not_reproducible;                     // why its pictures are not to be accepted
    std::string words;                                // why
};

struct Report {
    std::filesystem::path folder;
    std::string baselines;
    std::map<std::string, ReportedEntry> entries;  // those that are not identical
    std::map<std::string, RendererParts> renderers;
};

// From the folder that `write_page` wrote to, or one that holds only that. Throws IoError.
Report read_report(const std::filesystem::path& folder);

}  // namespace beamcam::scenes
