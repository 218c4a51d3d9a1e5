// How the result of a regression test is told: to people, to programs and to continuous integration.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "output/data/manifest.hpp"
#include "scenes/regression/regression.hpp"

namespace beamcam::scenes {

// "picture different: 12 of 129600 pixels …"; empty without a verdict.
std::string in_words(const char* what, const std::optional<Verdict>& verdict, const std::vector<std::string>& lines);

// `failures_only`: entries that pass are left out.
std::string to_text(const RegressionResult& result, const PassRule& rule, bool failures_only);
std::string to_json(const RegressionResult& result);
// A test case for each picture and each motion.
std::string to_junit(const RegressionResult& result, const std::string& suite, const PassRule& rule);
// Workflow commands of GitHub Actions, one for each entry that fails: they are shown beside the change.
std::string to_annotations(const RegressionResult& result, const PassRule& rule);
// A table in Markdown, for the summary of a step.
std::string to_markdown(const RegressionResult& result, const std::string& title, const PassRule& rule);

// Writes a page about the entries into a folder that holds their pictures already (RegressionOptions::report):
// index.html, report.css and report.json, which `beamcam accept` reads. The page works without scripts and without
// anything inline, as servers with a strict content policy demand.
void write_page(const std::filesystem::path& folder, const RegressionResult& result, const std::string& title,
                const PassRule& rule, output::Manifest& manifest);

}  // namespace beamcam::scenes
