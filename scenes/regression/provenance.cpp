#include "scenes/regression/provenance.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "output/data/manifest.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/errors.hpp"
#include "output/files/text_safety.hpp"
#include "output/film/video_reader.hpp"
#include "output/image/document_metadata.hpp"
#include "output/image/png_reader.hpp"
#include "render/base/error.hpp"
#include "render/base/versions.hpp"
#include "render/draw/fonts.hpp"
#include "render/gl/lit.hpp"
#include "render/gl/lit.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/fingerprint.hpp"
#include "scenes/regression/child.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Containers change the case of keys.
std::string find(const std::map<std::string, std::string>& metadata, std::string_view key) {
    for (const auto& [name, value] : metadata)
        if (name.size() == key.size() && std::equal(name.begin(), name.end(), key.begin(), [](char a, char b) {
                return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
            }))
            return value;
    return {};
}

// "beamcam 0.1.0" → "0.1.0".
std::string version_in(const std::string& text) {
    const std::size_t at = text.find("beamcam ");
    return at == std::string::npos ? std::string() : text.substr(at + 8);
}

void read_own_keys(const std::map<std::string, std::string>& metadata, Provenance& p) {
    p.scene = find(metadata, "beamcam-scene");
    p.accuracy = find(metadata, "beamcam-accuracy");
    p.title = find(metadata, "title");
    p.version = find(metadata, "beamcam-version");
    for (const char* key : {"software", "comment", "creator"})
        if (p.version.empty()) p.version = version_in(find(metadata, key));
}

void read_document(const output::DocumentMetadata& document, Provenance& p) {
    p.title = document.title;
    p.version = version_in(document.creator);
    if (document.scene.starts_with("{")) p.scene = document.scene;
    if (!document.subject.empty()) p.facts["subject"] = document.subject;
}

void read_png_info(const std::string& file, Provenance& p) {
    p.kind = "PNG picture";
    const output::PngInfo facts = output::read_png_info(file);
    p.facts["size"] = fmt::format("{}x{}", facts.width, facts.height);
    read_own_keys(facts.metadata, p);
}

void read_manifest(const std::string& file, Provenance& p);

void read_film(const std::string& file, Provenance& p) {
    const output::VideoReader film(file);
    const output::VideoInfo& facts = film.info();
    p.kind = facts.is_still() ? "picture" : "film";
    p.facts["size"] = fmt::format("{}x{}", facts.width, facts.height);
    p.facts["codec"] = facts.codec;
    if (facts.frames > 0) p.facts["frames"] = std::to_string(facts.frames);
    if (facts.seconds > 0) p.facts["duration"] = fmt::format("{:.6g} s", facts.seconds);
    read_own_keys(facts.metadata, p);
    if (!p.made_by_beamcam()) read_manifest(file, p);  // GIF and the like
}

// Tables carry nothing but numbers: the manifest beside them knows.
void read_manifest(const std::string& file, Provenance& p) {
    const auto made = output::Manifest::find(file);
    if (!made) return;
    p.version = made->origin.version;
    p.scene = made->origin.scene;
    p.facts["changed since"] = made->unchanged ? "no" : "yes";
}

void read_table(const std::string& file, Provenance& p) {
    p.kind = "table";
    const output::NamedTable table = output::read_table(file);
    p.facts["rows"] = std::to_string(table.rows());
    p.facts["columns"] = std::to_string(table.names.size());
    read_manifest(file, p);
}

std::string lower_ending(const std::string& file) {
    std::string ending = fs::path(file).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

// ---- this machine --------------------------------------------------------------------------------------

template <class Look>
void examine(std::vector<Check>& checks, const char* group, const std::string& what, const std::string& remedy,
             Look look) {
    Check check{group, what, true, "", remedy};
    try {
        check.found = look();
    } catch (const std::exception& error) {
        check.ok = false;
        check.found = error.what();
    }
    checks.push_back(std::move(check));
}

void examine_films(std::vector<Check>& checks) {
    const std::string found = "there";
    // One line each: the versions, then the encoders.
    std::istringstream lines;
    examine(checks, "films", "FFmpeg",
            "install the Debian packages libavcodec59, libavformat59, libswscale6 (or newer)", [&] {
                lines.str(in_child([&] {
                    const output::VideoCapabilities abilities = output::video_capabilities();
                    std::string text = abilities.versions + "\n";
                    for (const auto& [name, there] : abilities.encoders)
                        text += fmt::format("{}\n{}\n", name, there ? found : "not in these libraries");
                    return text;
                }));
                std::string versions;
                std::getline(lines, versions);
                return versions;
            });
    if (!checks.back().ok) return;
    for (std::string name, state; std::getline(lines, name) && std::getline(lines, state);)
        checks.push_back({"films", name + " encoder", state == found, state,
                          "install Debian's libavcodec59 or libavcodec-extra59 (or newer), which have it"});
}

}  // namespace

Provenance provenance_of(const std::string& file) {
    std::error_code error;
    if (fs::is_directory(file, error)) throw output::IoError(fmt::format("{} is a directory; name a file in it", file));
    if (!fs::exists(file, error)) throw output::read_error(file, ENOENT);
    Provenance p;
    p.file = file;
    const std::string ending = lower_ending(file);
    if (output::png_kind(file) != output::PngKind::none && ending != ".apng") {
        read_png_info(file, p);
    } else if (ending == ".svg") {
        p.kind = "SVG figure";
        read_document(output::read_svg_metadata(file), p);
    } else if (ending == ".pdf") {
        p.kind = "PDF figure";
        read_document(output::read_pdf_metadata(file), p);
    } else if (ending == ".eps" || ending == ".tif" || ending == ".tiff") {
        p.kind = ending == ".eps" ? "EPS figure" : "TIFF figure";
        read_manifest(file, p);
    } else if (ending == ".webp") {  // FFmpeg does not read moving ones
        p.kind = "film";
        read_manifest(file, p);
    } else if (ending == ".csv" || ending == ".npz") {
        read_table(file, p);
    } else if (ending == ".json") {
        p.kind = "record";
        read_manifest(file, p);
    } else {
        read_film(file, p);
    }
    return p;
}

std::string to_text(const Provenance& p) {
    std::string text = fmt::format("{}: {}\n", output::one_line(p.file), p.kind);
    auto line = [&](std::string_view key, std::string_view value) {
        if (!value.empty()) text += fmt::format("  {:<14} {}\n", key, output::one_line(value));
    };
    for (const auto& [key, value] : p.facts) line(key, value);
    line("title", p.title);
    if (!p.made_by_beamcam()) {
        line("made by", "not by beamcam, or what it said of itself is lost");
        return text;
    }
    line("made by", "beamcam " + p.version);
    line("accuracy", p.accuracy);
    line("scene", p.scene.empty() ? "not in it" : "in it; --scene prints it");
    return text;
}

std::vector<Check> examine_machine() {
    std::vector<Check> checks;
    checks.push_back({"program", "beamcam", true, std::string(kVersion), ""});
    checks.push_back({"program", "processor", true, processor_path(), ""});
    checks.push_back({"program", "threads", true, std::to_string(thread_count(0)), ""});
    for (const auto& [name, version] : render::library_versions())
        checks.push_back({"pictures", name, true, version, ""});
    for (const render::FontFile& font : render::font_files())
        checks.push_back({"pictures", "font " + font.name, !font.path.empty(),
                          font.path.empty() ? "not found" : font.path.string(),
                          fmt::format("install the Debian package {}", font.package)});
    if (const std::vector<std::string>& ignored = render::ignored_gl_settings(); !ignored.empty())
        checks.push_back({"pictures", "ignored settings", true, fmt::format("{}", fmt::join(ignored, ", ")), ""});
    examine(checks, "pictures", "OpenGL",
            "install the Debian package libosmesa6, or libegl1 where there is none; flat views need neither",
            [] { return in_child([] { return render::make_lit_renderer(16, 16)->name(); }); });
    for (const render::FontFile& font : render::font_files(render::Typefaces::print))
        checks.push_back({"figures", "font " + font.name, !font.path.empty(),
                          font.path.empty() ? "not found" : font.path.string(),
                          fmt::format("install the Debian package {}", font.package)});
    examine_films(checks);
    examine(checks, "fingerprint", "flat", "see the fonts above", [] { return flat_fingerprint().id(); });
    examine(checks, "fingerprint", "figures", "see the fonts of figures above",
            [] { return figure_fingerprint().id(); });
    examine(checks, "fingerprint", "lit", "see OpenGL above",
            [] { return in_child([] { return lit_fingerprint().id(); }); });
    return checks;
}

std::string to_text(const std::vector<Check>& checks) {
    std::string text, group;
    for (const Check& check : checks) {
        if (check.group != group) text += check.group + "\n";
        group = check.group;
        text += fmt::format("  {:<4} {:<28} {}\n", check.ok ? "ok" : "MISS", check.what, check.found);
        if (!check.ok) text += fmt::format("       {:<28} → {}\n", "", check.remedy);
    }
    return text;
}

}  // namespace beamcam::scenes
