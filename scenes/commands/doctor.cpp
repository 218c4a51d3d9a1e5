// `beamcam doctor`: libraries, fonts and encoders of this machine.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "output/files/descriptor.hpp"
#include "output/film/video_library.hpp"
#include "output/json/tree.hpp"
#include "render/base/versions.hpp"
#include "render/draw/fonts.hpp"
#include "render/gl/lit.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/fingerprint.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

constexpr char kReturned = '+', kThrown = '-';
constexpr std::size_t kLongestAnswer = 1 << 16;  // [bytes]: many times the list of all encoders

// The answer of the child: one of the two characters above, then the text.
std::string answer_of(const std::function<std::string()>& work) {
    try {
        return kReturned + work();
    } catch (const std::exception& error) {
        return std::string(1, kThrown) + error.what();
    }
}

// Returns the result of `work`, done in a child process, because a library may crash in it. Throws std::runtime_error
// with the message of its exception, or with the signal that ended it. Only while the process has one thread.
std::string in_child(const std::function<std::string()>& work) {
    int ends[2];
    if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    output::Descriptor from(ends[0]), to(ends[1]);
    const pid_t child = fork();
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        to.write(answer_of(work));
        _exit(0);
    }
    to.close();
    std::string answer(kLongestAnswer, '\0');
    answer.resize(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, from.read(answer.data(), answer.size()))));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status))
        throw std::runtime_error(fmt::format("the library ended with {}", strsignal(WTERMSIG(status))));
    if (answer.empty()) throw std::runtime_error(fmt::format("the library ended with exit {}", WEXITSTATUS(status)));
    if (answer.front() != kReturned) throw std::runtime_error(answer.substr(1));
    return answer.substr(1);
}

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
    const std::string available = "available";
    std::istringstream lines;  // the versions, then two lines for each encoder
    examine(checks, "films", "FFmpeg", "install the Debian packages libavcodec59, libavformat59 (or newer)", [&] {
        lines.str(in_child([&] {
            const output::VideoCapabilities found = output::video_capabilities();
            std::string text = found.versions + "\n";
            for (const auto& [name, exists] : found.encoders)
                text += fmt::format("{}\n{}\n", name, exists ? available : "not in these libraries");
            return text;
        }));
        std::string versions;
        std::getline(lines, versions);
        return versions;
    });
    if (!checks.back().ok) return;
    for (std::string name, state; std::getline(lines, name) && std::getline(lines, state);)
        checks.push_back({"films", name + " encoder", state == available, state,
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
        [] { return in_child([] { return render::make_lit_renderer(16, 16)->name(); }); });
    examine_fonts("figures", render::font_files(render::Typefaces::print));
    examine_films(checks);
    examine(checks, "fingerprint", "flat", "see the fonts above", [] { return flat_fingerprint().id(); });
    examine(checks, "fingerprint", "figures", "see the fonts of figures above",
            [] { return figure_fingerprint().id(); });
    examine(checks, "fingerprint", "lit", "see OpenGL above",
            [] { return in_child([] { return lit_fingerprint().id(); }); });
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

void add_doctor(Grammar& grammar) {
    const auto [app, common] = grammar.command<Common>(
        "doctor",
        "List libraries, fonts and encoders, and packages that contain missing ones; exit code 5 if any is missing",
        act);
    add_json(app, common);
}

}  // namespace beamcam::scenes
