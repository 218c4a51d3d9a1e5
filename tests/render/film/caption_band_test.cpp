#include "render/film/caption_band.hpp"

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

TEST(CaptionBand, ShowsOneTextAtATimeBelowThePanels) {
    for (FilmSetup setup : {charts_only(), test::flat_film({.duration = 1}, 1280, 720)}) {
        EXPECT_FALSE(Film(setup).geometry(20).layout.captions);
        setup.callouts = {{10, 40, "first contact"}, {15, 30, "$\\dot\\theta$ changes its sign"}};
        Film film(setup);
        EXPECT_TRUE(film.shows_captions());
        const FrameGeometry g = film.geometry(20);
        ASSERT_TRUE(g.layout.captions);
        const Box band = *g.layout.captions;
        for (const PanelSlot& slot : g.layout.panels) EXPECT_FALSE(band.overlaps(slot.box));
        EXPECT_FALSE(band.overlaps(*g.layout.clock));
        EXPECT_EQ(std::ranges::count_if(g.texts, [&](const Box& text) { return band.contains(text); }), 1);
        EXPECT_GT(differing_pixels(drawn(film, 5), drawn(film, 20), band), 100);
        EXPECT_GT(differing_pixels(drawn(film, 12), drawn(film, 20), band), 100);
        EXPECT_EQ(differing_pixels(drawn(film, 5), drawn(film, 50), band), 0);
    }
}

// 22 px in a picture of 720 lines.
TEST(CaptionBand, HasLargeLettersThenSmallOnesThenTwoLinesThenAnEllipsis) {
    FilmSetup setup = charts_only();
    const std::string words = "words that are shown in the band below the panels of a film ";
    const std::string three = words + words + words;
    for (const auto& [text, cut] :
         {std::pair{words, false}, {words + words, false}, {three, false}, {three + three, true}}) {
        setup.callouts = {{0, 40, text}};
        Film film(setup);
        EXPECT_EQ(film.cut_texts(), cut ? std::vector<std::string>{"captions"} : std::vector<std::string>{}) << text;
        const FrameGeometry g = film.geometry(20);
        const auto caption =
            std::ranges::find_if(g.texts, [&](const Box& b) { return b.overlaps(*g.layout.captions); });
        ASSERT_NE(caption, g.texts.end());
        EXPECT_TRUE(g.layout.captions->contains(*caption)) << text;
    }
}

TEST(CaptionBand, TextsFadeInAndOut) {
    const Callout fading{10, 29, "", 4};
    EXPECT_EQ(fading.opacity(9), 0);
    EXPECT_EQ(fading.opacity(10), 0.2);
    EXPECT_EQ(fading.opacity(14), 1);
    EXPECT_EQ(fading.opacity(29), 0.2);
    EXPECT_EQ(fading.opacity(30), 0);
}

}  // namespace
}  // namespace beamcam::render
