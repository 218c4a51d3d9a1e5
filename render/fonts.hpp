// The typefaces of all pictures: Inter for words and figures, STIX for mathematical symbols.
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

// A file of these typefaces, and the Debian package that brings it; `path` is empty when it is not there.
struct FontFile {
    std::string name, package;
    std::filesystem::path path;
};
std::vector<FontFile> font_files();

// One per thread. `cjk` adds Noto Sans CJK (Debian package fonts-noto-cjk).
class Fonts {
  public:
    explicit Fonts(bool cjk = false);
    ~Fonts();
    Fonts(Fonts&&) noexcept;
    Fonts& operator=(Fonts&&) noexcept;

    struct Handles;
    const Handles& handles() const { return *handles_; }

  private:
    std::unique_ptr<Handles> handles_;
};

}  // namespace beamcam::render
