// The typefaces of all pictures: Inter for words and figures, STIX (General, or Two where Debian
// has no other) for mathematical symbols.
//
// They are loaded by file into a fontconfig configuration of our own, so that neither the system's
// nor the user's font settings influence a pixel; glyphs are neither hinted nor snapped, and are
// antialiased in grey. Files are looked for by name in Debian's folders, or in $BEAMCAM_FONT_DIR
// alone when that is set. Throws FontError, naming the Debian package, when one is missing.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::render {

// True when the text has characters that only the Chinese-Japanese-Korean face has.
bool needs_cjk(std::string_view utf8);

// Figures for print have TrueType faces instead, which every publisher takes embedded: Liberation Sans, Liberation
// Serif for symbols, Droid Sans Fallback for Chinese; serif: Liberation Serif for all letters.
enum class Typefaces { screen, print, serif };

// The message of an error: what lacks which character, and the Debian package to install.
std::string missing_glyphs(std::string_view utf8);

// A file of these typefaces, and the Debian package that brings it; `path` is empty when it is not there.
struct FontFile {
    std::string name, package;
    std::filesystem::path path;
};
std::vector<FontFile> font_files(Typefaces typefaces = Typefaces::screen);

// One per thread. `cjk` adds Noto Sans CJK (Debian package fonts-noto-cjk), in print Droid Sans Fallback
// (fonts-droid-fallback). What is loaded stays loaded for the next that asks for the same.
class Fonts {
  public:
    explicit Fonts(bool cjk = false, Typefaces typefaces = Typefaces::screen);

    struct Handles;
    const Handles& handles() const { return *handles_; }
    Typefaces typefaces() const { return typefaces_; }

  private:
    struct PutBack {
        void operator()(Handles* handles) const;
    };
    std::unique_ptr<Handles, PutBack> handles_;
    Typefaces typefaces_;
};

}  // namespace beamcam::render
