// The result of a regression test as text, as JSON, as an HTML page, and for continuous integration.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "output/data/file_list.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// Text for XML and HTML. Removes control characters, which XML does not allow.
std::string escaped_for_xml(std::string_view text);
// "picture different: 12 of 129600 pixels …"; empty without a verdict.
std::string describe(const char* part, const std::optional<Verdict>& verdict, const std::vector<std::string>& lines);
// Picture and motion of the entry.
std::string describe(const EntryResult& entry, const char* separator);

std::string to_text(const RegressionResult& result);
std::string to_json(const RegressionResult& result);
// A test case for each picture and each motion.
std::string to_junit(const RegressionResult& result, const std::string& suite, const PassRule& rule);
// Writes index.html and report.css into a folder that contains the pictures
// (RegressionOptions::report). The page works without scripts and inline styles, so that a strict content security
// policy allows it.
void write_page(const std::filesystem::path& folder, const RegressionResult& result, const std::string& title,
                const PassRule& rule, output::FileList& file_list);

}  // namespace beamcam::scenes
