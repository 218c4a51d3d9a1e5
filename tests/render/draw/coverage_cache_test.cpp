// Shapes painted from the cached coverage of the previous picture.
#include "render/draw/coverage_cache.hpp"

#include <gtest/gtest.h>

#include "render/draw/canvas.hpp"
#include "tests/render/drawing.hpp"

namespace beamcam::render {
namespace {

Image ground() {
    Image image(200, 150);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = 0xff000000U | static_cast<std::uint32_t>(i * 2654435761U >> 8);
    return image;
}

// Opaque and translucent shapes, some partly outside the picture; `age` fades the shapes that stay in place.
void draw_shapes(Canvas& canvas, double age) {
    const Color blue = rgb(0x1F5FA8), red = rgb(0xD55E00);
    for (const Color& color : {blue, red.faded(0.7 * age)}) {
        canvas.circle({60.3, 50.7}, 33.9);
        canvas.fill_keeping_path(color.faded(0.9 * color.a));
        canvas.stroke({color, 2.6});
        canvas.move_to({-20.5, 40});
        canvas.line_to({150.25, 93.4});
        canvas.line_to({230, 20});
        canvas.stroke({color, 5, {9, 4}, Cap::butt});
        canvas.circle({120, 80}, 30);
        canvas.circle({123, 81}, 11.5);
        canvas.fill(color);
        canvas.rounded({100.5, 100.5, 60, 30}, 9);
        canvas.fill(color);
        canvas.arrow({20, 140}, {70, 101}, {color, 3}, {14});
    }
    canvas.text({90, 60}, "F = 12", {.size = 30, .color = red, .halo = blue});
}

Image picture(CoverageCache* coverage_cache, DirtyTiles& touched, double age) {
    Image image = ground();
    Canvas canvas(image, fonts());
    canvas.touched = &touched;
    canvas.coverage_cache = coverage_cache;
    draw_shapes(canvas, age);
    if (coverage_cache) coverage_cache->next_picture();
    return image;
}

TEST(CoverageCache, PaintWhatCairoPaints) {
    EXPECT_TRUE(CoverageCache::exact());
    CoverageCache coverage_cache;
    DirtyTiles touched(200, 150);
    for (const double age : {1.0, 0.8, 0.5, 0.01, 0.0})
        EXPECT_EQ(picture(&coverage_cache, touched, age), picture(nullptr, touched, age)) << age;
}

// Slightly different shapes, which must not share coverage.
TEST(CoverageCache, TellShapesApart) {
    CoverageCache coverage_cache;
    for (int round = 0; round < 3; ++round) {
        const auto draw = [&](CoverageCache* with) {
            Image image = ground();
            DirtyTiles touched(200, 150);
            Canvas canvas(image, fonts());
            canvas.touched = &touched;
            canvas.coverage_cache = with;
            const auto line = [&](Vec2 to, const Pen& pen) {
                canvas.move_to({10, 10});
                canvas.line_to(to);
                canvas.stroke(pen);
            };
            const Color ink = rgb(0);
            line({50, 20}, {ink, 3});
            line({50, 20.01 + round}, {ink, 3});
            line({150, 20}, {ink, 3, {4}});
            line({150, 20}, {ink, 3.5, {4, 2}});
            line({20, 120}, {ink, 3, {}, Cap::butt});
            line({20, 120}, {ink, 4, {}, Cap::round});
            line({70, 120}, {ink, 4});
            line({70, 120}, {ink.faded(0.5), 4});
            canvas.clip({80, 60, 30, 30}, [&] { line({150, 120}, {ink, 8}); });
            return image;
        };
        EXPECT_EQ(draw(&coverage_cache), draw(nullptr)) << round;
        coverage_cache.next_picture();
    }
}

}  // namespace
}  // namespace beamcam::render
