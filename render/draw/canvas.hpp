// Drawing a picture with Cairo and Pango: paths, strokes, text; on an Image or as vector graphics. Coordinates in
// pixels, y down.
//
// Texts are markup (markup.hpp). The boxes of drawn texts can be recorded, so that tests can check that texts stay
// inside their panels and do not overlap.
#pragma once

#include <functional>
#include <initializer_list>
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

namespace beamcam::render {

class Canvas : public Painter {
  public:
    Canvas(Image& image, const Fonts& fonts);
    // The same picture as vector graphics; width, height: of the picture [px].
    Canvas(VectorFile& file, int width, int height, const Fonts& fonts);
    ~Canvas() noexcept(false) override;  // throws if Cairo failed: a picture is complete, or there is an error

    void rounded(const Box& box, double radius);
    void paint(Color color);
    // Paints the pixels of a polygon whose colours meet those of its neighbours: without antialiasing. In vector
    // graphics it overlaps them by a hair, since viewers show gaps between areas that only touch.
    void fill_piece(std::span<const Vec2> corners, Color color);

    // Blends a part of `source` [px of the source, rounded outwards], whose top left pixel goes to (x, y).
    void image_part(const Image& source, int x, int y, const Box& part);
    // Blends `source` within these tiles of the picture.
    void image_tiles(const Image& source, int x, int y, const DirtyTiles& tiles);

    // Returns the ink of the text, as wide as its advance.
    Box text(Vec2 baseline, std::string_view markup, const TextStyle& style) override;
    Box measure(std::string_view markup, const TextStyle& style) const override;
    const Fonts& fonts() const { return *fonts_; }
    int width() const { return width_; }    // of the picture [px]
    int height() const { return height_; }  // [px]
    bool is_vector() const { return is_vector_; }

    std::vector<Box>* record = nullptr;  // collects the ink boxes of drawn texts

  private:
    Vec2 rounded_start(Vec2 at, const SetLabel& label, const TextStyle& style);
    void write(const SetRun& run, Vec2 at, const TextStyle& style) override;

    int width_, height_;
    bool is_vector_ = false;
};

// The first of the texts that is no wider than `room`; the last one if none is.
std::string first_that_fits(Canvas& canvas, std::initializer_list<std::string> texts, const TextStyle& style,
                            double room);

}  // namespace beamcam::render
