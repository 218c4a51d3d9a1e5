// The result of a regression test as text and as a JUnit report.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "output/json/tree.hpp"
#include "render/draw/markup.hpp"
#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

std::string frame_files(const FrameResult& frame) {
    std::string text =
        fmt::format("    expected    {}\n", frame.expected.empty() ? "no reference picture" : frame.expected.string());
    text += fmt::format("    actual      {}sha256 {}\n", frame.actual.empty() ? "" : frame.actual.string() + "  ",
                        frame.sha256);
    const std::string difference = !frame.difference.empty() ? frame.difference.string()
                                   : frame.expected.empty()  ? "none without a reference picture"
                                                             : "(--report DIR draws it)";
    return text + fmt::format("    difference  {}\n", difference);
}

// The test case of a picture or of a motion. `seconds`: the time of the entry, which its first case gets.
std::string junit_case(const std::string& suite, const EntryResult& entry, const char* part,
                       const std::optional<Verdict>& verdict, const std::vector<std::string>& lines, double seconds,
                       const PassRule& rule) {
    if (!verdict) return {};
    std::string out = fmt::format("  <testcase classname=\"{}.{}\" name=\"{}\" time=\"{:.3f}\"", escaped_for_xml(suite),
                                  escaped_for_xml(entry.name), part, seconds);
    if (rule.passes(*verdict)) return out + "/>\n";
    const std::string message =
        escaped_for_xml(fmt::format("{}{}{}", name(*verdict), lines.empty() ? "" : ": ", fmt::join(lines, "; ")));
    return out + fmt::format(">\n    <{2} type=\"{0}\" message=\"{1}\">{1}</{2}>\n  </testcase>\n", name(*verdict),
                             message, entry.could_not_run() ? "error" : "failure");
}

}  // namespace

std::string escaped_for_xml(std::string_view text) {
    std::string out = render::xml(text);
    replace_all(out, "\"", "&quot;");
    std::erase_if(out, [](unsigned char c) { return c < 0x20 && c != '\n'; });
    return out;
}

std::string describe(const char* part, const std::optional<Verdict>& verdict, const std::vector<std::string>& lines) {
    if (!verdict) return {};
    return fmt::format("{} {}{}{}", part, name(*verdict), lines.empty() ? "" : ": ", fmt::join(lines, "; "));
}

std::string describe(const EntryResult& entry, const char* separator) {
    const std::string picture = describe("picture", entry.picture, entry.picture_lines);
    const std::string motion = describe("motion", entry.motion, entry.motion_lines);
    return picture + (picture.empty() || motion.empty() ? "" : separator) + motion;
}

std::string to_text(const RegressionResult& result) {
    std::size_t width = 0;
    for (const EntryResult& entry : result.entries) width = std::max(width, entry.name.size());
    std::string text;
    for (const EntryResult& entry : result.entries) {
        text += fmt::format("{:<10}  {:<{}}  {}\n", name(entry.verdict()), entry.name, width, describe(entry, " | "));
        if (const ChangedFrames changed = entry.changed_frames();
            !changed.empty() && entry.picture != Verdict::equivalent)
            text += frame_files(*changed.front().second);
        for (const std::filesystem::path& file : entry.written)
            text += fmt::format("    wrote       {}\n", file.string());
        for (const std::filesystem::path& file : entry.removed)
            text += fmt::format("    removed     {}\n", file.string());
    }
    return text;
}

std::string to_junit(const RegressionResult& result, const std::string& suite, const PassRule& rule) {
    std::string cases;
    std::size_t tests = 0, failures = 0, errors = 0;
    for (const EntryResult& entry : result.entries) {
        for (const auto& verdict : {entry.picture, entry.motion}) {
            tests += verdict ? 1 : 0;
            if (verdict && !rule.passes(*verdict)) ++(entry.could_not_run() ? errors : failures);
        }
        cases += junit_case(suite, entry, "picture", entry.picture, entry.picture_lines, entry.seconds, rule);
        cases += junit_case(suite, entry, "motion", entry.motion, entry.motion_lines, entry.picture ? 0 : entry.seconds,
                            rule);
    }
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"0\" "
        "time=\"{:.3f}\">\n{}</testsuite>\n",
        escaped_for_xml(suite), tests, failures, errors, result.seconds, cases);
}

}  // namespace beamcam::scenes
