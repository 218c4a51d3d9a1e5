// One plot serves pages and films.
#include "render/plot/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/draw/canvas.hpp"
#include "render/plot/chart.hpp"
#include "tests/render/drawing.hpp"

namespace beamcam::render::figure {
namespace {

constexpr Box kBox{40, 20, 200, 100};

Panel rising() {
    Panel panel{.x = {.from = 0, .to = 1, .unit = 1}, .y = {.from = 0, .to = 1}};
    panel.series.push_back({.x = {0, 0.25, 0.5, 0.75, 1}, .y = {0, 0.25, 0.5, 0.75, 1}, .color = rgb(0xFF0000)});
    panel.series.back().faint = rgb(0x00FF00);
    return panel;
}

// The columns of a picture with this colour.
Range columns_with(const Image& image, std::uint32_t color) {
    Range out{1e9, -1};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if ((pixel_at(image, x, y) & 0xFFFFFF) == color)
                out = {std::min(out.low, double(x)), std::max(out.high, double(x))};
    return out;
}

TEST(Plot, HasTheSamePlacesOnAPageAndInAFilm) {
    const Panel panel = rising();
    const Fonts fonts;
    Image image(300, 160);
    Canvas canvas(image, fonts);
    const PlotStyle page = style_of(*column_named("elsevier")), film = film_style(palette(Theme::light), 1, 21, 17);
    Plot printed(panel, page, "test"), shown(panel, film, "test");
    printed.place(canvas, kBox), shown.place(canvas, kBox);
    for (const double x : {0.0, 0.3, 1.0}) EXPECT_DOUBLE_EQ(printed.along_x(x), shown.along_x(x));
    EXPECT_DOUBLE_EQ(shown.along_x(0.5), 140);
    EXPECT_DOUBLE_EQ(printed.along_x(1), kBox.right());
}

// The past ends between two rows at its instant; the future goes on to the next row.
TEST(Plot, DrawsThePastToItsInstantAndTheFutureFainter) {
    const Panel panel = rising();
    const Fonts fonts;
    const PlotStyle film = film_style(palette(Theme::light), 1, 21, 17);
    for (const bool past : {true, false}) {
        Image image(300, 160);
        {
            Canvas canvas(image, fonts);
            Plot plot(panel, film, "test");
            plot.place(canvas, kBox);
            plot.draw_data(canvas, {.from = 0.5, .to = 0.6, .past = past});
        }
        const Range drawn = columns_with(image, past ? 0xFF0000 : 0x00FF00);
        EXPECT_NEAR(drawn.low, kBox.x + 0.25 * kBox.w, 2);  // from the row before 0.5 on
        EXPECT_NEAR(drawn.high, kBox.x + (past ? 0.6 : 0.75) * kBox.w, 2);
        EXPECT_LT(columns_with(image, past ? 0x00FF00 : 0xFF0000).high, 0);
    }
}

// Ticks of events touch neither the curves nor the numbers of the axis, however many lanes there are.
TEST(Plot, TicksOfEventsAreBetweenTheAxisAndItsNumbers) {
    const Fonts fonts;
    for (const double unit : {0.5, 1.0, 2.0})
        for (const int lanes : {1, 3, 8}) {
            Panel panel{.x = {.from = 0, .to = 1, .unit = 1}, .y = {.from = 0, .to = 1}};
            for (int lane = 0; lane < lanes; ++lane)
                panel.events.push_back({.x = 0.5, .color = rgb(0xFF0000), .lane = lane, .lanes = lanes});
            const PlotStyle film = film_style(palette(Theme::light), unit, 21 * unit, 17 * unit);
            Image image(300, 200);
            double numbers = 0;
            {
                Canvas canvas(image, fonts);
                Plot plot(panel, film, "test");
                plot.place(canvas, kBox);
                plot.draw_data(canvas, {});
                numbers = kBox.bottom() + plot.numbers_below() - canvas.cap_height(film.numbers);
            }
            int tall = 0;  // rows with a tick
            for (int y = 0; y < image.height; ++y) {
                const auto row = image.pixels.begin() + std::ptrdiff_t(y) * image.width;
                const bool empty = std::all_of(row, row + image.width, [](std::uint32_t pixel) { return pixel == 0; });
                tall += !empty;
                EXPECT_TRUE(empty || (y >= kBox.bottom() && y + 1 <= numbers)) << y << ", " << lanes << " lanes";
            }
            EXPECT_GE(tall, 6 * unit) << lanes << " lanes";
        }
}

// Curves with a row each are above each other; where the rows would be too low they share one.
TEST(Chart, CurvesHaveRowsWhereThereIsRoom) {
    ChartContent content;
    content.set_time({0, 1}, 1, "t");
    content.set_values({0, 100}, "F", "N");
    for (const std::uint32_t color : {0xFF0000U, 0x00FF00U})
        content.panel.series.push_back({.x = {0, 1}, .y = {50, 50}, .color = rgb(color)});
    content.rows = 2;
    const Fonts fonts;
    for (const double height : {100.0, 30.0}) {
        const Box plot{kBox.x, kBox.y, kBox.w, height};
        const Chart chart(content, {0, 0, 300, 160}, plot, film_style(palette(Theme::light), 1, 21, 17), fonts);
        Image image(300, 160);
        Canvas canvas(image, fonts);
        chart.draw_moving(canvas, 2, {});
        const auto row_of = [&](std::uint32_t color) {
            for (int y = 0; y < image.height; ++y)
                if ((image.pixels[std::size_t(y) * 300 + 100] & 0xFFFFFF) == color) return y;
            return -1;
        };
        EXPECT_NEAR(row_of(0x00FF00), plot.y + (height > 50 ? 0.8 : 0.5) * height, 0.08 * height);
        EXPECT_EQ(row_of(0xFF0000) > 0, height > 50) << "the second curve covers the first in one row";
    }
}

// The value of a peak is above it, unless the reading states it.
TEST(Chart, PeaksHaveTheirValues) {
    ChartContent content;
    content.set_time({0, 1}, 1, "t");
    content.set_values({0, 100}, "F", "N");
    content.panel.series.push_back({.x = {0, 0.5, 1}, .y = {0, 40, 0}});
    const Fonts fonts;
    const Chart chart(content, {0, 0, 300, 160}, kBox, film_style(palette(Theme::light), 1, 21, 17), fonts);
    const auto texts = [&](double t, const Vec2& peak, double reading = 0) {
        Image image(300, 160);
        Canvas canvas(image, fonts);
        std::vector<Box> all;
        canvas.record = &all;
        chart.draw_moving(canvas, t, {&reading, 1}, {&peak, 1});
        std::erase_if(all, [](const Box& text) { return text.right() > kBox.right(); });  // the reading
        return all;
    };
    EXPECT_TRUE(texts(0.51, {0.5, 40}, 40).empty());
    EXPECT_TRUE(texts(0.8, {std::nan(""), std::nan("")}).empty());
    ASSERT_EQ(texts(0.8, {0.5, 40}).size(), 1u);
    EXPECT_NEAR(texts(0.8, {0.5, 40})[0].centre().x, kBox.centre().x, 2);
    EXPECT_LT(texts(0.8, {0.5, 40})[0].bottom(), kBox.y + 0.6 * kBox.h);
}

// A window moves the curves and its numbers, and no number is before the first instant of the film.
TEST(Plot, AWindowShowsAnotherIntervalOfTime) {
    Panel panel = rising();
    panel.x.first_number = 0;
    const Fonts fonts;
    Image image(300, 160);
    Canvas canvas(image, fonts);
    const PlotStyle film = film_style(palette(Theme::light), 1, 21, 17);
    Plot plot(panel, film, "test");
    plot.place(canvas, kBox);
    plot.show_x(canvas, -0.5, 0.5);
    EXPECT_DOUBLE_EQ(plot.along_x(0), kBox.centre().x);
    for (const Tick& tick : plot.x().ticks()) EXPECT_TRUE(tick.label.empty() || tick.at >= 0.5) << tick.label;
}

}  // namespace
}  // namespace beamcam::render::figure
