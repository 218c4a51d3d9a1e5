#include <gtest/gtest.h>

#include <cmath>

#include "render/film/film.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

// The numbers of an axis have the unit of its label: the speed in rpm is drawn as its value in rad/s would be.
TEST(PhasePanel, ScalesEachAxisToItsOwnUnit) {
    const auto chart = [](SpeedUnit unit, double factor) {
        FilmSetup setup = test::flat_film({.duration = 0.8}, 960, 540);
        setup.layout = leaf({.kind = PanelKind::phase});
        setup.problem.beam.model = sim::ModelKind::rigid;  // whose curve is not smoothed
        setup.units = {.degrees = true, .speed = unit};
        setup.chart.channels.push_back({ChannelKind::theta_dot, 0});
        std::vector<double> speed;
        for (const double t : setup.chart.values[0]) speed.push_back(factor * std::sin(9 * t));
        setup.chart.values.push_back(speed);
        for (sim::Pose& pose : setup.poses) pose.theta_dot = factor * std::sin(9 * pose.t);
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(20);
        const Box plot = plot_area(g.layout.panels.front().box, g.layout.unit, g.layout.letters.words);
        const Image image = drawn(film, 20);
        return std::vector(image.pixels.begin() + int(plot.y) * image.width,
                           image.pixels.begin() + int(plot.bottom()) * image.width);
    };
    EXPECT_EQ(chart(SpeedUnit::rpm, 1), chart(SpeedUnit::radians, factor_of(SpeedUnit::rpm)));
}

}  // namespace
}  // namespace beamcam::render
