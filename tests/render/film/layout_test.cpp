#include "render/film/layout.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "render/draw/canvas.hpp"
#include "render/plot/chart.hpp"
#include "render/plot/labels.hpp"
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
    for (const auto& part : {l.title, l.parameters, l.clock, l.scales, l.warning})
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
        EXPECT_TRUE((Box{0, 0, 1.0 * w, 1.0 * h}.contains(all[i], 1))) << i;
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
        const Box plot = plot_area(c.box, l.unit, l.letters.words);
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
            EXPECT_TRUE((Box{0, 0, 1.0 * GetParam().w, 1.0 * GetParam().h}.contains(texts[i], 0.5)))
                << frame << ": " << i;
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

TEST(Layout, LettersHaveThreeSizes) {
    const auto letters = [](int w, int h) { return layout(w, h, std::vector<PanelSpec>{}).letters; };
    EXPECT_NEAR(letters(1280, 720).title, 34, 1e-9);
    EXPECT_NEAR(letters(1280, 720).heading, 20, 1e-9);
    EXPECT_NEAR(letters(1280, 720).words, 16, 1e-9);
    for (const auto& [w, h] : {std::pair{1920, 1080}, {2560, 1440}, {3840, 2160}, {854, 480}, {640, 360}})
        EXPECT_GE(letters(w, h).words, 0.022 * h) << w << "x" << h;
    // In square and portrait pictures, of the width.
    for (const auto& [w, h] : {std::pair{1080, 1920}, {1080, 1080}, {720, 1280}})
        EXPECT_GE(letters(w, h).words, 0.022 * w) << w << "x" << h;
    EXPECT_NEAR(letters(1080, 1920).words, 1.5 * letters(1280, 720).words, 1e-9);
    EXPECT_EQ(letters(64, 48).words, kReadable);
    const Layout usual = layout(1920, 1080, std::vector<PanelSpec>{}),
                 large = layout(1920, 1080, std::vector<PanelSpec>{}, 1, {}, {.size = 1.3});
    EXPECT_NEAR(large.letters.words, 1.3 * usual.letters.words, 1e-9);
    // Larger labels shrink the plot and do not overlap.
    const Box box{0, 0, 600, 300};
    EXPECT_LT(plot_area(box, 1, 22).w, plot_area(box, 1, 17).w);
    EXPECT_LT(plot_area(box, 1, 22).bottom(), plot_area(box, 1, 17).bottom());
}

TEST(Layout, FullSizeShowsEverything) {
    const Layout l = layout(1920, 1080, kAll);
    EXPECT_EQ(l.panels.size(), 4U);
    EXPECT_TRUE(l.title && l.parameters && l.clock && l.scales && l.warning);
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

// Freezes at round times cause steps of rounding size, and one irregular step each.
// A film of one frame states its instant in the unit of its charts.
TEST(Labels, TheUnitOfTimeSuitsTheCharts) {
    EXPECT_STREQ(time_format({0}, 0.02).symbol, "ms");
    EXPECT_STREQ(time_format({0}, 2).symbol, "s");
    EXPECT_STREQ(time_format({0.01}, 0.05).symbol, "ms");
}

TEST(Labels, AStillShowsTheDigitsOfARoundInstantAndFourOfAnEvents) {
    EXPECT_EQ(time_format({0.28}, 1).decimals, 2);
    EXPECT_EQ(time_format({0.2815}, 1).decimals, 4);
    EXPECT_EQ(time_format({0.281525}, 1).decimals, 6);
    EXPECT_EQ(time_format({0.28152518347}, 1).decimals, 4);
}

TEST(Labels, FreezesLeaveTheClockItsThreeDecimals) {
    std::vector<double> times;
    for (int k = 0; k < 30; ++k) {
        times.push_back(k / 30.0);
        if (k % 10 == 3) times.insert(times.end(), 15, k / 30.0 + 1e-16 + (k == 13 ? 1e-7 : 0));
    }
    EXPECT_EQ(time_format(times).decimals, 3);
}

// Slow motion needs more than three decimals only if its frames are less than a millisecond apart.
TEST(Labels, TheClockHasNoMoreDecimalsThanItNeeds) {
    const auto decimals = [](double step) { return time_format({0.2, 0.2 + step, 0.2 + 2 * step}).decimals; };
    EXPECT_EQ(decimals(0.1), 2);
    EXPECT_EQ(decimals(1 / 60.0), 3);
    EXPECT_EQ(decimals(0.0033), 3);
    EXPECT_EQ(decimals(0.0005), 4);
}

TEST(Labels, SpeedsOfRotationAreWrittenAsTheUserWroteThem) {
    EXPECT_EQ(turning_speed(0.5, SpeedUnit::automatic), "0.5\u00A0rad/s");
    EXPECT_EQ(turning_speed(-10 * std::numbers::pi, SpeedUnit::rpm), "−300\u00A0rpm");
    EXPECT_EQ(turning_speed(-std::numbers::pi / 6, SpeedUnit::degrees), "−30°/s");
    EXPECT_EQ(turning_speed(0, SpeedUnit::automatic), "0\u00A0rad/s");
}

TEST(Layout, WhatIsNotShownLeavesItsRoomToThePanels) {
    const Layout all = layout(1920, 1080, kAll);
    const Layout none = layout(1920, 1080, kAll, 1, {}, {false, false, false, false, false, false});
    EXPECT_FALSE(none.title || none.parameters || none.clock || none.scales || none.warning);
    EXPECT_GT(none.panels.front().box.h, all.panels.front().box.h + 150);
    const Layout untitled = layout(1920, 1080, kAll, 1, {}, {.title = false});
    EXPECT_NEAR(untitled.panels.front().box.y, all.panels.front().box.y - 64, 1);
    EXPECT_TRUE(layout(1920, 1080, kAll, 1, {}, {.clock = false}).clock);  // its pills belong to the legend
}

TEST(Labels, LargeNumbersArePowersOfTen) {
    EXPECT_EQ(power_text(1e8), "10^{8}");
    EXPECT_EQ(power_text(2.5e7), "2.5·10^{7}");
    EXPECT_EQ(power_text(200), "200");
    EXPECT_EQ(power_text(3e-10), "3·10^{−10}");
}

// Panels of a grid without space are reported.
TEST(Layout, PanelsWithoutRoomAreNamed) {
    using Kind = LayoutNode::Kind;
    LayoutNode side{.kind = Kind::rows};
    for (const PanelSpec& panel : kAll) side.children.push_back({.panel = panel});
    const LayoutNode grid{.kind = Kind::columns, .children = {{.panel = {.kind = PanelKind::mechanism}}, side}};
    EXPECT_EQ(panels_of(grid).size(), 4u);
    EXPECT_TRUE(omitted_panels(1920, 1080, grid).empty());
    EXPECT_EQ(omitted_panels(640, 300, grid), (std::vector<PanelSpec>{{.kind = PanelKind::close_up}}));
    EXPECT_EQ(omitted_panels(100, 100, grid).size() + layout(100, 100, grid).panels.size(), 4u);
}

// ---- the standard layout follows the extent ----------------------------------------------------

// Extent of a beam that swings between two angles, and of the paper's cam.
ViewExtent swinging(const sim::Problem& problem, double from, double to) {
    ViewExtent extent;
    extent.problems = {&problem};
    for (double angle = from; angle <= to; angle += 0.01) extent.beams.add(sim::unit(angle) * problem.beam.length);
    extent.beams.add({0, 0}, beam_depth(problem.beam));
    return extent;
}

struct Extents {
    sim::Problem paper, flat;
    std::vector<ViewExtent> all;
    Extents() {
        flat.cam->radius = 0.03, flat.cam->eccentricity = 0.005;
        all = {swinging(paper, 0.3, 0.8), swinging(paper, 1.2, 1.6), swinging(flat, 0.05, 0.12)};
    }
};

// 200 sizes from a fixed seed.
std::vector<Size> many_sizes() {
    std::vector<Size> out;
    std::uint64_t state = 88172645463325252;
    const auto next = [&](int from, int to) {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        return from + static_cast<int>(state % static_cast<std::uint64_t>(to - from));
    };
    for (int i = 0; i < 200; ++i) out.push_back({next(200, i % 4 ? 2200 : 700), next(200, i % 4 ? 2200 : 700)});
    return out;
}

TEST(Layout, PartsStandApartForAnyMotionAndSize) {
    const Extents extents;
    for (const auto [w, h] : many_sizes())
        for (const ViewExtent& extent : extents.all)
            for (int members : {1, 3, 8}) {
                const Layout l = layout(w, h, kAll, members, extent);
                const std::vector<Box> all = parts(l);
                for (std::size_t i = 0; i < all.size(); ++i) {
                    EXPECT_TRUE((Box{0, 0, 1.0 * w, 1.0 * h}.contains(all[i], 1))) << w << "x" << h << ": " << i;
                    for (std::size_t j = 0; j < i; ++j)
                        EXPECT_FALSE(all[i].inset(1).overlaps(all[j].inset(1)))
                            << w << "x" << h << ", " << members << ": " << i << " and " << j;
                }
            }
}

TEST(Layout, NoOtherArrangementShowsTheMechanismLarger) {
    using enum Arrangement;
    const Extents extents;
    int columns = 0, below = 0;
    for (const auto [w, h] : many_sizes())
        for (const ViewExtent& extent : extents.all)
            for (int members : {1, 3}) {
                const Layout l = layout(w, h, kAll, members, extent);
                const PanelSlot* side = l.first(PanelKind::strip);
                if (!side) continue;
                (side->box.x > l.first(PanelKind::mechanism)->box.right() ? columns : below) += 1;
                for (Arrangement other : {column, h > 1.35 * w ? stack : row})
                    if (const auto o = arranged(other, w, h, kAll, members, extent)) {
                        EXPECT_GE(scale_of(l, extent), scale_of(*o, extent)) << w << "x" << h;
                    }
                if (members < 3) continue;
                const Layout alone = *arranged(Arrangement::alone, w, h, kAll, members, extent);
                EXPECT_GE(scale_of(l, extent), 0.6 * scale_of(alone, extent)) << w << "x" << h;
            }
    EXPECT_GT(columns, 100);
    EXPECT_GT(below, 100);
}

// Charts get the space that the mechanism does not need, and no more.
TEST(Layout, WideChartsCostTheMechanismNothing) {
    const Extents extents;
    const Layout upright = layout(1920, 1080, kAll, 1, extents.all[1]),
                 lying = layout(1920, 1080, kAll, 1, extents.all[2]);
    EXPECT_GT(upright.first(PanelKind::strip)->box.w, 700);
    const Box narrow{0, 0, 1212, upright.first(PanelKind::mechanism)->box.h};  // beside a column of the usual width
    EXPECT_NEAR(scale_of(upright, extents.all[1]), extents.all[1].camera(narrow, 1).scale, 1e-9);
    EXPECT_GT(lying.first(PanelKind::strip)->box.y, lying.first(PanelKind::mechanism)->box.bottom());
}

TEST(Layout, SeveralMechanismsStandAsTheirMotionAsks) {
    const Extents extents;
    const auto boxes = [&](const ViewExtent& extent) {
        std::vector<Box> out;
        for (const PanelSlot& slot : layout(1920, 1080, {}, 3, extent).panels) out.push_back(slot.box);
        return out;
    };
    const std::vector<Box> upright = boxes(extents.all[1]), lying = boxes(extents.all[2]);
    ASSERT_EQ(upright.size(), 3U);
    ASSERT_EQ(lying.size(), 3U);
    EXPECT_EQ(upright[0].y, upright[2].y);
    EXPECT_EQ(lying[0].x, lying[2].x);
    for (const auto& all : {upright, lying})
        for (const Box& box : all) EXPECT_TRUE(box.w == all[0].w && box.h == all[0].h);
}

// The box of the parameters does not depend on the motion.
// Four mechanisms in a square leave no cell empty; in a very wide picture charts are not squeezed.
TEST(Layout, SeveralMechanismsUseTheArea) {
    std::vector<PanelSpec> side = standard_panels({}, false);
    const auto columns_of = [](const Layout& l) {
        std::set<double> out;
        for (const PanelSlot& slot : l.panels)
            if (slot.spec.kind == PanelKind::mechanism) out.insert(slot.box.x);
        return out.size();
    };
    ViewExtent extent;
    extent.beams.add({-0.1, -0.2}), extent.beams.add({1, 0.8});
    const sim::Problem problem;
    extent.problems.push_back(&problem);
    EXPECT_EQ(columns_of(layout(1080, 1080, side, 4, extent)), 2U);
    const Layout wide = layout(3840, 1080, side, 4, extent);
    EXPECT_GE(wide.first(PanelKind::strip)->box.w, 0.19 * 3840);
}

TEST(Layout, RoomOfTheParametersDependsOnTheSizeAlone) {
    const Extents extents;
    for (const auto [w, h] : many_sizes())
        for (const ViewExtent& extent : extents.all)
            EXPECT_EQ(layout(w, h, kAll, 1, extent).parameters, layout(w, h, kAll).parameters) << w << "x" << h;
}

// The arrow of the largest force is inside the mechanism's box.
TEST(ViewExtent, ArrowsOfForceAreSeen) {
    FilmSetup setup = test::synthetic_film({.duration = 1.5});
    setup.problem.cam->radius *= 0.3, setup.problem.cam->eccentricity *= 0.3;
    for (std::size_t k = 0; k < setup.poses.size(); ++k)
        setup.poses[k] = test::synthetic_pose(setup.problem, {}, 1.9 + double(k) / 600);
    setup.view.style = Style::flat;
    double largest = 0;
    for (const sim::Pose& pose : setup.poses) largest = std::max(largest, pose.nearest->force);
    ASSERT_GT(largest, 0);
    const std::vector<sim::Pose> poses = setup.poses;
    Film film(std::move(setup));
    for (int k = 0; k < film.frames(); k += 7) {
        const FrameGeometry g = film.geometry(k);
        const sim::Nearest& near = *poses[std::size_t(k)].nearest;
        if (!near.touching || !g.beam.contact) continue;
        const Vec2 foot = g.camera.to_pixels(g.beam.contact->on_disc);
        const double length = force_arrow_length(near.force / largest, false, g.layout.unit);
        EXPECT_GE(foot.y - g.beam.contact->normal.y * length, g.layout.first(PanelKind::mechanism)->box.y) << k;
    }
}

}  // namespace
}  // namespace beamcam::render
