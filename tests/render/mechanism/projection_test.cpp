#include "render/mechanism/projection.hpp"

#include <gtest/gtest.h>

namespace beamcam::render {
namespace {

TEST(Projection, FromTheFrontThePlaneOfMotionIsTheFlatView) {
    const Projection front = Projection::looking({400, 300}, 2000, 1, 0, 0);
    const Vec2 p = front.to_pixels({120, 50, 0});
    EXPECT_NEAR(p.x, 520, 1e-12);
    EXPECT_NEAR(p.y, 250, 1e-12);
    const Vec2 nearer = front.to_pixels({120, 50, 400});  // at four fifths of the distance
    EXPECT_NEAR(nearer.x, 400 + 150, 1e-9);
    EXPECT_NEAR(nearer.y, 300 - 62.5, 1e-9);
}

TEST(Projection, AxesAreOrthonormal) {
    const Projection p = Projection::looking({}, 1000, 1, 0.7, -0.3);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 &a = p.axes[i], &b = p.axes[j];
            EXPECT_NEAR(a.x * b.x + a.y * b.y + a.z * b.z, i == j ? 1 : 0, 1e-12);
        }
    EXPECT_GT(p.axes[2].x, 0);  // seen from the right
}

}  // namespace
}  // namespace beamcam::render
