// The colour scales have the units of the charts.
#include "render/film/color_bars.hpp"

#include <gtest/gtest.h>

#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

std::array<std::string, 3> marks_of(double duration, TraceColor trace, double peak = 100) {
    FilmSetup setup = test::flat_film({.duration = duration}, 1280, 720);
    setup.view.trace = trace;
    sim::Impact impact;
    impact.t_start = 0, impact.t_end = 1e-3, impact.force_peak = peak;
    setup.impacts = {impact};
    return trace_marks(FilmContext(std::make_shared<const FilmSetup>(setup)));
}

TEST(ColorBars, HaveTheUnitsOfTheCharts) {
    EXPECT_TRUE(marks_of(0.15, TraceColor::age)[2].ends_with("\u00A0s"));
    EXPECT_TRUE(marks_of(0.05, TraceColor::age)[2].ends_with("\u00A0ms"));
    EXPECT_EQ(marks_of(1, TraceColor::force, 590e3)[1], "250\u00A0kN");
    EXPECT_EQ(marks_of(1, TraceColor::force, 590e3)[2], "1000\u00A0kN");  // not 1 MN beside an axis in kN
}

}  // namespace
}  // namespace beamcam::render
