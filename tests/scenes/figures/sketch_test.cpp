// The symbols R, ω, e, B and C of a disc keep apart for any cam, and are inside the disc.
#include "scenes/figures/sketch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace beamcam::scenes {
namespace {

using sim::Vec2;

TEST(Sketch, SymbolsOfADiscKeepApart) {
    constexpr double kLetter = 0.2;  // in radii of the disc
    for (const double eccentricity : {0.02, 0.05, 0.08, 0.09})
        for (int k = 0; k < 8; ++k) {
            sim::Cam cam;
            cam.radius = 0.1, cam.eccentricity = eccentricity, cam.phase = 0.3 + 0.785 * k;
            Sketch sketch;
            draw_disc_symbols(cam, {0, 0}, 10, kLetter, sketch);  // of radius 1
            std::vector<Vec2> labels, turn;
            for (const Sketch::Shape& shape : sketch.take()) {
                if (shape.kind == Sketch::Kind::label) labels.push_back(shape.points[0] + kLetter * shape.shift);
                for (int i = 0; shape.kind == Sketch::Kind::turn && i <= 40; ++i)
                    turn.push_back(shape.radius * sim::unit(shape.from + (shape.to - shape.from) * i / 40));
            }
            ASSERT_EQ(labels.size(), 5U);
            ASSERT_FALSE(turn.empty());
            double least = 1, outermost = 0;
            for (std::size_t a = 0; a < labels.size(); ++a) {
                outermost = std::max(outermost, norm(labels[a]));
                for (std::size_t b = 0; b < a; ++b) least = std::min(least, norm(labels[a] - labels[b]));
                for (const Vec2 p : turn) least = std::min(least, norm(labels[a] - p));
            }
            const Vec2 c = -10 * eccentricity * sim::unit(cam.phase);
            for (const Vec2 p : turn) least = std::min(least, norm(c - p) + 0.3 * kLetter);
            EXPECT_GT(least, 0.6 * kLetter) << eccentricity << ", " << k;
            EXPECT_LT(outermost, 1 - 0.4 * kLetter) << eccentricity << ", " << k;
        }
}

}  // namespace
}  // namespace beamcam::scenes
