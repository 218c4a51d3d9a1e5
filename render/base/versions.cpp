#include "render/base/versions.hpp"

#include <cairo.h>
#include <fmt/format.h>
#include <ft2build.h>
#include <harfbuzz/hb.h>
#include <pango/pango.h>
#include <pixman.h>

#include FT_FREETYPE_H

namespace beamcam::render {

std::vector<std::pair<std::string, std::string>> library_versions() {
    std::string freetype = "unknown";
    if (FT_Library library = nullptr; FT_Init_FreeType(&library) == 0) {
        FT_Int major = 0, minor = 0, patch = 0;
        FT_Library_Version(library, &major, &minor, &patch);
        freetype = fmt::format("{}.{}.{}", major, minor, patch);
        FT_Done_FreeType(library);
    }
    return {{"cairo", cairo_version_string()},
            {"pixman", pixman_version_string()},
            {"pango", pango_version_string()},
            {"harfbuzz", hb_version_string()},
            {"freetype", freetype}};
}

}  // namespace beamcam::render
