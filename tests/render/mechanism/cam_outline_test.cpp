#include "render/mechanism/cam_outline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/cam/cam_shape.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::render {
namespace {

// A nose of 0.05 mm on a cam of 30 mm: the radius of curvature changes by a factor of 600 along the outline.
TEST(CamOutline, PointsOfACamWithASharpNoseAreAtEqualDistances) {
    sim::Problem problem;
    const double big = 0.03, nose = 5e-5, apart = 0.04, flank = 0.2;
    const sim::Vec2 far{apart, 0};
    // Two arcs of a large radius join base circle and nose.
    const double reach = flank - big, to_nose = flank - nose;
    const double x = (reach * reach - to_nose * to_nose + apart * apart) / (2 * apart),
                 y = std::sqrt(reach * reach - x * x);
    problem.cam->profile = sim::ArcsProfile{{{{0, 0}, big}, {{x, y}, flank}, {far, nose}, {{x, -y}, flank}}};
    const auto shape = sim::cam_shape(problem);
    for (const int count : {97, 300, 301}) {
        const CamOutline outline = cam_outline(problem, count);
        const double step = shape->arc(sim::kFullTurn) / count;
        for (std::size_t i = 0; i < outline.points.size(); ++i) {
            const sim::Vec2 along = outline.points[(i + 1) % outline.points.size()] - outline.points[i];
            EXPECT_LE(norm(along), 1.001 * step) << i << " of " << count;
            EXPECT_GE(norm(along), 0.5 * step) << i << " of " << count;  // around the nose a chord is shorter
        }
    }
}

}  // namespace
}  // namespace beamcam::render
