// What a regression test found, in lines for people.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

std::string short_digest(const std::string& digest) { return digest.empty() ? "none" : digest.substr(0, 16) + "…"; }

std::string where_to_look(const FrameResult& frame) {
    std::string text =
        fmt::format("    expected    {}\n", frame.expected.empty() ? "no reference picture" : frame.expected.string());
    text += fmt::format("    actual      {}sha256 {}\n", frame.actual.empty() ? "" : frame.actual.string() + "  ",
                        frame.sha256);
    const std::string difference = !frame.difference.empty() ? frame.difference.string()
                                   : frame.expected.empty()  ? "none without a reference picture"
                                                             : "(--report DIR draws it)";
    return text + fmt::format("    difference  {}\n", difference);
}

}  // namespace

std::string in_words(const char* what, const std::optional<Verdict>& verdict, const std::vector<std::string>& lines) {
    if (!verdict) return {};
    return fmt::format("{} {}{}{}", what, name(*verdict), lines.empty() ? "" : ": ", fmt::join(lines, "; "));
}

std::string in_words(const EntryResult& entry, const char* between) {
    const std::string picture = in_words("picture", entry.picture, entry.picture_lines);
    const std::string motion = in_words("motion", entry.motion, entry.motion_lines);
    return picture + (picture.empty() || motion.empty() ? "" : between) + motion;
}

std::string to_text(const RegressionResult& result, const PassRule& rule, bool failures_only) {
    std::size_t width = 0;
    for (const EntryResult& entry : result.entries) width = std::max(width, entry.name.size());
    std::string text;
    for (const EntryResult& entry : result.entries) {
        if (failures_only && !entry.updated && rule.passes(entry)) continue;
        text += fmt::format("{:<10}  {:<{}}  {}\n", name(entry.verdict()), entry.name, width, in_words(entry, " | "));
        const auto* worst = entry.worst();
        if (worst && entry.picture != Verdict::equivalent) text += where_to_look(worst->second);
        if (entry.updated)
            text += entry.new_digest.empty()
                        ? "    updated\n"
                        : fmt::format("    updated     sha256 {} → {}\n", short_digest(entry.old_digest),
                                      short_digest(entry.new_digest));
        if (entry.digest_added) text += fmt::format("    accepted    sha256 {} too\n", short_digest(entry.new_digest));
    }
    return text;
}

}  // namespace beamcam::scenes
