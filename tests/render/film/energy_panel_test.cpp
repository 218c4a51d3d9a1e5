#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "render/film/strip_content.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

// As Cairo rounds an opaque colour, through 16 bits a channel.
std::uint32_t pixel_of(const Color& c) {
    const auto channel = [](double share) { return static_cast<std::uint32_t>(share * 65535 + 0.5) >> 8; };
    return 255U << 24 | channel(c.r) << 16 | channel(c.g) << 8 | channel(c.b);
}

// The stack has every energy and every loss of the balance.
TEST(Energy, NoTermOfTheBalanceIsMissing) {
    for (const sim::ChannelRow& row : sim::kChannels) {
        const std::string_view name = row.name;
        if (name == "energy_residual" || !(name.starts_with("energy_") || name.starts_with("loss_"))) continue;
        EXPECT_TRUE(std::ranges::count(type_of(PanelKind::energy).channels, row.kind)) << name;
    }
}

TEST(Energy, LossesThatNobodyHasLeaveTheOthers) {
    const auto ledger = [](double nothing) {
        FilmSetup setup = test::flat_film({.duration = 0.3, .cam = false}, 1920, 1080);  // rows of 1 % of the chart
        const std::size_t rows = setup.chart.values[0].size();
        for (const auto& [kind, value] : {std::pair{ChannelKind::energy_kinetic, 1.0},
                                          {ChannelKind::loss_structural, 2.0},
                                          {ChannelKind::loss_contact, nothing},
                                          {ChannelKind::loss_friction, nothing}}) {
            setup.chart.channels.push_back({kind, 0});
            setup.chart.values.emplace_back(rows, value);
        }
        setup.layout = leaf({.kind = PanelKind::energy});
        Film film(std::move(setup));
        return drawn(film, 12);
    };
    const Image empty = ledger(std::numeric_limits<double>::quiet_NaN()), zero = ledger(0);
    EXPECT_EQ(empty.pixels, zero.pixels);
}

// The potential energy is zero at the height of O, whatever part of the motion is shown; below it the other terms are
// stacked on zero.
TEST(Energy, PotentialIsThatOfTheTrajectory) {
    const auto chart = [](double potential, double kinetic) {
        FilmSetup setup = test::flat_film({.duration = 0.3, .cam = false}, 1920, 1080);  // rows of 1 % of the chart
        const std::size_t rows = setup.chart.values[0].size();
        for (const auto& [kind, value] : {std::pair{ChannelKind::energy_kinetic, kinetic},
                                          {ChannelKind::energy_potential, potential},
                                          {ChannelKind::energy_elastic, 1.0}}) {
            setup.chart.channels.push_back({kind, 0});
            setup.chart.values.emplace_back(rows, value);
        }
        setup.layout = leaf({.kind = PanelKind::energy});
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(12);
        const Box plot = plot_area(g.layout.panels.front().box, g.layout.unit, g.layout.letters.words);
        const Image image = drawn(film, 12);
        // Rows of each colour in a column of the past.
        const auto share = [&](ChannelKind kind) {
            int count = 0;
            for (int y = int(plot.y); y < int(plot.bottom()); ++y)
                count += pixel_at(image, int(plot.x + 0.3 * plot.w), y) ==
                         pixel_of(*energy_color(palette(Theme::light), kind));
            return count / plot.h;
        };
        return std::array{share(ChannelKind::energy_potential), share(ChannelKind::energy_kinetic),
                          share(ChannelKind::energy_elastic)};
    };
    const auto above = chart(6, 3), below = chart(-4, 5);  // axes of 0…10 or 12 J, −5…6 J
    EXPECT_NEAR(above[0] / above[1], 2, 0.1);
    EXPECT_NEAR(above[1] / above[2], 3, 0.15);
    EXPECT_NEAR(below[0] / below[1], 0.8, 0.05);
    EXPECT_NEAR(below[1] / below[2], 5, 0.25);
}

}  // namespace
}  // namespace beamcam::render
