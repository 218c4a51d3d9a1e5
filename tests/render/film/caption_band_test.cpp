// Captions of pictures without a mechanism.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/film/layout.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

FilmSetup charts_only() {
    FilmSetup setup = test::flat_film({.duration = 1}, 1280, 720);
    setup.layout = LayoutNode{.kind = LayoutNode::Kind::panel,
                              .panel = {.kind = PanelKind::strip, .channels = {{sim::ChannelKind::theta, 0}}}};
    return setup;
}

TEST(CaptionBand, ShowsTextsBelowTheCharts) {
    FilmSetup setup = charts_only();
    const FrameGeometry without = Film(setup).geometry(20);
    EXPECT_FALSE(without.layout.captions);
    setup.callouts = {{10, 40, "first contact"}, {15, 40, "$\\dot\\theta$ changes its sign"}};
    Film film(setup);
    EXPECT_TRUE(film.shows_captions());
    const FrameGeometry g = film.geometry(20);
    ASSERT_TRUE(g.layout.captions);
    const Box band = *g.layout.captions;
    EXPECT_FALSE(band.overlaps(g.layout.panels.front().box));
    EXPECT_FALSE(band.overlaps(*g.layout.clock));
    EXPECT_EQ(std::ranges::count_if(g.texts, [&](const Box& text) { return band.contains(text); }), 2);
    EXPECT_GT(differing_pixels(drawn(film, 5), drawn(film, 20), band), 100);
    EXPECT_EQ(differing_pixels(drawn(film, 5), drawn(film, 50), band), 0);
}

TEST(CaptionBand, LongTextsStayWithinIt) {
    FilmSetup setup = charts_only();
    for (int i = 0; i < 3; ++i)
        setup.callouts.push_back({0, 40, "a text that is so long that it needs two lines beside the others"});
    const FrameGeometry g = Film(setup).geometry(20);
    const Box band = *g.layout.captions;
    int inside = 0;
    for (const Box& text : g.texts) {
        if (!text.overlaps(band)) continue;
        ++inside;
        EXPECT_TRUE(band.contains(text)) << text.x << ", " << text.w;
    }
    EXPECT_EQ(inside, 6);
}

}  // namespace
}  // namespace beamcam::render
