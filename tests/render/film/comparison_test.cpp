// Several motions in one picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "render/film/film.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

TEST(ComparedPanels, ComparedMechanismsHaveOneScaleAndOneFactor) {
    Film film(compared(Comparison::panels));
    const Layout layout = film.geometry(10).layout;
    std::vector<Box> boxes;
    for (const PanelSlot& slot : layout.panels)
        if (slot.spec.kind == PanelKind::mechanism) boxes.push_back(slot.box);
    ASSERT_EQ(boxes.size(), 2U);
    EXPECT_NEAR(boxes[0].w, boxes[1].w, 1);
    EXPECT_EQ(boxes[0].h, boxes[1].h);
}

TEST(ComparedPanels, MotionsAtOtherInstantsAreRefused) {
    FilmSetup setup = compared(Comparison::panels);
    setup.others[0].poses.pop_back();
    EXPECT_ANY_THROW(Film{std::move(setup)});
}

// The names of motions are beside the readings only if no mechanism carries them.
TEST(Comparisons, NameEachMotionOnce) {
    const auto texts_of_heading = [](std::optional<LayoutNode> layout) {
        FilmSetup setup = compared(Comparison::panels);
        setup.layout = std::move(layout);
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(20);
        const Box box = g.layout.first(PanelKind::strip)->box;
        return std::ranges::count_if(g.texts, [&](const Box& text) {
            return text.x > box.x && text.y > box.y && text.bottom() < box.y + 34 * g.layout.unit;
        });
    };
    EXPECT_EQ(texts_of_heading({}), 3);                                   // name of the axis, two readings
    EXPECT_EQ(texts_of_heading(leaf(strip(ChannelKind::theta))), 3 + 2);  // … and their names
}

// Where readings with names have no room, a picture without mechanism shows the names.
TEST(Comparisons, NamesComeBeforeReadings) {
    FilmSetup setup = compared(Comparison::panels);
    setup.label = setup.others.front().label = "ω = 10 rad/s";
    while (setup.others.size() < 7) setup.others.push_back(setup.others.front());
    setup.layout = leaf(strip(ChannelKind::theta));
    Film film(std::move(setup));
    const FrameGeometry g = film.geometry(20);
    const Box box = g.layout.panels.front().box;
    const auto named = std::ranges::count_if(g.texts, [&](const Box& text) {
        return text.y > box.y && text.bottom() < box.y + 34 * g.layout.unit && text.w > 60;  // longer than "0.785"
    });
    EXPECT_EQ(named, 8);
}

TEST(FilmData, AreDrawnWhereTheyHaveValues) {
    Film without(everything()), with(with_data());
    const FrameGeometry geometry = with.geometry(12);
    const Vec2 tip = geometry.camera.to_pixels(sim::unit(0.55) * 1.0);
    const Box at_tip = Box{tip.x, tip.y, 0, 0}.inset(-20);
    EXPECT_GT(differing_pixels(drawn(without, 12), drawn(with, 12), at_tip), 30);
}

}  // namespace
}  // namespace beamcam::render
