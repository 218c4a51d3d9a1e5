// Drawing on an Image with Cairo and Pango: paths, strokes, text. Coordinates in pixels, y down.
//
// Text is Pango markup (`escape` user text) with formulas (formula.hpp). The boxes of drawn texts can be recorded, so
// that tests can check that texts stay inside their panels and do not overlap.
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
    ~Canvas() noexcept(false);  // throws if Cairo failed: a picture is complete, or there is an error

    void rounded(const Box& box, double radius);
    void paint(Color color);

    // Blends a part of `source` [px of the source, rounded outwards], whose top left pixel goes to (x, y).
    void image_part(const Image& source, int x, int y, const Box& part);
    // Blends `source` within these tiles of the picture.
    void image_tiles(const Image& source, int x, int y, const DirtyTiles& tiles);
    // Copies a part of `source`, alpha included, instead of blending it.
    void replace_part(const Image& source, int x, int y, const Box& part);
    // Gives `paint` direct access to the pixels; it must mark the tiles that it changes. Not allowed within `clip`.
    void paint_pixels(const std::function<void(const PixelView&, DirtyTiles* touched)>& paint);

    // The text without characters that no font has (mostly pictographs), which would be drawn as boxes.
    std::string drawable(std::string_view plain) const;
    Box text(Vec2 baseline, const std::string& markup, const TextStyle& style);
    const Fonts& fonts() const { return fonts_; }
    const Image& image() const { return image_; }                    // as drawn so far
    Box measure(const std::string& markup, const TextStyle& style);  // at baseline (0, 0), left

    // Outline of all texts instead of their own halos, for pictures without paper.
    std::optional<Color> outline = {};
    std::vector<Box>* record = nullptr;  // collects the ink boxes of drawn texts

  private:
    // Draws or measures a left-aligned text with formulas.
    Box set_parts(Vec2 at, const std::string& markup, const TextStyle& style, bool draws);

    const Image& image_;
    const Fonts& fonts_;
};

// The first of the texts that is no wider than `room`; the last one if none is.
std::string first_that_fits(Canvas& canvas, std::initializer_list<std::string> texts, const TextStyle& style,
                            double room);

}  // namespace beamcam::render
