// What a regression test found, as continuous integration wants it: JUnit, GitHub's annotations and step summaries.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/regression/markup.hpp"
#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

// The case of a picture or of a motion. `seconds`: of the entry, which its first case is charged with.
std::string junit_case(const std::string& suite, const EntryResult& entry, const char* what,
                       const std::optional<Verdict>& verdict, const std::vector<std::string>& lines, double seconds,
                       const PassRule& rule) {
    if (!verdict) return {};
    std::string out = fmt::format("  <testcase classname=\"{}.{}\" name=\"{}\" time=\"{:.3f}\"", escaped_for_xml(suite),
                                  escaped_for_xml(entry.name), what, seconds);
    if (rule.passes(*verdict)) return out + "/>\n";
    const std::string words =
        escaped_for_xml(fmt::format("{}{}{}", name(*verdict), lines.empty() ? "" : ": ", fmt::join(lines, "; ")));
    return out + fmt::format(">\n    <failure type=\"{0}\" message=\"{1}\">{1}</failure>\n  </testcase>\n",
                             name(*verdict), words);
}

// Of a workflow command of GitHub Actions, which ends with the line; its properties end with "," and "::".
std::string escaped_for_annotation(std::string_view text, std::string_view ends = {}) {
    std::string out;
    for (const char c : text) {
        if (c == '%' || c == '\n' || ends.find(c) != std::string_view::npos)
            out += fmt::format("%{:02X}", static_cast<unsigned>(c));
        else if (static_cast<unsigned char>(c) >= 0x20)
            out.push_back(c);
    }
    return out;
}

std::string escaped_for_table(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '|' || c == '\\' || c == '`' || c == '*' || c == '_' || c == '<') out.push_back('\\');
        out.push_back(c == '\n' ? ' ' : c);
    }
    return out;
}

}  // namespace

std::string to_junit(const RegressionResult& result, const std::string& suite, const PassRule& rule) {
    std::string cases;
    std::size_t tests = 0, failures = 0;
    for (const EntryResult& entry : result.entries) {
        for (const auto& verdict : {entry.picture, entry.motion}) {
            tests += verdict ? 1 : 0;
            failures += verdict && !rule.passes(*verdict) ? 1 : 0;
        }
        cases += junit_case(suite, entry, "picture", entry.picture, entry.picture_lines, entry.seconds, rule);
        cases += junit_case(suite, entry, "motion", entry.motion, entry.motion_lines, entry.picture ? 0 : entry.seconds,
                            rule);
    }
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\" "
        "time=\"{:.3f}\">\n{}</testsuite>\n",
        escaped_for_xml(suite), tests, failures, result.seconds, cases);
}

std::string to_annotations(const RegressionResult& result, const PassRule& rule) {
    std::string text;
    for (const EntryResult& entry : result.entries)
        if (!rule.passes(entry))
            text += fmt::format("::error file={},title={}: {}::{}\n", escaped_for_annotation(result.baselines, ",:"),
                                entry.name, name(entry.verdict()), escaped_for_annotation(in_words(entry, "\n")));
    return text;
}

std::string to_markdown(const RegressionResult& result, const std::string& title, const PassRule& rule) {
    std::string text = fmt::format("### {}\n\n", escaped_for_table(title)), rows;
    std::size_t identical = 0;
    for (const EntryResult& entry : result.entries) {
        if (entry.verdict() == Verdict::identical) {
            ++identical;
            continue;
        }
        rows +=
            fmt::format("| {} | {} | {} | {} |\n", rule.passes(entry) ? "passes" : "**fails**",
                        escaped_for_table(entry.name), name(entry.verdict()), escaped_for_table(in_words(entry, "; ")));
    }
    text += fmt::format("{} of {} entries identical, {:.1f} s\n\n", identical, result.entries.size(), result.seconds);
    return rows.empty() ? text : text + "| | entry | verdict | what changed |\n|---|---|---|---|\n" + rows + "\n";
}

}  // namespace beamcam::scenes
