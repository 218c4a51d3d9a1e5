#include "render/film/layout.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "render/film/view_extent.hpp"
#include "tests/render/films.hpp"
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

Layout standard_layout(int w, int h, const std::vector<PanelSpec>& side, int members = 1, const Shown& shown = {}) {
    return layout(w, h, standard_grid(w, h, side, members), shown);
}

class AnySize : public testing::TestWithParam<Size> {};

std::vector<Box> parts(const Layout& l) {
    std::vector<Box> out;
    for (const auto& part : {l.title, l.parameters, l.clock, l.scale, l.warning})
        if (part) out.push_back(*part);
    for (const PanelSlot& p : l.panels) out.push_back(p.box);
    return out;
}

TEST_P(AnySize, PartsStandWithinThePictureAndApart) {
    const auto [w, h] = GetParam();
    const Layout l = standard_layout(w, h, kAll);
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
    const Layout l = standard_layout(GetParam().w, GetParam().h, kAll);
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
    const auto letters = [](int w, int h) { return standard_layout(w, h, {}).letters; };
    EXPECT_NEAR(letters(1280, 720).title, 34, 1e-9);
    EXPECT_NEAR(letters(1280, 720).heading, 20, 1e-9);
    EXPECT_NEAR(letters(1280, 720).words, 16, 1e-9);
    for (const auto& [w, h] : {std::pair{1920, 1080}, {2560, 1440}, {3840, 2160}, {854, 480}, {640, 360}})
        EXPECT_GE(letters(w, h).words, 0.022 * h) << w << "x" << h;
    // In square and portrait pictures, of the width.
    for (const auto& [w, h] : {std::pair{1080, 1920}, {1080, 1080}, {720, 1280}})
        EXPECT_GE(letters(w, h).words, 0.022 * w) << w << "x" << h;
    EXPECT_NEAR(letters(720, 1280).words, 1.5 * letters(1280, 720).words, 1e-9);
    EXPECT_EQ(letters(64, 48).words, kReadable);
    const Layout usual = standard_layout(1920, 1080, {}), large = standard_layout(1920, 1080, {}, 1, {.size = 1.3});
    EXPECT_NEAR(large.letters.words, 1.3 * usual.letters.words, 1e-9);
    // Larger labels shrink the plot and do not overlap.
    const Box box{0, 0, 600, 300};
    EXPECT_LT(plot_area(box, 1, 22).w, plot_area(box, 1, 17).w);
    EXPECT_LT(plot_area(box, 1, 22).bottom(), plot_area(box, 1, 17).bottom());
}

TEST(Layout, FullSizeShowsEverything) {
    const Layout l = standard_layout(1920, 1080, kAll);
    EXPECT_EQ(l.panels.size(), 4U);
    EXPECT_TRUE(l.title && l.parameters && l.clock && l.scale && l.warning);
    EXPECT_DOUBLE_EQ(l.unit, 1);
}

TEST(Layout, TinyPicturesKeepTheMechanism) {
    const Layout l = standard_layout(16, 16, kAll);
    ASSERT_EQ(l.panels.size(), 1U);
    EXPECT_FALSE(l.title);
    EXPECT_GT(l.panels.front().box.w, 4);
}

TEST(Layout, WhatIsNotShownLeavesItsRoomToThePanels) {
    const Layout all = standard_layout(1920, 1080, kAll);
    const Layout none = standard_layout(1920, 1080, kAll, 1, {false, false, false, false});
    EXPECT_FALSE(none.title || none.parameters || none.clock || none.scale || none.warning);
    EXPECT_GT(none.panels.front().box.h, all.panels.front().box.h + 150);
    const Layout untitled = standard_layout(1920, 1080, kAll, 1, {.title = false});
    EXPECT_NEAR(untitled.panels.front().box.y, all.panels.front().box.y - 64, 1);
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

// ---- the standard grid ---------------------------------------------------------------------------

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

TEST(Layout, PartsStandApartInAnySize) {
    for (const auto [w, h] : many_sizes())
        for (int members : {1, 3, 8}) {
            const Layout l = standard_layout(w, h, kAll, members);
            const std::vector<Box> all = parts(l);
            for (std::size_t i = 0; i < all.size(); ++i) {
                EXPECT_TRUE((Box{0, 0, 1.0 * w, 1.0 * h}.contains(all[i], 1))) << w << "x" << h << ": " << i;
                for (std::size_t j = 0; j < i; ++j)
                    EXPECT_FALSE(all[i].inset(1).overlaps(all[j].inset(1)))
                        << w << "x" << h << ", " << members << ": " << i << " and " << j;
            }
        }
}

TEST(Layout, ChartsAreBesideTheMechanismInAWidePictureAndBelowItInOthers) {
    for (const auto& [w, h] : {std::pair{1920, 1080}, {1080, 1080}, {1080, 1920}}) {
        const Layout l = standard_layout(w, h, {kAngle, kForce});
        const Box mechanism = l.first(PanelKind::mechanism)->box, chart = l.first(PanelKind::strip)->box;
        EXPECT_EQ(l.panels.size(), 3u) << w;
        if (w > h)
            EXPECT_GT(chart.x, mechanism.right());
        else
            EXPECT_GT(chart.y, mechanism.bottom());
        EXPECT_GT(mechanism.w * mechanism.h, 2.5 * chart.w * chart.h) << w;
    }
}

// Also where a cell is left empty.
TEST(Layout, SeveralMechanismsHaveCellsOfOneSize) {
    for (const auto& [w, h] : {std::pair{1920, 1080}, {1080, 1080}, {1080, 1920}})
        for (const int members : {2, 3, 4, 5, 8}) {
            std::vector<Box> boxes;
            for (const PanelSlot& slot : standard_layout(w, h, kAll, members).panels)
                if (slot.spec.kind == PanelKind::mechanism) boxes.push_back(slot.box);
            ASSERT_EQ(std::ssize(boxes), members) << w;
            for (const Box& box : boxes) {
                EXPECT_NEAR(box.w, boxes[0].w, 1);
                EXPECT_NEAR(box.h, boxes[0].h, 1);
                EXPECT_LT(std::max(box.w / box.h, box.h / box.w), w < h && members <= 3 ? 10 : 3)
                    << w << "x" << h << ", " << members;
            }
        }
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

TEST(Layout, SharesDivideTheRoom) {
    using enum LayoutNode::Kind;
    const Layout l = layout(
        1920, 1080, grid(columns, {leaf({.kind = PanelKind::mechanism}, 3), leaf(strip(sim::ChannelKind::theta))}));
    ASSERT_EQ(l.panels.size(), 2U);
    EXPECT_NEAR(l.panels[0].box.w / l.panels[1].box.w, 3, 0.01);
    EXPECT_EQ(l.panels[0].box.h, l.panels[1].box.h);
}

TEST(Layout, PanelsTooSmallToReadLeaveTheirRoomToOthers) {
    using enum LayoutNode::Kind;
    std::vector<LayoutNode> many;
    for (int i = 0; i < 12; ++i) many.push_back(leaf(strip(sim::ChannelKind::theta)));
    const Layout l = layout(1280, 720, grid(rows, many));
    EXPECT_LT(l.panels.size(), 8U);
    EXPECT_GT(l.panels.size(), 1U);
    for (const PanelSlot& slot : l.panels) EXPECT_GE(slot.box.h, type_of(PanelKind::strip).smallest.y * l.unit - 1);
}

TEST(Layout, AGroupOfPanelsThatFindNoRoomLeavesItsOwn) {
    using enum LayoutNode::Kind;
    const LayoutNode wanted =
        grid(columns, {leaf({.kind = PanelKind::mechanism}, 3),
                       grid(rows, {leaf({.kind = PanelKind::energy}), leaf({.kind = PanelKind::phase})}, 1)});
    const Layout large = layout(1920, 1080, wanted), small = layout(400, 400, wanted);
    EXPECT_EQ(large.panels.size(), 3U);
    ASSERT_EQ(small.panels.size(), 1U);
    EXPECT_GT(small.panels[0].box.w, 0.85 * 400);
    EXPECT_EQ(omitted_panels(400, 400, wanted).size(), 2U);
}

TEST(Layout, ColumnsOfATallPictureStandBelowEachOther) {
    using enum LayoutNode::Kind;
    const LayoutNode two = grid(columns, {leaf({.kind = PanelKind::mechanism}), leaf(strip(sim::ChannelKind::theta))});
    const Layout l = layout(1080, 1920, two);
    ASSERT_EQ(l.panels.size(), 2U);
    EXPECT_EQ(l.panels[0].box.x, l.panels[1].box.x);
    EXPECT_GT(l.panels[1].box.y, l.panels[0].box.bottom());
}

}  // namespace
}  // namespace beamcam::render
