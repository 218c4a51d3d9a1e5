#include "render/draw/canvas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "render/plot/page_canvas.hpp"
#include "tests/render/drawing.hpp"

namespace beamcam::render {
namespace {

// A negative dash is an error, after which a Cairo context draws nothing and only reports its status.
const Pen kImpossible{rgb(0x000000), 1, {-1}};

template <typename Picture>
void give_up(Picture& picture) {
    picture.move_to({1, 1});
    picture.line_to({20, 20});
    picture.stroke(kImpossible);
}

TEST(Canvas, APictureThatCairoGaveUpIsAnError) {
    Image image(32, 32);
    const auto draw = [&] {
        Canvas canvas(image, fonts());
        give_up(canvas);
    };
    EXPECT_THROW(draw(), std::runtime_error);
}

// In films without paper every text has a halo.
TEST(Canvas, TextsAreOutlinedInAColourThatIsNotTheirOwn) {
    const auto covered = [](std::optional<Color> outline, Color ink, std::optional<Color> halo) {
        Image image(80, 40);
        Canvas canvas(image, fonts());
        canvas.halo_of_all = outline;
        canvas.text({10, 30}, "mm", {.size = 20, .color = ink, .halo = halo});
        return std::ranges::count_if(image.pixels, [](std::uint32_t pixel) { return pixel != 0; });
    };
    const Color white = rgb(0xffffff), black = rgb(0x000000);
    const auto bare = covered({}, black, {});
    EXPECT_GT(covered(white.faded(0.8), black, {}), 1.3 * static_cast<double>(bare));
    EXPECT_EQ(covered(white.faded(0.8), black, rgb(0xff0000)), covered(white.faded(0.8), black, {}));
    EXPECT_EQ(covered(white.faded(0.8), white, {}), bare);
}

TEST(Canvas, AnErrorOnTheWayIsTheOneThatIsReported) {
    Image image(32, 32);
    const auto draw = [&] {
        Canvas canvas(image, fonts());
        give_up(canvas);
        throw std::out_of_range("another");
    };
    EXPECT_THROW(draw(), std::out_of_range);
}

TEST(PageCanvas, AFigureThatCairoGaveUpIsAnError) {
    for (const auto medium : {Medium::png, Medium::pdf, Medium::svg}) {
        const auto draw = [&](bool whole) {
            figure::PageCanvas sheet(medium, {100, 100, 72}, fonts());
            give_up(sheet);
            if (whole) medium == Medium::png ? void(sheet.image()) : void(sheet.bytes());
        };
        EXPECT_THROW(draw(true), std::runtime_error);
        EXPECT_THROW(draw(false), std::runtime_error);
    }
}

}  // namespace
}  // namespace beamcam::render
