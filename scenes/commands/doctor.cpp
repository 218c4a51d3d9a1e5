// `beamcam doctor`: libraries, fonts and encoders of this machine.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "output/film/video_library.hpp"
#include "output/json/tree.hpp"
#include "render/base/versions.hpp"
#include "render/draw/fonts.hpp"
#include "render/gl/renderer.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

struct Check {
    std::string group, part;
    bool ok = true;
    std::string found;   // version, name, or the error
    std::string remedy;  // the package to install
};

// Adds a check whose result `find` returns; an exception is a failure.
template <class Find>
void examine(std::vector<Check>& checks, const char* group, const std::string& part, const std::string& remedy,
             Find find) {
    Check check{group, part, true, "", remedy};
    try {
        check.found = find();
    } catch (const std::exception& error) {
        check.ok = false;
        check.found = error.what();
    }
    checks.push_back(std::move(check));
}

void examine_films(std::vector<Check>& checks) {
    output::VideoCapabilities found;
    examine(checks, "films", "FFmpeg", "install the Debian packages libavcodec59, libavformat59 (or newer)", [&] {
        found = output::video_capabilities();
        return found.versions;
    });
    for (const auto& [name, exists] : found.encoders)
        checks.push_back({"films", name + " encoder", exists, exists ? "available" : "not in these libraries",
                          "install the Debian package libavcodec59 or libavcodec-extra59 (or newer)"});
}

std::vector<Check> examine_machine() {
    std::vector<Check> checks;
    checks.push_back({"program", "beamcam", true, std::string(kVersion), ""});
    checks.push_back({"program", "processor", true, processor_path(), ""});
    checks.push_back({"program", "threads", true, std::to_string(thread_count(0)), ""});
    for (const auto& [name, version] : render::library_versions())
        checks.push_back({"pictures", name, true, version, ""});
    const auto examine_fonts = [&checks](const char* group, const std::vector<render::FontFile>& fonts) {
        for (const render::FontFile& font : fonts)
            checks.push_back({group, "font " + font.name, !font.path.empty(),
                              font.path.empty() ? "not found" : font.path.string(),
                              fmt::format("install the Debian package {}", font.package)});
    };
    examine_fonts("pictures", render::font_files());
    if (const std::vector<std::string>& ignored = render::ignored_gl_settings(); !ignored.empty())
        checks.push_back({"pictures", "ignored settings", true, fmt::format("{}", fmt::join(ignored, ", ")), ""});
    examine(
        checks, "pictures", "OpenGL",
        "install the Debian package libosmesa6, or libegl1 where libosmesa6 does not exist; flat views need neither",
        [] { return render::make_body_renderer(16, 16)->name(); });
    examine_fonts("figures", render::font_files(render::Typefaces::print));
    examine_films(checks);
    examine(checks, "fingerprint", "flat", "see the fonts above", flat_fingerprint);
    examine(checks, "fingerprint", "figures", "see the fonts of figures above", figure_fingerprint);
    examine(checks, "fingerprint", "lit", "see OpenGL above", body_fingerprint);
    return checks;
}

std::string checks_text(const std::vector<Check>& checks) {
    std::string text, group;
    for (const Check& check : checks) {
        if (check.group != group) text += check.group + "\n";
        group = check.group;
        text += fmt::format("  {:<4} {:<28} {}\n", check.ok ? "ok" : "MISS", check.part, check.found);
        if (!check.ok) text += fmt::format("       {:<28} → {}\n", "", check.remedy);
    }
    return text;
}

Node checks_node(const std::vector<Check>& checks) {
    Node groups = object_node();
    for (const Check& check : checks) {
        Node one = object_node();
        add(one, "ok", check.ok);
        add(one, "found", check.found);
        if (!check.ok) add(one, "remedy", check.remedy);
        if (!groups.find(check.group)) add(groups, check.group, object_node());
        add(groups.find(check.group)->value, check.part, std::move(one));
    }
    return groups;
}

int act(const Common& common) {
    const std::vector<Check> checks = examine_machine();
    print_result(common, to_text(checks_node(checks)), checks_text(checks));
    return std::ranges::all_of(checks, &Check::ok) ? kDone : kMissingPart;
}

}  // namespace

void add_doctor(Program& program) {
    const auto [app, common] = add_command<Common>(
        program, "doctor",
        "List libraries, fonts and encoders, and packages that contain missing ones; exit code 5 if any is missing",
        act);
    add_json(app, common);
}

}  // namespace beamcam::scenes
