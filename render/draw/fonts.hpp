// The fonts of all pictures: Inter for text and digits, STIX (General, or Two in newer Debian releases) for
// mathematical symbols.
//
// They are loaded by file into a private fontconfig configuration, so that no font setting of the system or the user
// changes a pixel; glyphs are neither hinted nor snapped to pixels, and antialiased in grey. Files are searched by name
// in Debian's folders, or only in $BEAMCAM_FONT_DIR if that is set. Throws FontError, which names the Debian package,
// if a file is missing.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::render {

// Characters that the Chinese-Japanese-Korean font writes: the scripts from U+2E80 on, without pictographs, variation
// selectors and mathematical letters.
bool is_cjk(char32_t character);
bool needs_cjk(std::string_view utf8);  // whether the text has any

// Figures for print use TrueType fonts, which every publisher accepts embedded: Liberation Sans, Liberation Serif for
// symbols, Droid Sans Fallback for Chinese. serif: Liberation Serif for all letters.
enum class Typefaces { screen, print, serif };

// A font file and the Debian package that contains it; `path` is empty if the file is missing.
struct FontFile {
    std::string name, package;
    std::filesystem::path path;
};
std::vector<FontFile> font_files(Typefaces typefaces = Typefaces::screen);

// One object per thread. `cjk` adds Noto Sans CJK (Debian package fonts-noto-cjk), in print Droid Sans Fallback
// (fonts-droid-fallback). Loaded font sets are pooled and reused.
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

// The text without characters that no font has (mostly pictographs), which would be drawn as boxes.
std::string drawable(const Fonts& fonts, std::string_view text);

}  // namespace beamcam::render
