// The HTML page of a regression test: a table of all entries, and the pictures of those that changed.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "output/files/atomic_file.hpp"
#include "scenes/regression/entry_pictures.hpp"
#include "scenes/regression/report.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Radio buttons choose the visible view of a picture and the listed entries, by rules of this style sheet. Without it
// the browser shows everything, one item below the other.
constexpr std::string_view kStyle = R"(:root {
  color-scheme: light dark;
  --ink: #1b1f24; --soft: #5b6570; --line: #d8dce2; --paper: #fff; --good: #0a7d55; --near: #8a5a00; --bad: #b3400a;
}
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8eaee; --soft: #9aa3ad; --line: #3a4048; --paper: #16191d; --good: #3fc796; --near: #e2b23c; --bad: #ff8a4c; }
}
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); max-width: 76rem; margin: 2rem auto; padding: 0 1.2rem; }
h1 { font-size: 1.4rem; margin: 0; }
h2 { font-size: 1.1rem; margin: 0; }
p { margin: .3rem 0; }
code { font-size: .88em; word-break: break-all; }
table { border-collapse: collapse; width: 100%; margin: 1.2rem 0; }
td, th { text-align: left; padding: .35rem .7rem; border-bottom: 1px solid var(--line); vertical-align: top; }
section { border-top: 2px solid var(--line); padding: 1rem 0 1.6rem; }
.soft { color: var(--soft); }
.identical { color: var(--good); }
.equivalent { color: var(--near); }
.different, .missing, .not-run { color: var(--bad); font-weight: 600; }
input[type=radio] { position: absolute; opacity: 0; }
label { display: inline-block; margin: .6rem .3rem .4rem 0; padding: .1rem .7rem; border: 1px solid var(--line); border-radius: 1rem; cursor: pointer; }
input:checked + label { background: var(--ink); color: var(--paper); }
input:focus-visible + label { outline: 2px solid #0072b2; outline-offset: 2px; }
#show-changed:checked ~ main .unchanged, #show-failed:checked ~ main .passes { display: none; }
figure { margin: 0; }
figcaption { color: var(--soft); font-size: .88rem; padding: .2rem 0; }
.views { position: relative; }
.views figure { display: none; }
.views .pick-actual:checked ~ .actual, .views .pick-expected:checked ~ .expected,
.views .pick-blink:checked ~ .blink, .views .pick-difference:checked ~ .difference { display: block; }
.views img { display: block; max-width: 100%; border: 1px solid var(--line); }
.blink div { position: relative; }
.blink img + img { position: absolute; inset: 0; animation: blink 1.2s steps(1) infinite; }
@keyframes blink { 50% { opacity: 0; } }
)";

struct Pane {
    const char *kind, *caption;
};
constexpr Pane kActual = {"actual", "the picture of this test"};
constexpr Pane kExpected = {"expected", "the reference picture"};
constexpr Pane kBlink = {"blink", "expected and actual picture in turn"};
constexpr Pane kDifference = {"difference", "changed pixels vermilion, a blue frame around them"};

std::string image(const std::string& entry, long frame, const char* kind) {
    return fmt::format("<img alt=\"{}\" src=\"{}\">", kind, report_picture(entry, frame, kind).string());
}

std::string frame_html(const EntryResult& entry, long number, const FrameResult& frame) {
    if (frame.actual.empty()) return {};
    std::vector<Pane> views = {kActual};
    if (frame.compared) views = {kActual, kExpected, kBlink};
    if (!frame.difference.empty()) views.push_back(kDifference);
    std::string choices, figures;
    for (const Pane& view : views) {
        choices += fmt::format(
            "<input type=\"radio\" class=\"pick-{0}\" name=\"{1}-{2}\" id=\"{1}-{2}-{0}\"{3}>"
            "<label for=\"{1}-{2}-{0}\">{0}</label>\n",
            view.kind, entry.name, number, view.kind == kActual.kind ? " checked" : "");
        const std::string pictures = view.kind == kBlink.kind ? "<div>" + image(entry.name, number, "expected") +
                                                                    image(entry.name, number, "actual") + "</div>"
                                                              : image(entry.name, number, view.kind);
        figures += fmt::format("<figure class=\"{}\">{}<figcaption>{}: {}</figcaption></figure>\n", view.kind, pictures,
                               view.kind, view.caption);
    }
    const std::string title = entry.frames.size() > 1 ? fmt::format("<p>picture {}</p>\n", number) : "";
    return fmt::format("{}<div class=\"views\">\n{}{}</div>\n", title, choices, figures);
}

constexpr std::size_t kMostShown = 4;  // pictures of an entry

std::string section_html(const EntryResult& entry, const char* classes) {
    std::string out = fmt::format("<section id=\"{0}\" class=\"{1}\"><h2>{0} <span class=\"{2}\">{2}</span></h2>\n",
                                  escaped_for_xml(entry.name), classes, name(entry.verdict()));
    for (const std::string& line : {describe("picture", entry.picture, entry.picture_lines),
                                    describe("motion", entry.motion, entry.motion_lines)})
        if (!line.empty()) out += fmt::format("<p>{}</p>\n", escaped_for_xml(line));
    const ChangedFrames frames = entry.changed_frames();
    for (const auto& [number, frame] : std::span(frames).first(std::min(frames.size(), kMostShown)))
        out += frame_html(entry, number, *frame);
    return out + "</section>\n";
}

std::string cell(const std::optional<Verdict>& verdict) {
    return fmt::format("<td class=\"{}\">{}</td>", verdict ? name(*verdict) : "soft", verdict ? name(*verdict) : "–");
}

std::string to_html(const RegressionResult& result, const std::string& title, const PassRule& rule) {
    std::string rows, sections;
    for (const EntryResult& entry : result.entries) {
        const bool changed = entry.verdict() != Verdict::identical;
        const char* classes = !changed ? "unchanged passes" : rule.passes(entry) ? "passes" : "";
        const std::string own_name = escaped_for_xml(entry.name);
        rows += fmt::format("<tr class=\"{}\"><td>{}</td>{}{}<td>{}</td><td>{:.2f}</td></tr>\n", classes,
                            changed ? fmt::format("<a href=\"#{0}\">{0}</a>", own_name) : own_name, cell(entry.picture),
                            cell(entry.motion), entry.frames.size(), entry.seconds);
        if (changed) sections += section_html(entry, classes);
    }
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
        "<title>{0}</title><link rel=\"stylesheet\" href=\"report.css\"></head><body>\n<h1>{0}</h1>\n"
        "<p class=\"soft\">{1}, {2}, {3}</p>\n"
        "<input type=\"radio\" name=\"show\" id=\"show-all\" checked><label for=\"show-all\">all</label>\n"
        "<input type=\"radio\" name=\"show\" id=\"show-changed\"><label for=\"show-changed\">not identical</label>\n"
        "<input type=\"radio\" name=\"show\" id=\"show-failed\"><label for=\"show-failed\">failed</label>\n"
        "<main>\n<table><thead><tr><th>entry</th><th>picture</th><th>motion</th><th>pictures</th><th>seconds</th></tr>"
        "</thead><tbody>\n{4}</tbody></table>\n{5}</main></body></html>\n",
        escaped_for_xml(title), counted(result.entries.size(), "entry"), counted(result.simulations, "simulation"),
        counted(result.pictures, "picture"), rows, sections);
}

}  // namespace

void write_page(const fs::path& folder, const RegressionResult& result, const std::string& title, const PassRule& rule,
                output::FileList& file_list) {
    const auto write = [&](const char* name, const std::string& text) {
        output::FileTarget target = file_list.target(folder / name);
        target.within = folder;
        output::write_file(target, text);
    };
    write("report.css", std::string(kStyle));
    write("index.html", to_html(result, title, rule));
}

}  // namespace beamcam::scenes
