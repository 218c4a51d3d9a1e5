// The canvas of a printed figure: PNG, PDF or SVG behind one set of strokes, fills and labels.
//
// Units are points (1/72 inch) of the printed figure, y down, whatever the medium: a line of 0.8 pt and a letter of
// 8 pt are that on paper.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/fonts.hpp"
#include "render/draw/geometry.hpp"
#include "render/draw/image.hpp"
#include "render/draw/painter.hpp"
#include "render/draw/text_style.hpp"
#include "render/draw/vector_file.hpp"

namespace beamcam::render::figure {

inline constexpr double points(double millimetres) { return millimetres * kPointsPerInch / kMillimetresPerInch; }

struct Paper {
    double width = 255, height = 170;  // [pt]
    double dpi = 300;                  // of PNG
    bool dark = false;                 // a slide; callers use the colours of white paper all the same
};

class PageCanvas : public Painter {
  public:
    // Throws PictureError for a size that no surface can have, FontError later for missing glyphs.
    PageCanvas(Medium medium, const Paper& paper, const Fonts& fonts, const Document& document = {});
    ~PageCanvas() noexcept(false) override;

    Color shown(Color color) const { return recolor_ ? recolor_(color) : color; }  // on this paper
    double grain() const;  // the smallest distance that shows [pt]

    void gradient(const Box& box, std::span<const Color> bottom_to_top);
    void curve(std::span<const Vec2> points, const Pen& pen) override;

    // The box that the text takes, turned text included.
    Box text(Vec2 at, std::string_view markup, const TextStyle& style) override;
    Box measure(std::string_view markup, const TextStyle& style) const override;

    // The texts that were drawn, for tests.
    struct Written {
        Box box;
        double smallest = 0;  // letter [pt]
        std::string markup;
    };
    std::vector<Written> written;

    // Ends the drawing: the image of a PNG, the bytes of the other media.
    Image image();
    std::string bytes();

  private:
    Medium medium_;
    Paper paper_;
    Image image_;
    std::optional<VectorFile> file_;  // of PDF and SVG
};

}  // namespace beamcam::render::figure
