#include "render/layout.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "render/canvas.hpp"
#include "render/chart.hpp"
#include "render/labels.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

struct Size {
    int w, h;
};
void PrintTo(Size s, std::ostream* out) { *out << s.w << "x" << s.h; }

const PanelSpec kAngle{.kind = PanelKind::strip, .channels = {{sim::ChannelKind::theta, 0}}},
    kForce{.kind = PanelKind::strip, .channels = {{sim::ChannelKind::contact_force, 0}}};
const std::vector<PanelSpec> kAll{kAngle, kForce, {.kind = PanelKind::close_up}};

class AnySize : public testing::TestWithParam<Size> {};

std::vector<Box> parts(const Layout& l) {
    std::vector<Box> out;
    for (const auto& part : {l.title, l.parameters, l.clock, l.scales, l.note})
        if (part) out.push_back(*part);
    for (const PanelSlot& p : l.panels) out.push_back(p.box);
    return out;
}

TEST_P(AnySize, PartsStandWithinThePictureAndApart) {
    const auto [w, h] = GetParam();
    const Layout l = layout(w, h, kAll);
    const std::vector<Box> all = parts(l);
    if (all.size() == 1) return;  // the mechanism alone may fill the picture
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_TRUE(Box(0, 0, w, h).contains(all[i], 1)) << i;
        EXPECT_GT(all[i].w, 0);
        EXPECT_GT(all[i].h, 0);
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_FALSE(all[i].inset(1).overlaps(all[j].inset(1))) << i << " and " << j;
    }
}

TEST_P(AnySize, PlotsStandWithinTheirSlots) {
    const Layout l = layout(GetParam().w, GetParam().h, kAll);
    for (const PanelSlot& c : l.panels) {
        if (c.spec.kind == PanelKind::mechanism) continue;
        const Box plot = plot_area(c.box, l.unit);
        EXPECT_TRUE(c.box.contains(plot, 1));
        EXPECT_GT(plot.h, 40);
        EXPECT_GT(plot.w, 100);
    }
}

TEST_P(AnySize, TextKeepsWithinThePictureAndApart) {
    FilmSetup setup = test::synthetic_film({.duration = 0.7});
    setup.title = "A very long title that no picture can show whole, with <markup> & more: " + std::string(300, 'W');
    setup.width = GetParam().w, setup.height = GetParam().h;
    setup.view.style = Style::flat;
    Film film(std::move(setup));
    for (int frame : {0, 18, 41}) {
        const std::vector<Box> texts = film.geometry(frame).texts;
        for (std::size_t i = 0; i < texts.size(); ++i) {
            EXPECT_TRUE(Box(0, 0, GetParam().w, GetParam().h).contains(texts[i], 0.5)) << frame << ": " << i;
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_FALSE(texts[i].overlaps(texts[j]))
                    << "frame " << frame << ": texts " << i << " and " << j << " at " << texts[i].x << "," << texts[i].y
                    << " and " << texts[j].x << "," << texts[j].y;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, AnySize,
                         testing::Values(Size{1920, 1080}, Size{1280, 720}, Size{1080, 1080}, Size{1080, 1920},
                                         Size{3840, 2160}, Size{640, 360}, Size{321, 241}, Size{1001, 777},
                                         Size{1600, 400}, Size{500, 1500}, Size{200, 200}, Size{64, 48}, Size{16, 16},
                                         Size{1, 1}));

TEST(Layout, FullSizeShowsEverything) {
    const Layout l = layout(1920, 1080, kAll);
    EXPECT_EQ(l.panels.size(), 4U);
    EXPECT_TRUE(l.title && l.parameters && l.clock && l.scales && l.note);
    EXPECT_DOUBLE_EQ(l.unit, 1);
}

TEST(Layout, TinyPicturesKeepTheMechanism) {
    const Layout l = layout(16, 16, kAll);
    ASSERT_EQ(l.panels.size(), 1U);
    EXPECT_FALSE(l.title);
    EXPECT_GT(l.panels.front().box.w, 4);
}

TEST(Labels, ClockShowsADifferenceBetweenNeighbouringFrames) {
    const TimeFormat f = time_format({0, 1 / 60.0, 2 / 60.0, 10});
    EXPECT_EQ(f.decimals, 3);
    EXPECT_NE(clock_text(f, 1 / 60.0, 1), clock_text(f, 2 / 60.0, 1));
    const TimeFormat slow = time_format({0.01, 0.01001, 0.0102});
    EXPECT_STREQ(slow.symbol, "ms");
    EXPECT_NE(clock_text(slow, 0.01, 1), clock_text(slow, 0.01001, 1));
}

TEST(Labels, LargeNumbersArePowersOfTen) {
    EXPECT_EQ(power_text(1e8), "10<sup>8</sup>");
    EXPECT_EQ(power_text(2.5e7), "2.5·10<sup>7</sup>");
    EXPECT_EQ(power_text(200), "200");
    EXPECT_EQ(power_text(3e-10), "3·10<sup>−10</sup>");
}

TEST(Chart, DecimationKeepsTheExtremesOfEveryColumn) {
    std::vector<double> t, v;
    for (int i = 0; i < 100000; ++i) t.push_back(i / 100000.0), v.push_back(std::sin(i * 0.37) * i);
    v[54321] = 1e7;
    const auto points = decimate(t, v, [](double x, double y) { return Vec2{100 * x, y}; });
    EXPECT_LE(points.size(), 4U * 101);
    double most = 0;
    for (Vec2 p : points) most = std::max(most, p.y);
    EXPECT_EQ(most, 1e7);
    for (std::size_t i = 1; i < points.size(); ++i) EXPECT_GE(points[i].x, points[i - 1].x);
}

TEST(Chart, DecimationBreaksTheLineWhereNothingIsDefined) {
    const double nan = std::nan("");
    const auto points =
        decimate(std::vector{0.0, 1.0, 2.0, 3.0}, std::vector{1.0, nan, nan, 2.0}, [](double x, double y) {
            return Vec2{x, y};
        });
    ASSERT_EQ(points.size(), 3U);
    EXPECT_TRUE(std::isnan(points[1].x));
}

// What of a wanted grid finds no room is told, so that it can be said.
TEST(Layout, PanelsWithoutRoomAreNamed) {
    using Kind = LayoutNode::Kind;
    LayoutNode side{.kind = Kind::rows};
    for (const PanelSpec& panel : kAll) side.children.push_back({.panel = panel});
    const LayoutNode grid{.kind = Kind::columns, .children = {{.panel = {.kind = PanelKind::mechanism}}, side}};
    EXPECT_EQ(panels_of(grid).size(), 4u);
    EXPECT_TRUE(left_out(1920, 1080, grid).empty());
    EXPECT_EQ(left_out(640, 300, grid), (std::vector<PanelSpec>{{.kind = PanelKind::close_up}}));
    EXPECT_EQ(left_out(100, 100, grid).size() + layout(100, 100, grid).panels.size(), 4u);
}

}  // namespace
}  // namespace beamcam::render
