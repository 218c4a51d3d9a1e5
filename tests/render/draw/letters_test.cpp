// Which fonts write the letters of a text.
#include <gtest/gtest.h>

#include <vector>

#include "render/draw/canvas.hpp"
#include "render/draw/fonts.hpp"

namespace beamcam::render {
namespace {

// The fonts of mathematics have a few letters and brackets of these scripts, as U+306E. In the font of these scripts
// all of them are squares.
TEST(Letters, OfChineseAndJapaneseComeFromOneFont) {
    for (const Typefaces typefaces : {Typefaces::screen, Typefaces::print, Typefaces::serif}) {
        const Fonts loaded(true, typefaces);
        Image image(10, 10);
        const Canvas canvas(image, loaded);
        std::vector<const char*> letters{"ビ", "の", "衝", "梁", "〒", "「"};
        if (typefaces == Typefaces::screen) letters.insert(letters.end(), {"〈", "〉", "《", "〔"});
        for (const char* letter : letters)
            EXPECT_NEAR(canvas.measure(letter, {.size = 40}).w, 40, 0.3) << letter << static_cast<int>(typefaces);
    }
}

TEST(Letters, OfOtherScriptsBesideThemKeepTheirFont) {
    const Fonts with(true), without(false);
    Image image(10, 10);
    EXPECT_NEAR(Canvas(image, with).measure("Beamの", {.size = 40}).w,
                Canvas(image, without).measure("Beam", {.size = 40}).w + 40, 0.1);
}

}  // namespace
}  // namespace beamcam::render
