#include "render/draw/color.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace beamcam::render {
namespace {

// Smallest distance in CIELAB with normal vision and each dichromacy (Machado, Oliveira and Fernandes 2009).
double seen_apart(Color a, Color b) {
    using Matrix = std::array<std::array<double, 3>, 3>;
    static constexpr std::array<Matrix, 4> kSights{{
        {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
        {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
        {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
        {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}},
    }};
    const auto lab = [](Color c, const Matrix& m) {
        const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
        const double in[] = {linear(c.r), linear(c.g), linear(c.b)};
        double v[3];
        for (std::size_t i = 0; i < 3; ++i)
            v[i] = std::clamp(m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2], 0.0, 1.0);
        const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
        const double x = f((0.4124 * v[0] + 0.3576 * v[1] + 0.1805 * v[2]) / 0.9505),
                     y = f(0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]),
                     z = f((0.0193 * v[0] + 0.1192 * v[1] + 0.9505 * v[2]) / 1.089);
        return std::array{116 * y - 16, 500 * (x - y), 200 * (y - z)};
    };
    double least = 1e300;
    for (const Matrix& m : kSights) {
        const auto p = lab(a, m), q = lab(b, m);
        least = std::min(least, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
    return least;
}

// A distance of ten is clearly visible side by side.
TEST(Colors, EightMotionsAreToldApartByEverybody) {
    for (const Theme theme : {Theme::light, Theme::dark, Theme::print})
        for (std::size_t i = 0; i < 8; ++i)
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_GT(seen_apart(series_color(palette(theme), i), series_color(palette(theme), k)), 15)
                    << i << " and " << k;
}

TEST(Colors, WordsStandOutFromThePaper) {
    for (Theme theme : {Theme::light, Theme::dark, Theme::print}) {
        const Palette& p = palette(theme);
        const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
        const auto light = [&](Color c) {
            return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b) + 0.05;
        };
        for (double share : {0.0, 0.2, 0.45, 0.7, 1.0}) {
            const Color words = readable(p, mix(p.paper, p.motion, share));
            EXPECT_GE(std::max(light(words), light(p.paper)) / std::min(light(words), light(p.paper)), 2.999) << share;
        }
        EXPECT_EQ(readable(p, p.ink).r, p.ink.r);
        EXPECT_EQ(readable(p, p.contact).r, p.contact.r);  // strong enough as it is
    }
}

// Text is readable on any paper, and pale colours are visible.
TEST(Colors, ThePaperOfAnyColourKeepsTextReadable) {
    for (const Theme theme : {Theme::light, Theme::dark, Theme::print})
        for (const std::uint32_t paper : {0x7A7A7AU, 0x003355U, 0xF4F1EAU, 0x000000U, 0xFFFFFFU, 0xFFCC00U}) {
            const Palette p = on_paper(palette(theme), rgb(paper));
            EXPECT_EQ(p.paper, rgb(paper));
            EXPECT_GE(contrast(p.ink, p.paper), 4.5) << paper;
            EXPECT_GE(contrast(p.muted, p.paper), 4.5) << paper;
            EXPECT_GT(contrast(p.grid, p.paper), 1.05) << paper;
        }
    const Palette& light = palette(Theme::light);
    const Palette same = on_paper(light, light.paper);
    EXPECT_EQ(same.ink, light.ink);
    EXPECT_NEAR(same.grid.r, light.grid.r, 0.02);
}

}  // namespace
}  // namespace beamcam::render
