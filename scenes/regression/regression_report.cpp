// What a regression test found, as text, JUnit and one HTML page. JSON: report_json.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "output/files/atomic_file.hpp"
#include "scenes/regression/regression.hpp"

namespace beamcam::scenes {
namespace {

std::string part(const char* what, const std::optional<Verdict>& verdict, const std::vector<std::string>& lines) {
    if (!verdict) return {};
    return fmt::format("{} {}{}{}", what, name(*verdict), lines.empty() ? "" : ": ", fmt::join(lines, "; "));
}

std::string both_parts(const EntryResult& entry) {
    const std::string picture = part("picture", entry.picture, entry.picture_lines);
    const std::string motion = part("motion", entry.motion, entry.motion_lines);
    return picture + (picture.empty() || motion.empty() ? "" : " | ") + motion;
}

std::string short_digest(const std::string& digest) { return digest.empty() ? "none" : digest.substr(0, 16) + "…"; }

// ---- markup ------------------------------------------------------------------------------------------

std::string escaped_for_xml(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n')
            out.push_back(c);
    }
    return out;
}

std::string base64(std::string_view bytes) {
    static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k) out.push_back(k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=');
    }
    return out;
}

std::string image_source(const std::filesystem::path& file) {
    return file.empty() ? std::string() : "data:image/png;base64," + base64(output::read_file(file));
}

constexpr std::string_view kStyle = R"(
:root{color-scheme:light dark;--ink:#1b1f24;--soft:#667;--line:#d8dce2;--paper:#fff;--good:#0a7d55;--near:#946200;--bad:#b3400a}
@media (prefers-color-scheme:dark){:root{--ink:#e8eaee;--soft:#9aa3ad;--line:#3a4048;--paper:#16191d;--good:#3fc796;--near:#e2b23c;--bad:#ff8a4c}}
body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:76rem;margin:2rem auto;padding:0 1.2rem}
h1{font-size:1.4rem;margin:0}h2{font-size:1.1rem;margin:0}p{margin:.3rem 0}.soft{color:var(--soft)}
table{border-collapse:collapse;width:100%;margin:1.2rem 0}td,th{text-align:left;padding:.35rem .7rem;border-bottom:1px solid var(--line);vertical-align:top}
section{border-top:2px solid var(--line);padding:1rem 0 1.6rem}
.identical{color:var(--good)}.equivalent,.new-renderer{color:var(--near)}.different,.missing{color:var(--bad);font-weight:600}
.views{display:grid;grid-template-columns:repeat(auto-fit,minmax(22rem,1fr));gap:1.2rem;margin-top:.8rem}
figure{margin:0}figcaption{color:var(--soft);font-size:.88rem;padding:.2rem 0}
.slider{position:relative;line-height:0;border:1px solid var(--line)}.slider img{width:100%;display:block}
.slider img+img{position:absolute;inset:0;clip-path:inset(0 0 0 var(--cut,50%))}
.slider::after{content:"";position:absolute;top:0;bottom:0;left:var(--cut,50%);width:2px;margin-left:-1px;background:#0072b2;pointer-events:none}
input[type=range]{width:100%;margin:.2rem 0;accent-color:#0072b2}
.plain img{width:100%;display:block;border:1px solid var(--line)}code{font-size:.88em;word-break:break-all})";

std::string frame_html(const EntryResult& entry, long number, const FrameResult& frame) {
    std::string out;
    if (entry.frames.size() > 1) out += fmt::format("<p>picture {}</p>\n", number);
    out += "<div class=\"views\">\n";
    if (!frame.expected.empty() && !frame.actual.empty())
        out += fmt::format(
            "<figure><div class=\"slider\"><img alt=\"expected\" src=\"{}\"><img alt=\"actual\" src=\"{}\"></div>\n"
            "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"boundary between expected and "
            "actual\" "
            "oninput=\"this.previousElementSibling.style.setProperty('--cut',this.value+'%')\">\n"
            "<figcaption>left of the line: expected; right: actual</figcaption></figure>\n",
            image_source(frame.expected), image_source(frame.actual));
    else if (!frame.actual.empty())
        out += fmt::format(
            "<figure class=\"plain\"><img alt=\"actual\" src=\"{}\"><figcaption>actual; there is no "
            "reference</figcaption></figure>\n",
            image_source(frame.actual));
    if (!frame.difference.empty())
        out += fmt::format(
            "<figure class=\"plain\"><img alt=\"difference\" src=\"{}\"><figcaption>difference: vermilion "
            "changed, yellow antialiasing, blue frame around all of it</figcaption></figure>\n",
            image_source(frame.difference));
    return out + "</div>\n";
}

// The pictures that changed most.
std::vector<std::pair<long, const FrameResult*>> worst_frames(const EntryResult& entry) {
    constexpr std::size_t kMost = 4;
    std::vector<std::pair<long, const FrameResult*>> frames;
    for (const auto& [number, frame] : entry.frames)
        if (frame.verdict != Verdict::identical) frames.emplace_back(number, &frame);
    std::stable_sort(frames.begin(), frames.end(),
                     [](const auto& a, const auto& b) { return a.second->weight() > b.second->weight(); });
    if (frames.size() > kMost) frames.resize(kMost);
    return frames;
}

std::string entry_html(const EntryResult& entry) {
    std::string out = fmt::format("<section id=\"{0}\"><h2>{0} <span class=\"{1}\">{1}</span></h2>\n",
                                  escaped_for_xml(entry.name), name(entry.verdict()));
    for (const std::string& line :
         {part("picture", entry.picture, entry.picture_lines), part("motion", entry.motion, entry.motion_lines)})
        if (!line.empty()) out += fmt::format("<p>{}</p>\n", escaped_for_xml(line));
    if (!entry.new_digest.empty())
        out += fmt::format("<p class=\"soft\">expected <code>{}</code><br>actual <code>{}</code></p>\n",
                           entry.old_digest.empty() ? "none" : entry.old_digest, entry.new_digest);
    for (const auto& [number, frame] : worst_frames(entry)) out += frame_html(entry, number, *frame);
    return out + "</section>\n";
}

std::string junit_case(const std::string& suite, const std::string& test, const char* what,
                       const std::optional<Verdict>& verdict, const std::vector<std::string>& lines,
                       const PassRule& rule) {
    if (!verdict) return {};
    std::string out = fmt::format("  <testcase classname=\"{}\" name=\"{}: {}\"", escaped_for_xml(suite),
                                  escaped_for_xml(test), what);
    if (rule.passes(*verdict)) return out + "/>\n";
    const std::string words =
        escaped_for_xml(fmt::format("{}{}{}", name(*verdict), lines.empty() ? "" : ": ", fmt::join(lines, "; ")));
    return out + fmt::format(">\n    <failure type=\"{0}\" message=\"{1}\">{1}</failure>\n  </testcase>\n",
                             name(*verdict), words);
}

}  // namespace

std::string to_text(const RegressionResult& result, const PassRule& rule, bool failures_only) {
    std::size_t width = 0;
    for (const EntryResult& entry : result.entries) width = std::max(width, entry.name.size());
    std::string text;
    for (const EntryResult& entry : result.entries) {
        if (failures_only && !entry.updated && rule.passes(entry.verdict())) continue;
        text += fmt::format("{:<10}  {:<{}}  {}\n", name(entry.verdict()), entry.name, width, both_parts(entry));
        const auto* worst = entry.worst();
        if (worst && entry.picture != Verdict::equivalent) {
            const FrameResult& frame = worst->second;
            text += fmt::format("    expected    {}\n",
                                frame.expected.empty() ? "no reference picture" : frame.expected.string());
            text += fmt::format("    actual      {}sha256 {}\n",
                                frame.actual.empty() ? "" : frame.actual.string() + "  ", frame.sha256);
            text += fmt::format("    difference  {}\n", !frame.difference.empty() ? frame.difference.string()
                                                        : frame.expected.empty()  ? "none without a reference picture"
                                                                                  : "(--report DIR draws it)");
        }
        if (entry.updated)
            text += entry.new_digest.empty()
                        ? "    updated\n"
                        : fmt::format("    updated     sha256 {} → {}\n", short_digest(entry.old_digest),
                                      short_digest(entry.new_digest));
        if (entry.digest_added) text += fmt::format("    accepted    sha256 {} too\n", short_digest(entry.new_digest));
    }
    return text;
}

std::string to_junit(const RegressionResult& result, const std::string& suite, const PassRule& rule) {
    std::string cases;
    std::size_t tests = 0, failures = 0;
    for (const EntryResult& entry : result.entries) {
        for (const auto& verdict : {entry.picture, entry.motion}) {
            tests += verdict ? 1 : 0;
            failures += verdict && !rule.passes(*verdict) ? 1 : 0;
        }
        cases += junit_case(suite, entry.name, "picture", entry.picture, entry.picture_lines, rule);
        cases += junit_case(suite, entry.name, "motion", entry.motion, entry.motion_lines, rule);
    }
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\" "
        "time=\"{:.3f}\">\n{}</testsuite>\n",
        escaped_for_xml(suite), tests, failures, result.seconds, cases);
}

std::string to_html(const RegressionResult& result, const std::string& title) {
    std::string rows, sections;
    for (const EntryResult& entry : result.entries) {
        const bool shown = entry.verdict() != Verdict::identical;
        const std::string own_name = escaped_for_xml(entry.name);
        rows += fmt::format("<tr><td>{}</td><td class=\"{}\">{}</td><td class=\"{}\">{}</td><td>{}</td></tr>\n",
                            shown ? fmt::format("<a href=\"#{0}\">{0}</a>", own_name) : own_name,
                            entry.picture ? name(*entry.picture) : "soft", entry.picture ? name(*entry.picture) : "–",
                            entry.motion ? name(*entry.motion) : "soft", entry.motion ? name(*entry.motion) : "–",
                            entry.frames.size());
        if (shown) sections += entry_html(entry);
    }
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
        "<title>{0}</title><style>{1}</style></head><body>\n<h1>{0}</h1>\n"
        "<p class=\"soft\">{2} entries, {3} simulations, {4} pictures</p>\n"
        "<table><thead><tr><th>entry</th><th>picture</th><th>motion</th><th>pictures</th></tr></thead><tbody>\n{5}</"
        "tbody></table>\n"
        "{6}</body></html>\n",
        escaped_for_xml(title), kStyle, result.entries.size(), result.simulations, result.pictures, rows, sections);
}

}  // namespace beamcam::scenes
