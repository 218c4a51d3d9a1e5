// The plotting engine: any numbers give a picture or a clear error, and texts keep apart.
#include "render/plot/figure.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "render/base/error.hpp"
#include "render/plot/channel_label.hpp"
#include "render/plot/panel.hpp"

namespace beamcam::render::figure {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

Figure plot(std::vector<double> x, std::vector<double> y) {
    Figure figure;
    figure.name = "test";
    Panel panel;
    panel.x.label = "$t$ / s";
    panel.y.label = "$θ$ / rad";
    Series s;
    s.label = "curve";
    s.x = std::move(x);
    s.y = std::move(y);
    panel.series.push_back(std::move(s));
    figure.panels.push_back(std::move(panel));
    return figure;
}

struct Drawn {
    Image image;
    std::vector<PageCanvas::Written> written;
};
Drawn draw_png(const Figure& figure, const char* column = "elsevier", double dpi = 72) {
    const Page page = page_of(figure, *column_named(column));
    const Fonts fonts(needs_chinese(figure), Typefaces::print);
    PageCanvas sheet(Medium::png, {points(page.width), points(page.height), dpi}, fonts);
    draw(figure, page, sheet);
    return {sheet.image(), sheet.written};
}

// The same band of ink, whether its oscillations are drawn one by one or as an outline.
TEST(Figure, ABandLooksLikeItsOscillations) {
    std::vector<double> x, y;
    for (int i = 0; i < 40'000; ++i) x.push_back(i * 1e-4), y.push_back(std::sin(i * 0.37) * (1 + x.back()));
    const auto unnamed = [&] {
        Figure figure = plot(x, y);
        figure.panels[0].legend = false;
        return figure;
    };
    const Figure by_outline = unnamed();
    // Back and forth in x by less than a thousandth of a pixel: nothing is a band.
    for (std::size_t i = 1; i < x.size(); i += 2) x[i] = x[i - 1] - 1e-9;
    const Image band = draw_png(by_outline).image, lines = draw_png(unnamed()).image;
    ASSERT_EQ(band.pixels.size(), lines.pixels.size());
    const auto ink = [](std::uint32_t p) { return (p & 255) != (p >> 16 & 255); };  // of the curve, not the axes
    std::size_t all = 0, differ = 0;
    for (std::size_t i = 0; i < band.pixels.size(); ++i) {
        all += ink(lines.pixels[i]);
        differ += ink(lines.pixels[i]) != ink(band.pixels[i]);
    }
    EXPECT_GT(all, 5000u);
    EXPECT_LT(differ, all / 100);
}

TEST(Figure, NumbersBelowThePlotStayOnThePage) {
    Figure figure = plot({40, 52}, {0, 1});
    Panel& panel = figure.panels[0];
    panel.series.clear();
    panel.cells.push_back({{40, 52}, {0, 1}, {rgb(0x404040)}});
    panel.y = {.numbered = false};
    const Drawn drawn = draw_png(figure);
    ASSERT_FALSE(drawn.written.empty());
    for (const auto& each : drawn.written) EXPECT_GE(each.box.x, 0) << each.markup;
}

TEST(Figure, BadNumbersGiveAPictureOrAClearError) {
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    for (const auto& [x, y] :
         std::vector<std::pair<std::vector<double>, std::vector<double>>>{{{0}, {1}},
                                                                          {{0, 1}, {3, 3}},
                                                                          {{2, 2, 2}, {1, 5, 3}},
                                                                          {{0, 1, 2}, {1, nan, 2}},
                                                                          {{0, 1, 2}, {1, inf, 2}},
                                                                          {{0, 1}, {1e-300, 2e-300}},
                                                                          {{0, 1}, {-1e300, 1e300}},
                                                                          {{1e300, 1.1e300}, {0, 1}}}) {
        const Drawn drawn = draw_png(plot(x, y));
        bool blank = true;
        for (const std::uint32_t p : drawn.image.pixels) blank = blank && p == 0xFFFFFFFF;
        EXPECT_FALSE(blank);
    }
    EXPECT_THROW(draw_png(plot({}, {})), PictureError);
    EXPECT_THROW(draw_png(plot({0, 1}, {nan, nan})), PictureError);
    EXPECT_THROW(draw_png(Figure{}), PictureError);
}

TEST(Figure, NoLetterIsSmallerThanSixPointsAndNoneLeavesThePage) {
    std::vector<double> x, y;
    for (int i = 0; i < 500; ++i) x.push_back(i * 1e-3), y.push_back(1e6 * std::sin(i * 0.1));
    Figure figure = plot(x, y);
    figure.panels[0].y.label = "$F_{\\r{c}}$ / (kN m^{−1})";
    for (const std::string& name : column_names()) {
        const Column& column = *column_named(name);
        const Drawn drawn = draw_png(figure, column.name);
        const Box page{0, 0, points(column.width), 1e4};
        for (const PageCanvas::Written& w : drawn.written) {
            EXPECT_GE(w.smallest, 6) << column.name << " " << w.markup;
            EXPECT_TRUE(page.contains(w.box, 0.01)) << column.name << " " << w.markup;
        }
        for (std::size_t i = 0; i < drawn.written.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_FALSE(drawn.written[i].box.inset(0.3).overlaps(drawn.written[k].box.inset(0.3)))
                    << column.name << ": " << drawn.written[i].markup << " over " << drawn.written[k].markup;
    }
}

// Panels with what a series may have: many curves, long titles, common powers of ten, marks, rules.
Figure random_figure(std::mt19937& random) {
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const auto chance = [&] { return below(2) == 0; };
    Figure figure;
    figure.name = "test";
    const int panels = 1 + below(4);
    figure.stack = chance(), figure.share_x = figure.stack && chance();
    figure.aspect = 0.4 * panels + 0.3;
    for (int k = 0; k < panels; ++k) {
        Panel panel;
        if (panels > 1) panel.letter = std::string(1, static_cast<char>('a' + k));
        for (int word = below(4) == 0 ? 12 : below(6); word > 0; --word)
            panel.title += (panel.title.empty() ? "" : " ") + std::string(chance() ? "$ω_{\\r{c}}$ =" : "vibration");
        panel.x.label = chance() ? "$t$ / s" : "phase of the cam / (2π)";
        panel.y.label = chance() ? "$F_{\\r{c}}$ / (kN m^{−1})" : "max |$Δθ$| of all / rad";
        panel.legend = chance();
        const double scale = std::pow(10, below(13) - 6), from = std::pow(10, below(7) - 3);
        for (int curve = 1 + below(5); curve > 0; --curve) {
            Series s;
            if (chance()) s.label = chance() ? "flexible, 2 modes" : "$q_{1}$";
            s.look = curve;
            const double pace = 1 + below(300);
            for (int i = 0; i <= 100; ++i)
                s.x.push_back(from * (1 + i / 100.0)), s.y.push_back(scale * (below(3) + std::sin(i * pace / 100.0)));
            panel.series.push_back(std::move(s));
        }
        if (chance()) panel.rules.push_back({.at = from * 1.3, .vertical = true, .label = "impact"});
        if (chance()) panel.marks.push_back({.x = from * 1.5, .y = scale, .label = "0.369 99 s"});
        figure.panels.push_back(std::move(panel));
    }
    return figure;
}

// Labels of marks and rules have fixed places in the plot.
TEST(Figure, NoTwoTextsAroundThePlotsCollideInTwoHundredRandomFigures) {
    std::mt19937 random(1);
    const std::vector<std::string> all = column_names();
    int refused = 0;
    for (int seed = 0; seed < 200; ++seed) {
        const Figure figure = random_figure(random);
        const Column& column = *column_named(all[static_cast<std::size_t>(seed) % all.size()]);
        Drawn drawn;
        try {
            drawn = draw_png(figure, column.name);
        } catch (const PictureError& error) {
            EXPECT_THAT(error.what(), HasSubstr("no room for the plot"));
            ++refused;
            continue;
        }
        const auto in_plot = [](const PageCanvas::Written& text) {
            return text.markup == "impact" || text.markup == "0.369 99 s";
        };
        const Page sheet = page_of(figure, column);
        const Box page{0, 0, points(sheet.width), points(sheet.height)};
        for (std::size_t i = 0; i < drawn.written.size(); ++i) {
            const PageCanvas::Written& one = drawn.written[i];
            EXPECT_TRUE(page.contains(one.box, 1.5)) << seed << " " << column.name << ": " << one.markup;
            for (std::size_t k = 0; k < i && !in_plot(one); ++k)
                EXPECT_FALSE(!in_plot(drawn.written[k]) && one.box.inset(0.5).overlaps(drawn.written[k].box.inset(0.5)))
                    << seed << " " << column.name << ": " << one.markup << " over " << drawn.written[k].markup;
        }
    }
    EXPECT_LT(refused, 40);
}

TEST(Figure, RulesHaveTheirWordsUnlessTheyAreBeyondTheAxes) {
    Figure figure = plot({0, 1}, {0, 1});
    figure.panels[0].rules = {
        {.at = 0.5, .label = "level"}, {.at = 7, .label = "beyond"}, {.at = 0.4, .vertical = true, .label = "now"}};
    const Drawn drawn = draw_png(figure);
    const auto written = [&](const char* words) {
        return std::any_of(drawn.written.begin(), drawn.written.end(),
                           [&](const auto& w) { return w.markup == words; });
    };
    EXPECT_TRUE(written("level"));
    EXPECT_TRUE(written("now"));
    EXPECT_FALSE(written("beyond"));
    for (std::size_t i = 0; i < drawn.written.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_FALSE(drawn.written[i].box.inset(0.3).overlaps(drawn.written[k].box.inset(0.3)));
}

// The label of the second one is below that of the first.
TEST(Figure, LabelsOfCloseRulesKeepTheirOrder) {
    Figure figure = plot({0, 1}, {0, 1});
    figure.panels[0].rules = {{.at = 0.200, .vertical = true, .label = "first touch of the beam"},
                              {.at = 0.212, .vertical = true, .label = "next"}};
    const Drawn drawn = draw_png(figure);
    const auto place = [&](const char* words) {
        return std::ranges::find(drawn.written, words, &PageCanvas::Written::markup)->box.x;
    };
    EXPECT_LT(place("first touch of the beam"), place("next"));
    for (std::size_t i = 0; i < drawn.written.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_FALSE(drawn.written[i].box.inset(0.3).overlaps(drawn.written[k].box.inset(0.3)));
}

// At the right end of the plot they are on the left.
TEST(Figure, LabelsOfMarksAndRulesStayInThePlot) {
    Figure figure = plot({0, 1}, {0, 1});
    figure.panels[0].y.from = 0, figure.panels[0].y.to = 1;
    figure.panels[0].x.tight = true;
    figure.panels[0].rules = {{.at = 0.98, .vertical = true, .label = "last touch"}};
    figure.panels[0].marks = {{.x = 1, .y = 1, .label = "the end"}};
    const auto written = draw_png(figure).written;
    const auto box_of = [&](const char* text) {
        return std::ranges::find(written, text, &PageCanvas::Written::markup)->box;
    };
    const double end = box_of("1.0").centre().x;  // of the last number below the plot
    EXPECT_LT(box_of("last touch").right(), end);
    EXPECT_LT(box_of("the end").right(), end);
    EXPECT_GT(box_of("the end").y, box_of("curve").bottom());  // of the legend
}

// Entries of different widths stand in rows rather than in one column.
TEST(Figure, ALegendAboveSavesLines) {
    Figure figure = plot({0, 1}, {0, 1});
    Panel& panel = figure.panels[0];
    panel.series[0].label = "kinetic";
    for (const char* label : {"potential", "of bending and of contact", "lost", "external work", "sum"})
        panel.series.push_back(
            {.label = label, .x = {0, 1}, .y = {0, 1}, .look = static_cast<int>(panel.series.size())});
    std::set<double> lines;
    for (const PageCanvas::Written& w : draw_png(figure, "aps").written)
        for (const Series& s : panel.series)
            if (w.markup == s.label) lines.insert(std::round(w.box.bottom() / 4));
    EXPECT_LE(lines.size(), 4u);
}

TEST(Figure, LinesThatLookAlikeShareAnEntryOfTheLegend) {
    Figure figure = plot({0, 1}, {0, 1});
    Panel& panel = figure.panels[0];
    panel.series[0].label = "exact";
    panel.series.push_back({.label = "rigid", .x = {0, 1}, .y = {1, 0}, .look = 1});
    panel.series.push_back({.label = "first-order", .x = {0, 1}, .y = {0, 1}});
    std::vector<std::string> written;
    for (const PageCanvas::Written& w : draw_png(figure, "aps").written) written.push_back(w.markup);
    EXPECT_THAT(written, IsSupersetOf({"exact, first-order", "rigid"}));
    EXPECT_THAT(written, Not(Contains("first-order")));
}

// However wide the shapes are beside their labels.
TEST(Figure, LabelsOfShapesKeepOnThePage) {
    for (const double tall : {0.2, 1.0, 3.0}) {
        Figure figure;
        figure.aspect = 0.6;
        Panel& panel = figure.panels.emplace_back();
        panel.shapes.push_back({.kind = Shape::Kind::line, .points = {{0, 0}, {1, tall}}});
        for (const auto& [at, align] : {std::pair{Vec2{1, tall}, HAlign::left}, {Vec2{0, 0}, HAlign::right}})
            panel.shapes.push_back(
                {.kind = Shape::Kind::label, .points = {at}, .markup = "a label that is long", .align = align});
        for (const auto& written : draw_png(figure).written) {
            EXPECT_GE(written.box.x, -0.1) << tall;
            EXPECT_LE(written.box.right(), points(90) + 0.1) << tall;
        }
    }
}

// A number at the lower left corner keeps off the first one below the plot.
TEST(Figure, NumbersAtACornerKeepApart) {
    for (const char* column : {"nature", "ieee", "slide"}) {
        Figure figure = plot({0.0, 0.5}, {-1, 1});
        figure.panels[0].x.from = 0, figure.panels[0].y.from = -1, figure.panels[0].y.to = 1;
        const auto written = draw_png(figure, column).written;
        const auto box_of = [&](const char* text) {
            return std::ranges::find(written, text, &PageCanvas::Written::markup)->box;
        };
        const double gap = box_of("0.0").y - std::max(box_of("−1.0").bottom(), 0.0);
        EXPECT_GT(gap, 1.5) << column;
    }
}

TEST(Figure, PagesHaveTheColumnsWidthToTheMillimetre) {
    const Figure figure = plot({0, 1}, {0, 1});
    EXPECT_EQ(page_of(figure, *column_named("ieee")).width, 88.9);
    EXPECT_EQ(page_of(figure, *column_named("nature-double")).width, 183);
    EXPECT_EQ(page_of(figure, *column_named("slide")).height, 142.875);
    EXPECT_EQ(page_of(figure, *column_named("aps"), 120).width, 120);
    EXPECT_THROW(page_of(figure, *column_named("aps"), 1), PictureError);
    EXPECT_EQ(column_named("brill"), nullptr);
    const Drawn drawn = draw_png(figure, "ieee", 300);
    EXPECT_EQ(drawn.image.width, 1050);  // 3.5 in
}

TEST(Figure, AGlyphThatNoFontHasIsAnErrorNamingAPackage) {
    Figure figure = plot({0, 1}, {0, 1});
    figure.panels[0].x.label = "\U00012000";  // cuneiform
    try {
        draw_png(figure);
        FAIL();
    } catch (const FontError& e) {
        EXPECT_THAT(e.what(), HasSubstr("fonts-"));
    }
}

TEST(Figure, VectorFilesAreTheSameBytesTwiceAndMeasureInMillimetres) {
    const Figure figure = plot({0, 1, 2}, {0, 1, 0});
    const Page page = page_of(figure, *column_named("elsevier"));
    const Fonts fonts(false, Typefaces::print);
    Document document;
    document.title = "a < b";
    document.scene = "{}";
    const auto bytes = [&](Medium medium) {
        PageCanvas sheet(medium, {points(page.width), points(page.height)}, fonts, document);
        draw(figure, page, sheet);
        return sheet.bytes();
    };
    EXPECT_EQ(bytes(Medium::pdf), bytes(Medium::pdf));
    EXPECT_EQ(bytes(Medium::svg), bytes(Medium::svg));
    EXPECT_THAT(bytes(Medium::svg), HasSubstr("width=\"90mm\""));
    EXPECT_THAT(bytes(Medium::svg), HasSubstr("<title>a &lt; b</title>"));
}

// Everything is drawn in the colours of white paper; the sheet turns them.
TEST(Figure, ADarkSlideHasThePaperAndTheInkOfDarkFilms) {
    const Palette& films = palette(Theme::dark);
    const auto expect_near = [](Color a, Color b) {
        EXPECT_NEAR(a.r, b.r, 2e-3);
        EXPECT_NEAR(a.g, b.g, 2e-3);
        EXPECT_NEAR(a.b, b.b, 2e-3);
    };
    expect_near(on_dark(rgb(0xFFFFFF)), films.paper);
    expect_near(on_dark(rgb(0x000000)), films.ink);
    EXPECT_EQ(on_dark(rgb(0x123456).faded(0.3)).a, 0.3);
    // Graphics need 3 : 1 (WCAG 2.1), letters of this size 4.5 : 1; labels have the colours of their lines.
    for (int k = 0; k < 8; ++k) EXPECT_GE(contrast(on_dark(look(k).color), films.paper), 4.5) << k;
    // What is near the paper's colour in print is near it here, and the order stays.
    double before = 0;
    for (int k = 0; k <= 20; ++k) {
        const double now = contrast(on_dark(map_color(k / 20.0)), films.paper);
        EXPECT_GT(now, before) << k;
        before = now;
    }
    const Figure figure = plot({0, 1}, {0, 1});
    const Page page = page_of(figure, *column_named("slide"));
    const Fonts fonts(false, Typefaces::print);
    PageCanvas sheet(Medium::png, {points(page.width), points(page.height), 72, true}, fonts);
    draw(figure, page, sheet);
    const Color paper = on_dark(rgb(0xFFFFFF));
    const auto byte = [](double channel) { return static_cast<std::uint32_t>(std::lround(255 * channel)); };
    EXPECT_EQ(sheet.image().pixels.front(), 0xFF000000 | byte(paper.r) << 16 | byte(paper.g) << 8 | byte(paper.b));
}

// Points without a line, such as measured data, are beneath the curves, and smaller where they are many.
TEST(Figure, ManyPointsDoNotHideTheCurve) {
    const auto pixels_of = [](const Image& image, std::uint32_t color) {
        return std::ranges::count(image.pixels, 0xFF000000U | color);
    };
    std::vector<double> x, y;
    for (int i = 0; i < 251; ++i) x.push_back(i / 250.0), y.push_back(std::sin(3 * x.back()));
    Figure figure = plot(x, y);
    figure.panels[0].legend = false;
    figure.panels[0].series[0].color = rgb(0x0000FF);
    const long alone = pixels_of(draw_png(figure, "elsevier", 300).image, 0x0000FF);
    Series data{.x = x, .y = y, .look = 1, .line = false, .every_point = true, .color = rgb(0xFF0000)};
    for (const bool first : {true, false}) {
        std::vector<Series>& all = figure.panels[0].series;
        all.insert(first ? all.begin() : all.end(), data);
        const Image both = draw_png(figure, "elsevier", 300).image;
        EXPECT_EQ(pixels_of(both, 0x0000FF), alone) << first;
        EXPECT_GT(pixels_of(both, 0xFF0000), alone / 2) << first;
        all.erase(first ? all.begin() : all.end() - 1);
    }
}

TEST(Figure, LongSeriesMakeSmallFiles) {
    std::vector<double> x, y;
    for (int i = 0; i < 1'000'000; ++i) x.push_back(i * 1e-6), y.push_back(std::sin(i * 0.01) + 1e-3 * (i % 7));
    const Figure figure = plot(x, y);
    const Page page = page_of(figure, *column_named("elsevier"));
    const Fonts fonts(false, Typefaces::print);
    PageCanvas sheet(Medium::pdf, {points(page.width), points(page.height)}, fonts);
    draw(figure, page, sheet);
    EXPECT_LT(sheet.bytes().size(), 600'000u);
}

// A periodic motion comes back to a few places thousands of times.
TEST(Figure, DotsOfFewPlacesAreSeenHoweverManyFallOnEach) {
    Figure figure;
    figure.panels.emplace_back();
    Panel& panel = figure.panels[0];
    panel.x.from = panel.y.from = 0, panel.x.to = panel.y.to = 1;
    panel.clouds.push_back({"", {}, {}, rgb(0xFF0000)});
    for (int i = 0; i < 100'000; ++i) panel.clouds[0].x.push_back(i % 2 ? 0.3 : 0.7), panel.clouds[0].y.push_back(0.5);
    const auto red = [&] {
        const Image image = draw_png(figure, "elsevier", 300).image;
        return std::ranges::count_if(image.pixels, [](std::uint32_t p) { return (p & 0xFFFFFF) == 0xFF0000; });
    };
    const auto few = red();
    EXPECT_GE(few, 2 * 25);  // two squares of 1.6 pt
    panel.clouds[0].x.resize(2), panel.clouds[0].y.resize(2);
    EXPECT_EQ(red(), few);
}

// At the edge of the plot, too.
TEST(Figure, MarkersAreWhole) {
    Figure figure;
    figure.panels.emplace_back();
    Panel& panel = figure.panels[0];
    panel.x.from = panel.y.from = 0, panel.x.to = panel.y.to = 1;
    panel.series.push_back({.line = false, .every_point = true, .color = rgb(0xFF0000)});
    const auto red = [&](double x) {
        panel.series[0].x = {x}, panel.series[0].y = {0.55};
        const Image image = draw_png(figure, "elsevier", 300).image;
        return std::ranges::count_if(image.pixels, [](std::uint32_t p) { return (p & 0xFFFFFF) == 0xFF0000; });
    };
    EXPECT_NEAR(static_cast<double>(red(0)), static_cast<double>(red(0.45)), 10);
    EXPECT_EQ(red(-0.1), 0);
}

TEST(Figure, LabelsAreBrokenBeforeTheUnit) {
    Figure figure = plot({0, 1}, {0, 1});
    figure.panels[0].y.label = "approach speed of the beam / (m s^{−1})";
    figure.panels[0].legend = false;
    const Fonts fonts(false, Typefaces::print);
    for (const double height : {25.0, 35.0, 45.0, 60.0}) {
        figure.height = height;
        const Page page = page_of(figure, *column_named("elsevier"));
        PageCanvas sheet(Medium::pdf, {points(page.width), points(page.height)}, fonts);
        draw(figure, page, sheet);
        EXPECT_TRUE(std::ranges::any_of(sheet.written, [](const auto& text) {
            return text.markup.ends_with("/\u00A0(m s^{−1})");
        })) << height;
    }
}

TEST(FigureData, HasAColumnForEachCurve) {
    Figure figure = plot({0, 1}, {0.1, std::nan("")});
    figure.panels[0].series[0].label = "a, b";
    EXPECT_EQ(data_csv(figure), "t / s,\"a, b: θ / rad\"\n0,0.10000000000000001\n1,\n");
    figure.panels[0].series[0].label.clear();
    EXPECT_THAT(data_csv(figure), HasSubstr("t / s,θ / rad\n"));  // the quantity of its axis
    figure.panels[0].series[0].name = "mean";
    EXPECT_THAT(data_csv(figure), HasSubstr("t / s,mean: θ / rad\n"));
    figure.panels[0].series[0].name = "ψ";
    figure.panels[0].y.label = "θ, ψ / rad";  // of a panel with two channels
    EXPECT_THAT(data_csv(figure), HasSubstr("t / s,ψ / rad\n"));
}

// The pale part of a curve, which is drawn first, is later in time; another curve has other instants.
TEST(FigureData, RowsAreInTheOrderOfTime) {
    Figure figure = plot({2, 3}, {5, 6});
    Series& pale = figure.panels[0].series[0];
    pale.faded = true;
    figure.panels[0].series.push_back(
        {.label = "θ", .x = {0, 1, 2, 2}, .y = {3, 4, 5, std::nan("")}, .look = pale.look});
    figure.panels[0].series.push_back({.label = "data", .x = {1.5, 3}, .y = {7, 8}, .look = 1, .line = false});
    figure.panels[0].rules.push_back({.at = 0.5, .vertical = true});
    EXPECT_EQ(data_csv(figure), "t / s,θ / rad,data: θ / rad\n0,3,\n1,4,\n1.5,,7\n2,5,\n3,6,8\n");
}

// A curve that is no function of x has the time before x and y.
TEST(FigureData, RowsOfAPhasePortraitAreInTheOrderOfTime) {
    Figure figure = plot({1, 0, 2}, {4, 5, 6});
    figure.panels[0].x.label = "x / m";
    figure.panels[0].series[0].t = {0.1, 0.2, 0.3};
    figure.panels[0].series[0].label.clear();
    EXPECT_EQ(data_csv(figure),
              "t / s,x / m,θ / rad\n0.10000000000000001,1,4\n0.20000000000000001,0,5\n0.29999999999999999,2,6\n");
}

TEST(FigureData, CloudsHaveALineAPoint) {
    Figure figure = plot({0}, {1});
    figure.panels[0].clouds.push_back({.label = "samples", .x = {2}, .y = {3}});
    EXPECT_EQ(
        data_csv(figure),
        "panel,series,x_quantity,x,y_quantity,y,value\n1,curve,t / s,0,θ / rad,1,\n1,samples,t / s,2,θ / rad,3,\n");
}

TEST(FigureData, ACurveHasEachInstantOnceUnlessItJumpsThere) {
    Figure figure;
    figure.panels.emplace_back();
    figure.panels[0].x.label = "t / s";
    figure.panels[0].series = {{.x = {0, 1, 1, 2, 2}, .y = {5, 6, 6 * (1 + 1e-15), 7, 8}},
                               {.x = {1, 1}, .y = {3, 3}, .name = "points", .line = false}};
    const std::string csv = data_csv(figure);
    EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 4) << csv;
    EXPECT_THAT(csv, HasSubstr("\n1,6,3\n2,7,\n2,8,\n"));
}

TEST(Phrases, HaveChineseForEveryChannel) {
    for (const sim::ChannelRow& row : sim::kChannels)
        EXPECT_NE(translated(Lang::zh, row.label.words), row.label.words) << row.name;
    EXPECT_EQ(translated(Lang::zh, "my own label"), "my own label");
    EXPECT_EQ(phrase(Lang::zh, "error of {} / rad", "$θ$"), "$θ$ 的误差 / rad");
}

}  // namespace
}  // namespace beamcam::render::figure
