// `beamcam sheet`: pictures of a film in one picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "output/image/png_reader.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Folder, testing::shell;

// Red, then green, then blue, two frames each, without loss.
void make_film(const Folder& folder, const char* file) {
    const std::string colors =
        "for c in red green blue; do ffmpeg -v error -f lavfi -i color=$c:size=64x32:rate=2:duration=1 -c:v png "
        "$c.mov; "
        "echo \"file $c.mov\" >> list; done; ffmpeg -v error -f concat -i list -c copy ";
    ASSERT_EQ(shell(folder, colors + file).code, 0);
}

TEST(Sheet, HasPicturesEvenlyOverTheFilmItsFirstAndLastAmongThem) {
    const Folder folder;
    make_film(folder, "film.mov");
    ASSERT_EQ(shell(folder, "$BEAMCAM sheet film.mov --count 3 --columns 2 --width 320 -o s.png").code, 0);
    const output::Raster sheet = output::read_png(folder / "s.png");
    // Two columns of 157 pixels between gaps of 2; two rows of half that, with words below.
    EXPECT_EQ(sheet.width, 320);
    EXPECT_EQ(sheet.height, 2 + 2 * (79 + 12 + 2));
    const auto color_at = [&](int x, int y) {
        const std::uint8_t* p = sheet.at(x, y);
        return std::vector<int>{p[0] / 64, p[1] / 64, p[2] / 64};
    };
    EXPECT_EQ(color_at(80, 40), (std::vector<int>{3, 0, 0}));
    EXPECT_EQ(color_at(240, 40), (std::vector<int>{0, 1, 0}));  // "green" is half of full green
    EXPECT_EQ(color_at(80, 130), (std::vector<int>{0, 0, 3}));
    EXPECT_EQ(color_at(240, 130), (std::vector<int>{3, 3, 3}));
}

TEST(Sheet, OfAShortFilmHasNoMorePicturesThanItHas) {
    const Folder folder;
    make_film(folder, "film.mov");
    ASSERT_EQ(shell(folder, "$BEAMCAM sheet film.mov --count 100 --columns 10 -o s.png").code, 0);
    EXPECT_EQ(output::read_png(folder / "s.png").width, 1920);
    EXPECT_EQ(shell(folder, "$BEAMCAM sheet film.mov -o s.jpg").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM sheet none.mov -o s2.png").code, 6);
    folder.write("mine.png", "mine");
    EXPECT_EQ(shell(folder, "$BEAMCAM sheet film.mov -o mine.png").code, 6);
}

}  // namespace
}  // namespace beamcam::scenes
