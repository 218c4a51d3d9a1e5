// A PDF or SVG file in memory: the surface that a Painter draws on, and the bytes that it leaves there. PDF text is
// embedded TrueType, SVG carries its glyphs as outlines. The same drawing gives the same bytes.
#pragma once

#include <cstdint>
#include <string>

using cairo_surface_t = struct _cairo_surface;  // NOLINT(bugprone-reserved-identifier): the library's own name

namespace beamcam::render {

inline constexpr double kPointsPerInch = 72, kMillimetresPerInch = 25.4;
inline constexpr double kPointsPerPixel = 0.75;  // of a picture whose size is in pixels: 96 to the inch

enum class Medium { png, pdf, svg };

// The metadata of a file. PDF has only these keys; its keywords hold the scene.
struct Document {
    std::string title, subject;
    std::string scene;         // JSON
    std::string creator;       // "beamcam 0.1.0"
    std::int64_t created = 0;  // [s] since 1970, UTC; in the bytes, so not the present time
};

class VectorFile {
  public:
    // width, height: of the page [pt].
    VectorFile(Medium medium, double width, double height, const Document& document);
    VectorFile(const VectorFile&) = delete;
    VectorFile& operator=(const VectorFile&) = delete;

    // The surface of the page, which one Painter takes over.
    cairo_surface_t* surface();
    double unit() const;  // device units of a point
    // The file, after the Painter has finished the drawing.
    std::string take_bytes();

  private:
    Medium medium_;
    double width_, height_;  // [pt]
    Document document_;
    std::string stream_;
};

}  // namespace beamcam::render
