// Drawing on an Image with Cairo and Pango: paths, strokes, text. Coordinates in pixels, y down.
//
// Text is Pango markup (`escape` what users wrote) with formulas (formula.hpp). Every text drawn can be recorded, so
// that tests check that labels keep to their boxes and apart from each other.
#pragma once

#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/draw/area.hpp"
#include "render/draw/color.hpp"
#include "render/draw/fonts.hpp"
#include "render/draw/geometry.hpp"
#include "render/draw/image.hpp"
#include "render/draw/painter.hpp"
#include "render/draw/text_style.hpp"

namespace beamcam::render {

std::string escape(std::string_view plain);
std::string math(std::string_view symbol);  // markup of an italic symbol: math("θ")

class Canvas : public Painter {
  public:
    Canvas(Image& image, const Fonts& fonts);
    ~Canvas() noexcept(false);  // throws what Cairo could not draw: a picture is whole, or an error

    void rounded(const Box& box, double radius);
    void paint(Color color);

    // Blends `source`, its top left pixel at (x, y): the `part` of it [px of the source, rounded outwards]. Whole
    // pixels.
    void image_part(const Image& source, int x, int y, const Box& part);
    // The same within these tiles of the picture.
    void image_tiles(const Image& source, int x, int y, const DirtyTiles& tiles);
    // Puts it in the place of what is there.
    void replace_part(const Image& source, int x, int y, const Box& part);
    // Lets `paint` write the pixels themselves, and note where. Not within `clip`.
    void paint_pixels(const std::function<void(const PixelView&, DirtyTiles* touched)>& paint);

    // The text without characters that no typeface has (pictographs, mostly), which would show as boxes.
    std::string drawable(std::string_view plain) const;
    Box text(Vec2 baseline, const std::string& markup, const TextStyle& style);
    const Fonts& fonts() const { return fonts_; }
    const Image& image() const { return image_; }                    // as drawn so far
    Box measure(const std::string& markup, const TextStyle& style);  // at baseline (0, 0), left

    // Of all texts, as far as they are seen, instead of their own halos: where the ground is not known.
    std::optional<Color> outline = {};
    std::vector<Box>* record = nullptr;  // texts drawn, ink boxes

  private:
    // A text with formulas, at the left.
    Box set_parts(Vec2 at, const std::string& markup, const TextStyle& style, bool draws);

    const Image& image_;
    const Fonts& fonts_;
};

// The first of the texts that is no wider than `room`; the last where none is.
std::string first_that_fits(Canvas& canvas, std::initializer_list<std::string> texts, const TextStyle& style,
                            double room);

}  // namespace beamcam::render
