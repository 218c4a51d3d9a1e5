#include "render/draw/fonts.hpp"

#include <fmt/format.h>
#include <pango/pangofc-fontmap.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "render/base/error.hpp"
#include "render/draw/letters.hpp"

namespace beamcam::render {
namespace {

namespace fs = std::filesystem;

struct KnownFile {
    const char* name;
    const char* package;              // Debian's
    const char* successor = nullptr;  // its name in newer releases of the package
};

constexpr std::array kFiles{KnownFile{"Inter-Regular.otf", "fonts-inter"}, KnownFile{"Inter-Medium.otf", "fonts-inter"},
                            KnownFile{"Inter-SemiBold.otf", "fonts-inter"},
                            KnownFile{"STIXGeneral-Regular.otf", "fonts-stix", "STIXTwoText-Regular.otf"},
                            KnownFile{"STIXGeneral-Italic.otf", "fonts-stix", "STIXTwoText-Italic.otf"}};
constexpr std::array kCjkFiles{KnownFile{"NotoSansCJK-Regular.ttc", "fonts-noto-cjk"},
                               KnownFile{"NotoSansCJK-Bold.ttc", "fonts-noto-cjk"}};

constexpr std::array kPrintFiles{KnownFile{"LiberationSans-Regular.ttf", "fonts-liberation"},
                                 KnownFile{"LiberationSans-Bold.ttf", "fonts-liberation"},
                                 KnownFile{"LiberationSerif-Italic.ttf", "fonts-liberation"}};
constexpr std::array kSerifFiles{KnownFile{"LiberationSerif-Regular.ttf", "fonts-liberation"},
                                 KnownFile{"LiberationSerif-Bold.ttf", "fonts-liberation"},
                                 KnownFile{"LiberationSerif-Italic.ttf", "fonts-liberation"}};
constexpr std::array kPrintCjkFiles{KnownFile{"DroidSansFallbackFull.ttf", "fonts-droid-fallback"}};

std::vector<fs::path> folders() {
    if (const char* own = std::getenv("BEAMCAM_FONT_DIR"); own && *own) return {own};
    return {"/usr/share/fonts/opentype/inter",      "/usr/share/fonts/opentype/stix",
            "/usr/share/fonts/opentype/noto",       "/usr/share/fonts/truetype/inter",
            "/usr/share/fonts/truetype/liberation", "/usr/share/fonts/truetype/liberation2",
            "/usr/share/fonts/truetype/droid",      "/usr/local/share/fonts"};
}

// Empty if not found.
fs::path find(const KnownFile& file) {
    for (const char* name : {file.name, file.successor})
        for (const fs::path& folder : folders()) {
            std::error_code unreadable;
            if (name != nullptr && fs::is_regular_file(folder / name, unreadable)) return folder / name;
        }
    return {};
}

void require(const FontFile& file) {
    if (!file.path.empty()) return;
    std::string tried;
    for (const fs::path& folder : folders()) tried += (tried.empty() ? "" : ", ") + folder.string();
    throw FontError(
        fmt::format("font {} not found (looked in {}); install the Debian package {}, or set "
                    "BEAMCAM_FONT_DIR to a folder that holds it",
                    file.name, tried, file.package));
}

std::vector<FontFile> files_of(Typefaces typefaces, bool cjk) {
    const bool print = typefaces != Typefaces::screen;
    std::vector<FontFile> files;
    const auto look_for = [&](std::span<const KnownFile> known) {
        for (const KnownFile& file : known) files.push_back({file.name, file.package, find(file)});
    };
    look_for(typefaces == Typefaces::serif ? std::span<const KnownFile>(kSerifFiles)
             : print                       ? std::span<const KnownFile>(kPrintFiles)
                                           : kFiles);
    if (cjk) look_for(print ? std::span<const KnownFile>(kPrintCjkFiles) : kCjkFiles);
    return files;
}

void add(FcConfig* config, const FontFile& file) {
    if (!FcConfigAppFontAddFile(config, reinterpret_cast<const FcChar8*>(file.path.c_str())))
        throw FontError(fmt::format("font {} cannot be read as a font; reinstall the Debian package {}",
                                    file.path.string(), file.package));
}

// Pango makes fontconfig read the system's configuration in a separate thread, even if it is not needed. Setting an
// empty current configuration, once per process, avoids that; it is never used.
void keep_system_settings_out() {
    static const bool done = [] {
        FcConfig* empty = FcConfigCreate();
        return empty && FcConfigSetCurrent(empty);
    }();
    if (!done) throw FontError("fontconfig cannot create a configuration (out of memory)");
}

}  // namespace

bool is_cjk(char32_t c) {
    return (c >= 0x2E80 && c < 0xE000) || (c >= 0xF900 && c < 0xFB00) || (c >= 0xFE30 && c < 0xFE50) ||
           (c >= 0xFF00 && c < 0xFFF0) || (c >= 0x20000 && c < 0x40000);
}

bool needs_cjk(std::string_view utf8) {
    const char* const end = utf8.data() + utf8.size();
    for (const char* at = utf8.data(); at < end; at = g_utf8_next_char(at))
        if (is_cjk(g_utf8_get_char_validated(at, end - at))) return true;
    return false;
}

std::vector<FontFile> font_files(Typefaces typefaces) { return files_of(typefaces, typefaces == Typefaces::print); }

// ---- the pool of font sets -----------------------------------------------------------------------

namespace {

// Pango 1.50 sorts fonts in its own threads, which release their font set when they finish. A set that is destroyed at
// that time is destroyed by two threads at once, without a lock (pangofc-fontmap.c, free_patterns). So loaded sets are
// never destroyed; they wait in this pool until the same files are requested.
class FontPool {
  public:
    // A set of these files, or null.
    std::unique_ptr<Fonts::Handles> take(const std::string& key) {
        const std::lock_guard lock(mutex_);
        std::vector<std::unique_ptr<Fonts::Handles>>& all = sets_[key];
        if (all.empty()) return nullptr;
        auto last = std::move(all.back());
        all.pop_back();
        return last;
    }
    void put(std::unique_ptr<Fonts::Handles> handles) {
        const std::lock_guard lock(mutex_);
        sets_[handles->key].push_back(std::move(handles));
    }

  private:
    std::mutex mutex_;
    std::map<std::string, std::vector<std::unique_ptr<Fonts::Handles>>> sets_;
};

FontPool& font_pool() {
    static FontPool* const all = new FontPool;  // outlives the threads
    return *all;
}

}  // namespace

// Runs only for sets that failed to load; others go to the pool.
Fonts::Handles::~Handles() {
    if (map) g_object_unref(map);
    if (config) FcConfigDestroy(config);
}

namespace {

std::unique_ptr<Fonts::Handles> load(std::span<const FontFile> files) {
    auto handles = std::make_unique<Fonts::Handles>();
    Fonts::Handles& h = *handles;
    h.config = FcConfigCreate();  // empty: reads no system file
    if (!h.config) throw FontError("fontconfig cannot create a configuration (out of memory)");
    for (const FontFile& file : files) add(h.config, file);
    h.map = pango_cairo_font_map_new_for_font_type(CAIRO_FONT_TYPE_FT);
    if (!h.map) throw FontError("Pango was built without FreeType; install Debian's libpangocairo-1.0-0");
    pango_fc_font_map_set_config(PANGO_FC_FONT_MAP(h.map), h.config);
    pango_cairo_font_map_set_resolution(PANGO_CAIRO_FONT_MAP(h.map), 72);
    h.context = pango_font_map_create_context(h.map);
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(h.context, options);
    cairo_font_options_destroy(options);
    pango_context_set_round_glyph_positions(h.context, FALSE);
    pango_context_set_language(h.context, pango_language_from_string("en"));  // not the locale's
    return handles;
}

}  // namespace

Fonts::Fonts(bool cjk, Typefaces typefaces) : typefaces_(typefaces) {
    keep_system_settings_out();
    const std::vector<FontFile> files = files_of(typefaces, cjk);
    std::string key;
    for (const FontFile& file : files) {
        require(file);
        (key += file.path.native()) += '\n';
    }
    auto handles = font_pool().take(key);
    if (!handles) {
        handles = load(files);
        handles->key = std::move(key);
    }
    handles_.reset(handles.release());
}

void Fonts::PutBack::operator()(Handles* handles) const {
    handles->layouts.clear();
    font_pool().put(std::unique_ptr<Handles>(handles));
}

}  // namespace beamcam::render
