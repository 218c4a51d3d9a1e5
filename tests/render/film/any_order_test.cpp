// The pixels of a frame depend neither on the frames drawn before nor on the number of threads, and stand still while
// time does.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "render/film/film.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

TEST(AnyOrder, PanelsOfEverything) { same_in_any_order(everything()); }
TEST(AnyOrder, Comparisons) {
    same_in_any_order(compared(Comparison::panels));
    same_in_any_order(compared(Comparison::ghosts));
}

TEST(AnyOrder, SolidFilms) {
    SKIP_WITHOUT_GL();
    FilmSetup setup = test::synthetic_film({.duration = 0.8});
    setup.width = 640, setup.height = 360;
    setup.view.style = Style::solid;
    same_in_any_order(std::move(setup));
}

TEST(AnyOrder, MeasuredData) { same_in_any_order(with_data()); }

// While time is frozen nothing changes in any panel, rings of impacts included.
void stands_still(FilmSetup setup) {
    for (std::size_t k = 21; k < 47; ++k) {
        setup.poses[k] = setup.poses[20];
        for (Motion& other : setup.others) other.poses[k] = other.poses[20];
    }
    setup.speeds.assign(setup.poses.size(), 1);
    std::fill_n(setup.speeds.begin() + 20, 27, 0.0);
    setup.callouts = {{20, 45, "touch"}};
    Film film(std::move(setup));
    int repeated = 0;
    for (int k = 20; k < film.frames(); ++k) {
        if (!film.repeats(k)) continue;
        EXPECT_EQ(drawn(film, k), drawn(film, k - 1)) << k;
        ++repeated;
    }
    EXPECT_EQ(repeated, 25);         // all frames between the first and the last of the freeze
    EXPECT_FALSE(film.repeats(46));  // the words are gone
}

TEST(AnyOrder, StandStillWhileTimeDoes) { stands_still(everything()); }
TEST(AnyOrder, ComparisonsStandStillWhileTimeDoes) {
    stands_still(compared(Comparison::panels));
    stands_still(compared(Comparison::ghosts));
}

}  // namespace
}  // namespace beamcam::render
