// Only the changed parts of a picture are redrawn.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "render/draw/dirty_tiles.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

long pixels_in(const DirtyTiles& tiles) {
    long count = 0;
    tiles.for_each_run([&](int left, int top, int right, int bottom) { count += long(right - left) * (bottom - top); });
    return count;
}

// Number of changed pixels outside of the tiles.
long changed_elsewhere(const Image& before, const Image& now, const DirtyTiles& tiles) {
    Image patched = before;
    copy(now, patched, tiles);
    long count = 0;
    for (std::size_t i = 0; i < now.pixels.size(); ++i) count += patched.pixels[i] != now.pixels[i];
    return count;
}

// Draws the frames in this order and compares each with a fresh film.
void as_if_all_were_drawn(const Film& film, const std::vector<int>& frames, double most_of_the_picture) {
    Film in_order = film.for_thread();
    Image before;
    double share = 0;
    for (int k : frames) {
        const Image& now = in_order.draw(k);
        if (!before.pixels.empty()) {
            EXPECT_EQ(changed_elsewhere(before, now, in_order.changed()), 0) << "frame " << k;
            share += double(pixels_in(in_order.changed())) / double(now.pixels.size() * (frames.size() - 1));
        }
        before = now;
        Film fresh = film.for_thread();
        EXPECT_EQ(fresh.draw(k), now) << "frame " << k;
    }
    EXPECT_LT(share, most_of_the_picture);
}

const std::vector<int> kForward = {0, 1, 2, 3, 5, 9, 16, 17, 18, 19, 20, 21, 22, 30, 31, 47};
const std::vector<int> kAnyOrder = {22, 3, 40, 41, 5, 47, 0, 18, 17, 17, 46};

TEST(MovingParts, EveryPanelIsDrawnAsIfAllWere) {
    const Film film(everything());
    as_if_all_were_drawn(film, kForward, 0.6);
    as_if_all_were_drawn(film, kAnyOrder, 1);
    as_if_all_were_drawn(Film(with_data()), kForward, 0.6);
}
TEST(MovingParts, ComparisonsAreDrawnAsIfAllWere) {
    for (Comparison how : {Comparison::panels, Comparison::ghosts}) {
        FilmSetup setup = compared(how);
        setup.chart.channels.push_back({ChannelKind::theta_dot, 0});
        setup.chart.values.push_back(setup.chart.values[0]);
        setup.others[0].chart = setup.chart;
        using enum LayoutNode::Kind;
        if (how == Comparison::ghosts)
            setup.layout = grid(columns, {leaf({.kind = PanelKind::mechanism}), leaf({.kind = PanelKind::phase}),
                                          leaf(strip(ChannelKind::theta))});
        const Film film(std::move(setup));
        as_if_all_were_drawn(film, kForward, 0.6);
        as_if_all_were_drawn(film, kAnyOrder, 1);
    }
}
TEST(MovingParts, TransparentTinyAndOddPicturesAreDrawnAsIfAllWere) {
    for (auto [width, height] : {std::pair{961, 541}, {320, 180}, {64, 48}, {33, 17}, {1, 1}}) {
        FilmSetup setup = everything();
        setup.width = width, setup.height = height;
        setup.view.transparent = width % 2 == 1;
        as_if_all_were_drawn(Film(std::move(setup)), {0, 1, 2, 20, 21, 22, 3, 47}, 1.01);
    }
}
TEST(MovingParts, AStandardFilmRedrawsAThirdAtMost) {
    FilmSetup setup = test::flat_film({.duration = 0.8}, 1920, 1080);
    as_if_all_were_drawn(Film(std::move(setup)), kForward, 0.33);
}

void gl_films_are_drawn_as_if_all_were(Style style) {
    FilmSetup setup = everything();
    setup.view.style = style;
    setup.width = 960, setup.height = 540;
    const Film film(std::move(setup));
    as_if_all_were_drawn(film, {0, 1, 2, 16, 17, 21, 22, 47}, 1);
    as_if_all_were_drawn(film, {22, 3, 47, 0, 18, 17}, 1);
}

TEST(MovingParts, OfLitFilmsAreDrawnAsIfAllWere) {
    SKIP_WITHOUT_GL();
    gl_films_are_drawn_as_if_all_were(Style::lit);
}
TEST(MovingParts, OfSolidFilmsAreDrawnAsIfAllWere) {
    SKIP_WITHOUT_GL();
    gl_films_are_drawn_as_if_all_were(Style::solid);
}

TEST(DirtyTiles, CoverBoxesAndNothingBeyondThePicture) {
    DirtyTiles tiles(100, 50);
    EXPECT_FALSE(tiles.any());
    tiles.add({-500, -500, 400, 400});
    tiles.add({100, 0, 5, 5});
    EXPECT_EQ(pixels_in(tiles), 4L * 16);  // the last column of tiles is four pixels wide
    tiles.clear();
    tiles.add({31.5, 15.5, 1, 1});
    EXPECT_EQ(pixels_in(tiles), 64L * 32);
    tiles.clear();
    tiles.add({std::nan(""), 0, 1, 1});
    EXPECT_EQ(pixels_in(tiles), 5000);
}

}  // namespace
}  // namespace beamcam::render
