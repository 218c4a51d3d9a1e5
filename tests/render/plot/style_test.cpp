#include "render/plot/style.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace beamcam::render::figure {
namespace {

// A spectrum of exponents has many curves.
TEST(Looks, OfSixtyFourCurvesAreAllDifferent) {
    std::set<std::pair<std::string, std::vector<double>>> seen;
    for (int k = 0; k < 64; ++k) {
        const LineStyle& each = look(k);
        EXPECT_TRUE(each.color == look(k % 8).color) << k;
        EXPECT_TRUE(seen.emplace(fmt::format("{} {} {}", each.color.r, each.color.g, each.color.b), each.dash).second)
            << k;
    }
}

TEST(FigureStyle, TheColourMapDarkensEvenly) {
    // Lightness L* from linear sRGB luminance; equal steps of the map differ in L* by nearly the same.
    const auto lightness = [](Color c) {
        const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
        return 116 * std::cbrt(0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b)) - 16;
    };
    for (double s = 0; s < 0.999; s += 0.1) {
        const double step = lightness(map_color(s)) - lightness(map_color(s + 0.1));
        EXPECT_GT(step, 4);
        EXPECT_LT(step, 10);
    }
}

}  // namespace
}  // namespace beamcam::render::figure
