// `beamcam hash` as scripts meet it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Folder, testing::shell;

TEST(Hash, IsThatOfFfmpegOfTheDecodedPixels) {
    const Folder folder;
    const auto made = shell(folder,
                            "ffmpeg -v error -f lavfi -i testsrc=size=64x48:duration=1 -frames:v 1 a.png; "
                            "ffmpeg -v error -i a.png -compression_level 0 b.png; "
                            "ffmpeg -v error -i a.png -pix_fmt rgba -f hash -hash sha256 - | sed 's/.*=//'");
    ASSERT_EQ(made.code, 0) << made.err;
    const std::string digest = made.out.substr(0, 64);
    EXPECT_EQ(shell(folder, "$BEAMCAM hash a.png b.png").out, digest + "  a.png\n" + digest + "  b.png\n");
}

TEST(Hash, RejectsOtherFilesWithSixAndHashesTheRest) {
    const Folder folder;
    folder.write("text.png", "no picture");
    shell(folder, "ffmpeg -v error -f lavfi -i testsrc=size=64x48:duration=1 -frames:v 1 a.png");
    const auto hashed = shell(folder, "$BEAMCAM hash text.png absent.png a.png");
    EXPECT_EQ(hashed.code, 6) << hashed.err;
    EXPECT_THAT(hashed.out, ::testing::EndsWith("  a.png\n"));
}

}  // namespace
}  // namespace beamcam::scenes
