// The colour scales have the units of the charts.
#include "render/film/color_bars.hpp"

#include <gtest/gtest.h>

#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

std::array<std::string, 3> marks_of(double peak) {
    FilmSetup setup = test::flat_film({.duration = 1}, 1280, 720);
    sim::Impact impact;
    impact.t_start = 0, impact.t_end = 1e-3, impact.force_peak = peak;
    setup.impacts = {impact};
    return trace_marks(FilmContext(std::make_shared<const FilmSetup>(setup)));
}

TEST(ColorBars, HaveTheUnitsOfTheCharts) {
    EXPECT_EQ(marks_of(590e3)[1], "250\u00A0kN");
    EXPECT_EQ(marks_of(590e3)[2], "1000\u00A0kN");  // not 1 MN beside an axis in kN
}

}  // namespace
}  // namespace beamcam::render
