// Pictures without paper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "render/draw/color.hpp"
#include "render/film/film.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

TEST(TransparentPanels, ATransparentFilmHasNoPaper) {
    FilmSetup setup = test::flat_film({.duration = 0.2}, 960, 540);
    setup.view.transparent = true;
    Film film(std::move(setup));
    const Image image = drawn(film, 3);
    EXPECT_EQ(image.pixels.front(), 0U);
    std::size_t opaque = 0;
    for (std::uint32_t p : image.pixels) opaque += p >> 24 == 255;
    EXPECT_GT(opaque, 10000U);
}

TEST(TransparentPanels, WordsOfATransparentLightFilmAreReadOnDarkGroundsToo) {
    for (const Theme theme : {Theme::light, Theme::dark, Theme::print}) {
        const Palette p = palette(theme).without_paper();
        for (const std::uint32_t ground : {0xFFFFFFU, 0x000000U, 0x3A6EA5U, 0x888888U}) {
            const Color around = mix(rgb(ground), p.paper, p.halo_of_all()->a);
            EXPECT_GT(contrast(p.ink, around), 10) << ground;
            EXPECT_GT(contrast(p.muted, around), 4) << ground;
        }
    }
}

// On a ground of the curve's own colour, its outline shows it; the future stays fainter than the past.
TEST(TransparentPanels, ThePastOfATransparentChartIsOutlinedAndTheFutureFaint) {
    FilmSetup setup = test::flat_film({.duration = 1}, 960, 540);
    setup.view.transparent = true;
    setup.layout = leaf({.kind = PanelKind::strip, .channels = {{ChannelKind::theta, 0}}});
    Film film(std::move(setup));
    const Image image = drawn(film, film.frames() / 2);
    const Box plot = film.geometry(0).layout.panels.front().box.inset(60);
    const auto strongest = [&](double from, double to) {  // alpha, away from axes and cursor
        std::uint32_t most = 0;
        for (int y = int(plot.y); y < int(plot.bottom()); ++y)
            for (int x = int(from); x < int(to); ++x) most = std::max(most, pixel_at(image, x, y) >> 24);
        return most;
    };
    const double middle = plot.centre().x;
    EXPECT_GT(strongest(plot.x + 60, middle - 40), 240U);
    EXPECT_LT(strongest(middle + 60, plot.right() - 20), 130U);
}

// Opaque paper around letters would be visible on any background.
TEST(TransparentPanels, TextsOfATransparentFilmHaveNoPaperAroundThem) {
    const auto of_paper = [](bool transparent) {
        FilmSetup setup = test::flat_film({.duration = 0.7}, 960, 540);
        setup.view.transparent = transparent;
        setup.layout = leaf({.kind = PanelKind::mechanism});
        const Color paper = palette(setup.view.theme).paper;
        const auto byte = [](double share) { return static_cast<std::uint32_t>(std::lround(255 * share)); };
        const std::uint32_t wanted = 0xFF000000U | byte(paper.r) << 16 | byte(paper.g) << 8 | byte(paper.b);
        Film film(std::move(setup));
        const Image image = drawn(film, 37);
        const auto above_clock = std::size_t(film.geometry(0).layout.clock->y) * std::size_t(image.width);
        return std::ranges::count(std::span(image.pixels).first(above_clock), wanted);
    };
    EXPECT_GT(of_paper(false), 300000);
    EXPECT_LT(of_paper(true), 113);  // the bore of the disc without its cross: π (12 · 0.5)²
}

}  // namespace
}  // namespace beamcam::render
