#include "render/draw/area.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "render/draw/image.hpp"

namespace beamcam::render {
namespace {

constexpr Color kBlack{0, 0, 0, 1}, kWhite{1, 1, 1, 1};
using std::numbers::pi;

struct Picture : Image {
    using Image::Image;
    PixelView view() { return {pixels.data(), width, height, width}; }
    double covered(int x, int y) const {  // by an opaque ink on nothing
        return double(pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)] >> 24) / 255;
    }
    double covered() const {
        double all = 0;
        for (std::uint32_t pixel : pixels) all += double(pixel >> 24) / 255;
        return all;
    }
};

std::vector<Vec2> rectangle(double x, double y, double w, double h) {
    return {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
}
std::vector<Vec2> turned(std::vector<Vec2> corners, Vec2 about, double angle) {
    for (Vec2& p : corners) {
        const Vec2 d = p - about;
        p = about + Vec2{d.x * std::cos(angle) - d.y * std::sin(angle), d.x * std::sin(angle) + d.y * std::cos(angle)};
    }
    return corners;
}

Picture painted(const Area& area, int width = 200, int height = 150) {
    Picture picture(width, height);
    area.paint(picture.view(), kBlack, nullptr);
    return picture;
}

TEST(Area, CoversEachPixelByItsShare) {
    Area area;
    area.add(rectangle(10.25, 20.5, 30.5, 4.75));
    const Picture p = painted(area);
    EXPECT_NEAR(p.covered(10, 20), 0.75 * 0.5, 1.0 / 255);
    EXPECT_NEAR(p.covered(20, 20), 0.5, 1.0 / 255);
    EXPECT_NEAR(p.covered(40, 20), 0.75 * 0.5, 1.0 / 255);
    EXPECT_NEAR(p.covered(10, 22), 0.75, 1.0 / 255);
    EXPECT_EQ(p.covered(20, 22), 1);
    EXPECT_NEAR(p.covered(20, 25), 0.25, 1.0 / 255);
    for (auto [x, y] : {std::pair{9, 22}, {41, 22}, {20, 19}, {20, 26}}) EXPECT_EQ(p.covered(x, y), 0) << x << ' ' << y;
}

// Half of a pixel under a diagonal, an eighth in its corner.
TEST(Area, CutsPixelsAtAnyAngle) {
    Area area;
    area.add(std::vector<Vec2>{{10, 10}, {20, 10}, {10, 20}});
    area.add(std::vector<Vec2>{{30, 10}, {30.5, 10}, {30, 10.5}});
    area.add(std::vector<Vec2>{{40, 10}, {48, 10}, {40, 11}});  // less steep than one row in a pixel
    const Picture p = painted(area);
    for (int i = 0; i < 10; ++i) EXPECT_NEAR(p.covered(10 + i, 19 - i), 0.5, 1.0 / 255) << i;
    EXPECT_NEAR(p.covered(30, 10), 0.125, 1.0 / 255);
    for (int i = 0; i < 8; ++i) EXPECT_NEAR(p.covered(40 + i, 10), (15.0 - 2 * i) / 16, 1.0 / 255) << i;
}

TEST(Area, SumsToTheAreaWhereverAndHoweverItLies) {
    for (double angle = 0; angle < 6.3; angle += 0.37)
        for (bool backwards : {false, true}) {
            Area bar, disc, ring;
            std::vector<Vec2> corners = turned(rectangle(40.3, 60.8, 110, 17.4), {95.1, 70.2}, angle);
            if (backwards) std::reverse(corners.begin(), corners.end());
            bar.add(corners);
            EXPECT_NEAR(painted(bar).covered(), 110 * 17.4, 1) << angle;
            const Vec2 centre{95 + angle, 70 - angle / 3};
            disc.add_circle(centre, 41.7);
            disc.cut_circle(centre + Vec2{9, 3}, 10.1);
            EXPECT_NEAR(painted(disc).covered(), pi * (41.7 * 41.7 - 10.1 * 10.1), 2) << angle;
            ring.add_circle(centre, 50);
            ring.cut_circle(centre, 48);
            EXPECT_NEAR(painted(ring).covered(), pi * (50 * 50 - 48 * 48), 2) << angle;
        }
}

// Polygons of circles of any size deviate by less than a visible amount.
TEST(Area, CirclesAreRound) {
    for (double radius : {0.4, 3.0, 70.0, 700.0, 9000.0}) {
        Area whole, inner;
        whole.add_circle({radius + 0.5, 75}, radius);
        const Picture p = painted(whole, 40, 150);
        for (int y = 0; y < 150; ++y) {
            double row = 0, exact = 0;
            for (int x = 0; x < 40; ++x) row += p.covered(x, y);
            for (double part = 0.05; part < 1; part += 0.1) {
                const double up = y + part - 75, half = std::sqrt(std::max(0.0, radius * radius - up * up));
                exact += 0.1 * std::max(0.0, std::min(40.0, radius + 0.5 + half) - std::max(0.0, radius + 0.5 - half));
            }
            ASSERT_NEAR(row, exact, radius < 2 ? 0.25 : 0.12) << radius << ' ' << y;
        }
    }
}

// A clipped picture has the pixels of the full picture.
TEST(Area, KeepsToThePicture) {
    for (double angle = 0; angle < 3.2; angle += 0.23) {
        const auto area_at = [&](Vec2 by) {
            Area area;
            area.add(turned(rectangle(-150 - by.x, 80 - by.y, 700, 60), Vec2{200, 110} - by, angle));
            area.cut_circle(Vec2{200, 110} - by, 20);
            return area;
        };
        const Picture whole = painted(area_at({0, 0}), 400, 300), part = painted(area_at({130, 70}), 150, 100);
        for (int y = 0; y < 100; ++y)
            for (int x = 0; x < 150; ++x)
                ASSERT_NEAR(part.covered(x, y), whole.covered(x + 130, y + 70), 0.02) << angle << ' ' << x << ' ' << y;
    }
}

TEST(Area, TakesAnyNumbers) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
    Area nothing;
    nothing.add({});
    nothing.add(std::vector<Vec2>{{10, 10}, {kNan, 20}, {30, 30}});
    nothing.add(std::vector<Vec2>{{10, 10}, {kInf, 20}, {30, 30}});
    nothing.add(std::vector<Vec2>{{10, 10}, {20, 10}});
    nothing.add_circle({50, 50}, 0);
    nothing.add_circle({50, 50}, -3);
    nothing.add_circle({50, 50}, kNan);
    EXPECT_EQ(painted(nothing).covered(), 0);
    Area all;
    all.add(rectangle(-1e15, -1e15, 2e15, 2e15));
    EXPECT_EQ(painted(all).covered(), 200 * 150);
    for (double far : {-1e9, 1e9, 1e300}) {
        Area beyond;
        beyond.add(rectangle(far, 20, 50, 50));
        beyond.add(rectangle(20, far, 50, 50));
        EXPECT_EQ(painted(beyond).covered(), 0) << far;
    }
    Picture none(0, 0);
    all.paint(none.view(), kBlack, nullptr);
}

TEST(Area, PaintsOverWhatIsThere) {
    Picture p(4, 1);
    std::fill(p.pixels.begin(), p.pixels.end(), 0xff0000ffU);
    Area area;
    area.add(rectangle(0.5, 0, 2.5, 1));
    area.paint(p.view(), kWhite, nullptr);
    EXPECT_EQ(p.pixels[1], 0xffffffffU);
    EXPECT_EQ(p.pixels[3], 0xff0000ffU);
    EXPECT_NEAR(double(p.pixels[0] >> 16 & 0xff), 127.5, 1);
    EXPECT_EQ(p.pixels[0] & 0xff0000ffU, 0xff0000ffU);
}

// The reported tiles contain all painted pixels.
TEST(Area, TellsWhereItPainted) {
    for (double angle = 0; angle < 3.2; angle += 0.31) {
        Picture before(400, 300);
        for (std::size_t i = 0; i < before.pixels.size(); ++i) before.pixels[i] = 0xff000000U | std::uint32_t(i);
        Picture after = before;
        DirtyTiles touched(400, 300);
        Area area;
        area.add(turned(rectangle(60, 140, 500, 9), {200, 150}, angle));
        area.add_circle({80, 90}, 33);
        area.paint(after.view(), kBlack, &touched);
        EXPECT_NE(after, before);
        int tiles = 0;
        touched.for_each_run([&](int left, int, int right, int) { tiles += (right - left) / DirtyTiles::kWidth; });
        EXPECT_LT(tiles, 140);  // of 13 × 19
        copy(before, after, touched);
        EXPECT_EQ(after, before) << angle;
    }
}

// Each pixel of a fan belongs to exactly one quadrilateral, as additive colours show.
TEST(Quadrilaterals, LeaveNoSeamAndDoNotOverlap) {
    for (double angle = 0; angle < 6.3; angle += 0.21) {
        Picture owner(300, 300);
        std::vector<Vec2> inner, outer;
        for (int i = 0; i <= 12; ++i) {
            const double a = angle + 0.15 * i;
            inner.push_back({150 + 60 * std::cos(a), 150 + 60 * std::sin(a)});
            outer.push_back({150 + 130 * std::cos(a), 150 + 130 * std::sin(a)});
        }
        double area = 0;
        long pixels = 0;
        for (std::size_t i = 0; i < 12; ++i) {
            Picture one(300, 300);
            paint_quadrilateral({inner[i], inner[i + 1], outer[i + 1], outer[i]}, one.view(), kBlack, nullptr);
            for (std::size_t k = 0; k < one.pixels.size(); ++k) {
                if (one.pixels[k] == 0) continue;
                ASSERT_EQ(owner.pixels[k], 0U) << angle << ' ' << k;
                owner.pixels[k] = 1;
                ++pixels;
            }
            area += 0.5 * std::sin(0.15) * (130 * 130 - 60 * 60);
        }
        EXPECT_NEAR(double(pixels), area, 0.01 * area);
        Area whole;
        std::vector<Vec2> around = inner;
        around.insert(around.end(), outer.rbegin(), outer.rend());
        whole.add(around);
        const Picture all = painted(whole, 300, 300);
        for (int y = 0; y < 300; ++y)
            for (int x = 0; x < 300; ++x)
                if (all.covered(x, y) == 1) {
                    ASSERT_EQ(owner.pixels[std::size_t(300 * y + x)], 1U) << x << ' ' << y;
                }
    }
}

TEST(Quadrilaterals, StayInsideThePictureAndReportTheirTiles) {
    Picture p(100, 80);
    DirtyTiles touched(100, 80);
    paint_quadrilateral({Vec2{-50, -50}, {400, -20}, {150, 300}, {-1e12, 90}}, p.view(), kBlack, &touched);
    EXPECT_EQ(p.covered(), 100 * 80);
    copy(Picture(100, 80), p, touched);
    EXPECT_EQ(p.covered(), 0);
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    paint_quadrilateral({Vec2{kNan, kNan}, {kNan, 20}, {50, kNan}, {kNan, 1}}, p.view(), kBlack, &touched);
    EXPECT_EQ(p.covered(), 0);
}

}  // namespace
}  // namespace beamcam::render
