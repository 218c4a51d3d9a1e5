#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/film/film.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

TEST(CloseUp, HasTwoMarksHoweverLow) {
    for (const int height : {240, 300, 400, 700}) {
        FilmSetup setup = test::flat_film({.duration = 0.1}, 960, height);
        setup.layout = leaf({.kind = PanelKind::close_up});
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(0);
        const Box box = g.layout.first(PanelKind::close_up)->box;
        const auto marks = std::ranges::count_if(g.texts, [&](const Box& b) {
            return b.right() < plot_area(box, g.layout.unit, g.layout.letters.words).x - 8 * g.layout.unit &&
                   b.y > box.y + 30 * g.layout.unit && b.bottom() < box.bottom() - 30 * g.layout.unit;
        });
        EXPECT_GE(marks, 2) << height;
    }
}

TEST(CloseUp, HeadingAndReadingHaveRoomBesideEachOther) {
    for (const int width : {600, 800, 1080}) {
        FilmSetup setup = test::flat_film({.duration = 0.1}, width, width);
        for (sim::Pose& pose : setup.poses) pose.nearest->gap = -206e-6, pose.nearest->touching = true;
        setup.layout = LayoutNode{.kind = LayoutNode::Kind::columns,
                                  .children = {3, LayoutNode{.panel = {.kind = PanelKind::close_up}}}};
        Film film(std::move(setup));
        const std::vector<Box> texts = film.geometry(0).texts;
        for (std::size_t i = 0; i < texts.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_FALSE(texts[i].overlaps(texts[j])) << width << ": " << i << ", " << j;
    }
}

// In the middle of the close-up the height of the face above the rim equals the gap. The plot extends from 1.35 of the
// largest penetration below the rim to 1.9 above.
TEST(CloseUp, TheDrawnGapIsTheSampledGap) {
    constexpr double kDeepest = 4e-5;  // [m]
    FilmSetup setup = test::flat_film({.duration = 0.4}, 960, 1080);
    setup.impacts.clear();
    for (std::size_t k = 0; k < setup.poses.size(); ++k) {
        sim::Nearest& near = *setup.poses[k].nearest;
        near.gap = kDeepest * (-1 + 2.4 * double(k) / double(setup.poses.size() - 1));
        near.force = 0, near.touching = false;
    }
    setup.layout = leaf({.kind = PanelKind::close_up});
    const auto poses = setup.poses;
    Film film(std::move(setup));
    const Layout places = film.geometry(0).layout;
    const Box box = places.first(PanelKind::close_up)->box;
    const double u = places.unit, low = -1.35 * kDeepest, high = 1.9 * kDeepest;
    const Box plot = plot_area(box, u, places.letters.words);
    const Color motion = palette(Theme::light).motion;
    // Centre of the rows that the line of the face covers.
    const auto row_of_face = [&](const Image& image) {
        double sum = 0, count = 0;
        const int x = int(plot.x + plot.w / 2);
        for (int y = int(plot.y); y < int(plot.bottom()); ++y) {
            const std::uint32_t p = pixel_at(image, x, y);
            const double off = difference(p, motion);
            if (off < 0.25) sum += y + 0.5, ++count;
        }
        return count > 0 ? sum / count : -1;
    };
    for (int k = 0; k < film.frames(); k += 2) {
        const double gap = poses[std::size_t(k)].nearest->gap;
        EXPECT_NEAR(row_of_face(drawn(film, k)), plot.bottom() - plot.h * (gap - low) / (high - low), 0.75)
            << "a gap of " << gap * 1e6 << " µm";
    }
}

}  // namespace
}  // namespace beamcam::render
