// Films with every panel, several motions and perspective: pixels do not depend on the order of frames or the number of
// threads, and texts do not overlap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <span>

#include "render/draw/dirty_tiles.hpp"
#include "render/draw/markup.hpp"
#include "render/film/film.hpp"
#include "render/film/mechanism_view.hpp"
#include "render/film/strip_content.hpp"
#include "render/mechanism/projection.hpp"
#include "render/plot/labels.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

// As Cairo rounds an opaque colour, through 16 bits a channel.
std::uint32_t pixel_of(const Color& c) {
    const auto channel = [](double share) { return static_cast<std::uint32_t>(share * 65535 + 0.5) >> 8; };
    return 255U << 24 | channel(c.r) << 16 | channel(c.g) << 8 | channel(c.b);
}

LayoutNode leaf(PanelSpec spec, double share = 1) { return {.share = share, .panel = std::move(spec)}; }
LayoutNode grid(LayoutNode::Kind kind, std::vector<LayoutNode> children, double share = 1) {
    return {.kind = kind, .share = share, .children = std::move(children)};
}
PanelSpec strip(ChannelKind kind) { return {.kind = PanelKind::strip, .channels = {{kind, 0}}}; }

// All kinds of panels at once.
FilmSetup everything() {
    FilmSetup setup = test::flat_film({.duration = 0.8}, 1920, 1080);
    setup.chart.channels.push_back({ChannelKind::theta_dot, 0});
    setup.chart.channels.push_back({ChannelKind::energy_kinetic, 0});
    setup.chart.channels.push_back({ChannelKind::energy_potential, 0});
    std::vector<double> rate, kinetic, potential;
    for (double t : setup.chart.values[0]) {
        rate.push_back(std::sin(9 * t)), kinetic.push_back(std::pow(std::sin(7 * t), 2));
        potential.push_back(std::pow(std::cos(7 * t), 2));
    }
    for (auto* values : {&rate, &kinetic, &potential}) setup.chart.values.push_back(*values);
    PanelSpec by_collision = strip(ChannelKind::contact_force), moving = strip(ChannelKind::theta_dot);
    by_collision.by_collision = true;
    moving.window = 0.1;
    using enum LayoutNode::Kind;
    setup.layout =
        grid(columns, {grid(rows, {leaf({.kind = PanelKind::mechanism}, 2), leaf({.kind = PanelKind::energy})}, 1.5),
                       grid(rows, {leaf({.kind = PanelKind::phase}), leaf({.kind = PanelKind::close_up})}),
                       grid(rows, {leaf(strip(ChannelKind::theta)), leaf(by_collision), leaf(moving)})});
    setup.speeds.assign(setup.poses.size(), 1);
    setup.speeds[20] = 0.02, setup.speeds[21] = 0;
    setup.callouts = {{15, 30, "first touch"}};
    return setup;
}

FilmSetup compared(Comparison how) {
    FilmSetup setup = test::synthetic_film({.duration = 0.8});
    const FilmSetup faster = test::synthetic_film({.duration = 0.8, .amplitude = 4e-3, .speed = 2});
    setup.width = 1280, setup.height = 720;
    setup.view.style = Style::flat;
    setup.label = "ω = 5";
    setup.others.push_back(faster);
    setup.others.back().label = "ω = 2";
    setup.comparison = how;
    return setup;
}

void same_in_any_order(FilmSetup setup) {
    Film film(std::move(setup));
    const int frames[] = {0, 7, 20, 21, 33, 47};
    std::vector<Image> forward;
    for (int k : frames) forward.push_back(drawn(film, k));
    Film fresh = film.for_thread();
    for (int i = 5; i >= 0; --i) EXPECT_EQ(drawn(fresh, frames[i]), forward[std::size_t(i)]) << frames[i];
    for (int i = 1; i < 6; ++i) EXPECT_NE(forward[std::size_t(i)], forward[std::size_t(i) - 1]) << frames[i];
}

TEST(Panels, SamePixelsInAnyOrder) { same_in_any_order(everything()); }
TEST(Panels, ComparisonsHaveTheSamePixelsInAnyOrder) {
    same_in_any_order(compared(Comparison::panels));
    same_in_any_order(compared(Comparison::ghosts));
}
TEST(SolidFilm, SamePixelsInAnyOrder) {
    SKIP_WITHOUT_GL();
    FilmSetup setup = test::synthetic_film({.duration = 0.8});
    setup.width = 640, setup.height = 360;
    setup.view.style = Style::solid;
    same_in_any_order(std::move(setup));
}

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

// Measured data as a line, as points and as a straight beam.
FilmSetup with_data() {
    FilmSetup setup = everything();
    FilmData rig, other;
    rig.label = "rig", other.label = "other", other.line = true;
    for (const double t : setup.chart.values[0])
        if (t < 0.5) rig.t.push_back(t + 0.01), other.t.push_back(t);
    rig.values = {{{ChannelKind::theta, 0}, std::vector<double>(rig.t.size(), 0.55)}};
    other.values = {{{ChannelKind::theta_dot, 0}, std::vector<double>(other.t.size(), 0.2)}};
    setup.data = {rig, other};
    return setup;
}
TEST(FilmData, HaveTheSamePixelsInAnyOrder) { same_in_any_order(with_data()); }
TEST(FilmData, AreDrawnWhereTheyHaveValues) {
    Film without(everything()), with(with_data());
    const FrameGeometry geometry = with.geometry(12);
    const Vec2 tip = geometry.camera.to_pixels(sim::unit(0.55) * 1.0);
    const Box at_tip = Box{tip.x, tip.y, 0, 0}.inset(-20);
    EXPECT_GT(differing_pixels(drawn(without, 12), drawn(with, 12), at_tip), 30);
}

TEST(Panels, StandStillWhileTimeDoes) { stands_still(everything()); }
TEST(Panels, ComparisonsStandStillWhileTimeDoes) {
    stands_still(compared(Comparison::panels));
    stands_still(compared(Comparison::ghosts));
}

// ---- visible parts -------------------------------------------------------------------------------

TEST(Plates, OnlyAPictureWithRoomStatesTheFactor) {
    const auto states = [](int width, int height) {
        FilmSetup setup = test::flat_film({.duration = 0.1}, width, height);
        setup.view.exaggeration = 5;
        return Film(std::move(setup)).states_exaggeration();
    };
    EXPECT_TRUE(states(1280, 720));
    EXPECT_FALSE(states(90, 60));
}

// Text is readable on any paper, and pale colours are visible.
TEST(Plates, ThePaperOfAnyColourKeepsTextReadable) {
    for (const Theme theme : {Theme::light, Theme::dark, Theme::print})
        for (const std::uint32_t paper : {0x7A7A7AU, 0x003355U, 0xF4F1EAU, 0x000000U, 0xFFFFFFU, 0xFFCC00U}) {
            const Palette p = on_paper(palette(theme), rgb(paper));
            EXPECT_EQ(p.paper, rgb(paper));
            EXPECT_GE(contrast(p.ink, p.paper), 4.5) << paper;
            EXPECT_GE(contrast(p.muted, p.paper), 4.5) << paper;
            EXPECT_GT(contrast(p.grid, p.paper), 1.05) << paper;
        }
    const Palette& light = palette(Theme::light);
    const Palette same = on_paper(light, light.paper);
    EXPECT_EQ(same.ink, light.ink);
    EXPECT_NEAR(same.grid.r, light.grid.r, 0.02);
}

// ---- intervals that are not reproducible -------------------------------------------------------

TEST(Unreliable, CurvesArePalerWithinTheIntervals) {
    FilmSetup setup = everything();
    setup.layout = leaf(strip(ChannelKind::theta));
    Film plain(setup);
    setup.unreliable = {{0.2, 0.4}};
    Film film(setup);
    EXPECT_EQ(drawn(film, 11), drawn(plain, 11));  // not yet
    const Image now = drawn(film, 47), before = drawn(plain, 47);
    int left = now.width, right = 0;
    for (int y = 0; y < now.height; ++y)
        for (int x = 0; x < now.width; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(now.width) + std::size_t(x);
            if (before.pixels[i] != now.pixels[i]) left = std::min(left, x), right = std::max(right, x);
        }
    const Box box = film.geometry(0).layout.panels.front().box;
    EXPECT_NEAR(right - left, 0.25 * box.w, 0.03 * box.w);  // of 0.8 s
    EXPECT_NEAR((left + right) / 2.0, box.x + 0.4 * box.w, 0.05 * box.w);
}
TEST(Unreliable, PaleCurvesHaveTheSamePixelsInAnyOrder) {
    FilmSetup setup = everything();
    setup.unreliable = {{0.1, 0.25}, {0.4, std::numeric_limits<double>::infinity()}};
    same_in_any_order(setup);
}

// All texts of the user choose the fonts, also the names of measured data.
TEST(Films, DataWithAChineseNameShowIt) {
    FilmSetup setup = with_data();
    ASSERT_FALSE(setup.data.empty());
    const auto widest_text = [&](const std::string& label) {
        setup.data.front().label = label;
        const FilmContext context(std::make_shared<const FilmSetup>(setup));
        Image scratch(1, 1);
        Canvas canvas(scratch, *context.fonts);
        return canvas.measure(context.data_labels.front(), {.size = 20}).w;
    };
    EXPECT_GT(widest_text("测量数据"), 60);
}

TEST(Films, InChineseHaveNoLetterBoxes) {
    FilmSetup setup = everything();
    setup.view.lang = Lang::zh;
    Film film(setup);
    EXPECT_FALSE(film.geometry(20).texts.empty());
}

// ---- only changed parts are redrawn ------------------------------------------------------------

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
TEST(LitFilm, MovingPartsAreDrawnAsIfAllWere) {
    SKIP_WITHOUT_GL();
    gl_films_are_drawn_as_if_all_were(Style::lit);
}
TEST(SolidFilm, MovingPartsAreDrawnAsIfAllWere) {
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

void texts_keep_apart(FilmSetup setup) {
    const Box all{0, 0, double(setup.width), double(setup.height)};
    Film film(std::move(setup));
    for (int frame : {0, 20, 25, 40}) {
        const std::vector<Box> texts = film.geometry(frame).texts;
        for (std::size_t i = 0; i < texts.size(); ++i) {
            EXPECT_TRUE(all.contains(texts[i], 0.5)) << frame << ": " << i;
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_FALSE(texts[i].overlaps(texts[j]))
                    << "frame " << frame << ": texts " << i << " and " << j << " at " << texts[i].x << "," << texts[i].y
                    << " and " << texts[j].x << "," << texts[j].y;
        }
    }
}
TEST(Panels, TextKeepsWithinThePictureAndApart) {
    texts_keep_apart(everything());
    texts_keep_apart(with_data());
}
TEST(Panels, TextOfComparisonsKeepsApart) {
    texts_keep_apart(compared(Comparison::panels));
    texts_keep_apart(compared(Comparison::ghosts));
}

TEST(Panels, ComparedMechanismsHaveOneScaleAndOneFactor) {
    Film film(compared(Comparison::panels));
    const Layout layout = film.geometry(10).layout;
    std::vector<Box> boxes;
    for (const PanelSlot& slot : layout.panels)
        if (slot.spec.kind == PanelKind::mechanism) boxes.push_back(slot.box);
    ASSERT_EQ(boxes.size(), 2U);
    EXPECT_NEAR(boxes[0].w, boxes[1].w, 1);
    EXPECT_EQ(boxes[0].h, boxes[1].h);
}

TEST(Panels, MotionsAtOtherInstantsAreRefused) {
    FilmSetup setup = compared(Comparison::panels);
    setup.others[0].poses.pop_back();
    EXPECT_ANY_THROW(Film{std::move(setup)});
}

TEST(Panels, ATransparentFilmHasNoPaper) {
    FilmSetup setup = test::flat_film({.duration = 0.2}, 960, 540);
    setup.view.transparent = true;
    Film film(std::move(setup));
    const Image image = drawn(film, 3);
    EXPECT_EQ(image.pixels.front(), 0U);
    std::size_t opaque = 0;
    for (std::uint32_t p : image.pixels) opaque += p >> 24 == 255;
    EXPECT_GT(opaque, 10000U);
}

TEST(Panels, WordsOfATransparentLightFilmAreReadOnDarkGroundsToo) {
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
TEST(Panels, ThePastOfATransparentChartIsOutlinedAndTheFutureFaint) {
    FilmSetup setup = test::flat_film({.duration = 1}, 960, 540);
    setup.view.transparent = true;
    setup.layout = leaf({.kind = PanelKind::strip, .channels = {{ChannelKind::theta, 0}}});
    Film film(std::move(setup));
    const Image image = drawn(film, film.frames() / 2);
    const Box plot = film.geometry(0).layout.panels.front().box.inset(60);
    const auto strongest = [&](double from, double to) {  // alpha, away from axes and cursor
        std::uint32_t most = 0;
        for (int y = int(plot.y); y < int(plot.bottom()); ++y)
            for (int x = int(from); x < int(to); ++x)
                most = std::max(most, image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)] >> 24);
        return most;
    };
    const double middle = plot.centre().x;
    EXPECT_GT(strongest(plot.x + 60, middle - 40), 240U);
    EXPECT_LT(strongest(middle + 60, plot.right() - 20), 130U);
}

// Opaque paper around letters would be visible on any background.
TEST(Panels, TextsOfATransparentFilmHaveNoPaperAroundThem) {
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

TEST(Energy, LossesThatNobodyHasLeaveTheOthers) {
    const auto ledger = [](double nothing) {
        FilmSetup setup = test::flat_film({.duration = 0.3, .cam = false}, 960, 540);
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
        FilmSetup setup = test::flat_film({.duration = 0.3, .cam = false}, 960, 540);
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
                count += image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(plot.x + 0.3 * plot.w)] ==
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

// Rows of the chart are coarser than an impact: the curve shows its peak nevertheless.
TEST(ForceStrip, ReachesThePeakOfEveryImpact) {
    const auto highest = [](double end) {
        FilmSetup setup = test::flat_film({.duration = 0.1}, 1280, 720);
        setup.impacts.clear();
        for (auto& column : setup.trace.values) column.clear();
        setup.chart.values.assign(setup.chart.channels.size(), {});
        for (int i = 0; i <= 250; ++i) {  // three rows within the impact, none at its peak
            const double t = end * i / 250;
            const bool in = t > 0.02 && t < 0.03;
            setup.chart.values[0].push_back(t);
            setup.chart.values[1].push_back(0.5);
            setup.chart.values[2].push_back(in ? 40 : 0);
        }
        sim::Impact impact;
        impact.t_start = 0.02, impact.t_end = 0.03, impact.force_peak = 100;
        setup.impacts.push_back(impact);
        setup.layout = leaf(strip(ChannelKind::contact_force));
        const Color faint = palette(setup.view.theme).contact_faint;
        const std::size_t last = setup.poses.size() - 1;
        setup.poses[last].t = end;
        Film film(std::move(setup));
        const Layout places = film.geometry(0).layout;
        const Box box = places.first(PanelKind::strip)->box, plot = plot_area(box, places.unit, places.letters.words);
        const Image image = drawn(film, 0);
        const double u = places.unit;
        for (int y = int(box.y + 46 * u); y < int(box.bottom()); ++y)
            for (int x = int(plot.x + 4 * u); x < int(box.right()); ++x) {
                const std::uint32_t p = image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
                if (std::abs((p >> 16 & 255) / 255.0 - faint.r) + std::abs((p >> 8 & 255) / 255.0 - faint.g) +
                        std::abs((p & 255) / 255.0 - faint.b) <
                    0.03)
                    return (plot.bottom() - y) / plot.h;
            }
        return 0.0;
    };
    // The axis ends at 102, rounded up to 120 or 150.
    EXPECT_GT(highest(1), 0.6);
    EXPECT_GT(highest(0.5), 0.6);
}

// Few dots far apart are too small to be seen in the pale colour of the future, in which a line of dots is visible.
TEST(Panels, SingleDotsOfTheFutureAreStrongerThanALineOfDots) {
    const auto future_of = [](bool line) {
        FilmSetup setup = test::synthetic_film({.duration = 1});
        setup.impacts.clear();
        std::vector<std::vector<double>>& columns = setup.trace.values;
        for (std::vector<double>& column : columns) column.clear();
        for (int i = 0; i < 500; ++i) {
            const bool touches = line ? i > 250 : i == 100 || i == 101 || i == 400;
            const std::array row{i / 500.0, 0.25, 0.1, touches ? 10.0 : 0.0};
            for (std::size_t k = 0; k < row.size(); ++k) columns[k].push_back(row[k]);
        }
        const FilmContext context(std::make_shared<const FilmSetup>(std::move(setup)));
        return strip_content(context, strip(ChannelKind::contact_x)).panel.dots;
    };
    const std::vector<figure::Dot> single = future_of(false), line = future_of(true);
    ASSERT_EQ(single.size(), 3U);
    ASSERT_EQ(line.size(), 249U);
    const Palette& p = palette(Theme::light);
    EXPECT_GT(contrast(p.paper, single[0].faint), 1.15 * contrast(p.paper, line[0].faint));
    for (const figure::Dot& dot : single) EXPECT_EQ(dot.faint, single[0].faint);
}

// One impact at 50 ms with a half-sine force, and pictures at these instants.
FilmSetup struck(const PanelSpec& spec, const std::vector<double>& instants) {
    constexpr double kTouch = 0.05, kRelease = 0.0504, kPeak = 100, kStep = 2e-5;
    FilmSetup setup = test::flat_film({.duration = 0.1}, 1280, 720);
    for (auto& column : setup.trace.values) column.clear();
    setup.chart.channels = {{ChannelKind::t, 0}, {ChannelKind::contact_force, 0}};
    setup.chart.values.assign(2, {});
    const auto force = [&](double t) {
        const double share = (t - kTouch) / (kRelease - kTouch);
        return share > 0 && share < 1 ? kPeak * std::sin(std::numbers::pi * share) : 0.0;
    };
    for (int i = 0; i <= 5000; ++i) {
        setup.chart.values[0].push_back(i * kStep);
        setup.chart.values[1].push_back(force(i * kStep));
    }
    sim::Impact impact;
    impact.t_start = kTouch, impact.t_end = kRelease, impact.force_peak = kPeak;
    setup.impacts = {impact};
    setup.poses.resize(instants.size());
    for (std::size_t k = 0; k < instants.size(); ++k) {
        setup.poses[k].t = instants[k];
        setup.poses[k].nearest->force = force(instants[k]);
    }
    setup.layout = leaf(spec);
    return setup;
}

// Height of the past part of the curve, relative to the plot.
double highest_past(Film& film, int frame) {
    const FrameGeometry g = film.geometry(frame);
    const double u = g.layout.unit;
    const Box plot = plot_area(g.layout.first(PanelKind::strip)->box, u, g.layout.letters.words);
    const Color past = palette(Theme::light).contact;
    const Image image = drawn(film, frame);
    for (int y = int(plot.y); y < int(plot.bottom()); ++y)
        for (int x = int(plot.x); x < int(plot.right()); ++x) {
            const std::uint32_t p = image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
            if (std::abs((p >> 16 & 255) / 255.0 - past.r) + std::abs((p >> 8 & 255) / 255.0 - past.g) +
                    std::abs((p & 255) / 255.0 - past.b) <
                0.35)
                return (plot.bottom() - y) / plot.h;
        }
    return 0;
}

// Before the first touch the axis of force has neither numbers nor levels.
TEST(ForceStrip, WithoutContactHasNoInventedAxis) {
    const auto texts_left_of_plot = [](double duration) {
        FilmSetup setup = test::synthetic_film({.duration = duration});
        setup.width = 960, setup.height = 540;
        setup.layout = leaf({.kind = PanelKind::strip, .channels = {{ChannelKind::contact_x, 0}}});
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(2);
        const Box plot = plot_area(g.layout.panels.front().box, g.layout.unit, g.layout.letters.words);
        return std::ranges::count_if(g.texts, [&](const Box& text) {
            return text.right() < plot.x && text.bottom() < plot.bottom() - 12 && text.y > plot.y;
        });
    };
    EXPECT_EQ(texts_left_of_plot(0.1), 0);
    EXPECT_GT(texts_left_of_plot(2), 0);
}

TEST(ForceStrip, DrawsNothingAfterTheInstantAsPast) {
    PanelSpec by_collision = strip(ChannelKind::contact_force), moving = by_collision;
    by_collision.by_collision = true;
    moving.window = 0.02;
    for (const PanelSpec& spec : {strip(ChannelKind::contact_force), by_collision, moving}) {
        // At the touch, and shortly after it at 16 N of 100 N.
        Film film(struck(spec, {0.05, 0.05002, 0.0505}));
        EXPECT_LT(highest_past(film, 0), 0.05);
        EXPECT_LT(highest_past(film, 1), 0.25);
        EXPECT_GT(highest_past(film, 2), 0.6);  // then it is past
    }
}

// A quantity has one unit in a film: "0.4 N" and "90.0 N" on one axis, not "400 mN".
TEST(ForceStrip, ReadsTheForceInTheUnitOfTheAxis) {
    const auto reading_width = [](double force) {
        FilmSetup setup = struck(strip(ChannelKind::contact_force), {0.04});
        setup.poses[0].nearest->force = force;
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(0);
        const Box box = g.layout.first(PanelKind::strip)->box;
        const double u = g.layout.unit, right = plot_area(box, u, g.layout.letters.words).right();
        for (const Box& text : g.texts)
            if (std::abs(text.right() - right - 8 * u) < 4 * u && text.y < box.y + 30 * u) return text.w;
        return 0.0;
    };
    EXPECT_GT(reading_width(0), 0);
    EXPECT_NEAR(reading_width(0.4), reading_width(0), 1);
    EXPECT_GT(reading_width(90), 1.1 * reading_width(0));  // another digit
}

// Several forces of one motion have readings of zero, as one force alone has; of several motions they would be a row of
// zeros.
TEST(ForceStrip, ReadsZeros) {
    const auto readings = [](FilmSetup setup) {
        setup.poses[0].nearest->force = 0;
        setup.layout = leaf({.kind = PanelKind::strip,
                             .channels = {{ChannelKind::contact_force, 0}, {ChannelKind::friction_force, 0}}});
        setup.chart.channels.push_back({ChannelKind::friction_force, 0});
        setup.chart.values.emplace_back(setup.chart.values[0].size(), 0.0);
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(0);
        const Box box = g.layout.first(PanelKind::strip)->box;
        std::vector<double> widths;  // from the right
        for (const Box& text : g.texts)
            if (text.y > box.y && text.y < box.y + 30 * g.layout.unit && text.x > box.centre().x)
                widths.push_back(text.w);
        return widths;
    };
    const std::vector<double> found = readings(struck(strip(ChannelKind::contact_force), {0.04}));
    ASSERT_EQ(found.size(), 4u);    // two numbers and two names
    EXPECT_EQ(found[0], found[2]);  // "0 N" twice, not a dash
    EXPECT_GT(found[0], found[1]);  // than "F"
}

// The reading is at the right end of the heading's line while the cursor is inside the axes.
bool has_reading(const FrameGeometry& g) {
    const Box box = g.layout.first(PanelKind::strip)->box;
    return std::ranges::any_of(g.texts, [&](const Box& text) {
        return text.x > box.centre().x && text.bottom() < box.y + 34 * g.layout.unit && text.y > box.y;
    });
}

// A lasting contact that began more than a tenth of a second before the picture.
TEST(CollisionStrip, AContactThatLastsIsSeenWhereThePictureIs) {
    for (const int frames : {1, 30}) {
        FilmSetup setup = test::flat_film({.duration = 2}, 1280, 720);
        setup.poses.erase(setup.poses.begin(), setup.poses.end() - frames);
        if (frames > 1)  // charts begin with the film
            for (auto& column : setup.chart.values) column.erase(column.begin(), column.begin() + 1500);
        setup.impacts.clear();
        sim::Impact open;
        open.t_start = 0.3;
        setup.impacts.push_back(open);
        PanelSpec by_collision = strip(ChannelKind::contact_force);
        by_collision.by_collision = true;
        setup.layout = leaf(by_collision);
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(frames - 1);
        EXPECT_TRUE(has_reading(g)) << frames;
    }
}

// A collision of many impacts is seen to its end.
TEST(CollisionStrip, ShowsTheWholeCollision) {
    FilmSetup setup = test::flat_film({.duration = 1}, 1280, 720);
    setup.impacts.clear();
    for (const double t : {0.3, 0.45, 0.6}) {
        sim::Impact impact;
        impact.t_start = t, impact.t_end = t + 0.02;
        setup.impacts.push_back(impact);
    }
    PanelSpec by_collision = strip(ChannelKind::contact_force);
    by_collision.by_collision = true;
    setup.layout = leaf(by_collision);
    Film film(std::move(setup));
    for (const int frame : {19, 28, 37}) {  // within each impact
        const FrameGeometry g = film.geometry(frame);
        EXPECT_TRUE(has_reading(g)) << frame;
    }
}

// A deflection of the size of rounding errors is drawn as zero.
TEST(Strips, RoundingOfALengthIsZero) {
    const auto picture = [](double size) {
        FilmSetup setup = test::flat_film({.duration = 0.5}, 960, 540);
        setup.chart.channels.push_back({ChannelKind::tip_deflection, 0});
        std::vector<double> v;
        for (const double t : setup.chart.values[0]) v.push_back(size * std::sin(50 * t));
        setup.chart.values.push_back(v);
        setup.layout = leaf(strip(ChannelKind::tip_deflection));
        Film film(std::move(setup));
        return drawn(film, 20);
    };
    EXPECT_EQ(picture(1e-22), picture(0));
    EXPECT_NE(picture(1e-12), picture(0));
}

// Numbers with many decimals stand apart.
TEST(Strips, NumbersOfAShortWindowStandApart) {
    FilmSetup setup = test::flat_film({.duration = 1}, 1280, 720);
    PanelSpec moving = strip(ChannelKind::theta);
    moving.window = 2e-4;
    setup.layout = grid(LayoutNode::Kind::columns, {leaf(moving), leaf(moving), leaf(moving)});
    Film film(std::move(setup));
    const FrameGeometry g = film.geometry(17);
    ASSERT_EQ(g.layout.panels.size(), 3U);
    const Box box = g.layout.panels.front().box, plot = plot_area(box, g.layout.unit, g.layout.letters.words);
    std::vector<Box> numbers;
    for (const Box& text : g.texts)
        if (text.y > plot.bottom() && text.bottom() < box.bottom() + 1 && text.x < box.right()) numbers.push_back(text);
    ASSERT_GE(numbers.size(), 2U);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(numbers[i].inset(-3).overlaps(numbers[j].inset(-3)));
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

// The axis of a still suits the window that it shows; that of a film suits all its windows.
TEST(Strips, AWindowInAStillHasItsOwnRange) {
    const auto range = [](std::size_t frames, std::optional<double> window) {
        FilmSetup setup = test::flat_film({.duration = 0.5}, 1280, 720);
        setup.poses.erase(setup.poses.begin(), setup.poses.end() - static_cast<std::ptrdiff_t>(frames));
        PanelSpec spec = strip(ChannelKind::theta);
        spec.window = window;
        const FilmContext context(std::make_shared<const FilmSetup>(std::move(setup)));
        const ChartContent c = strip_content(context, spec);
        return c.values().high - c.values().low;
    };
    EXPECT_LT(range(1, 0.02), 0.3 * range(1, {}));
    EXPECT_LT(range(1, 0.02), range(20, 0.02));
    EXPECT_LT(range(20, 0.02), 0.8 * range(20, {}));  // the chart also contains the motion before the film
}

// Arrows are proportional to the force, in the mechanism and in the close-up.
TEST(ForceArrows, AreInProportionToTheForce) {
    for (const PanelKind kind : {PanelKind::mechanism, PanelKind::close_up}) {
        FilmSetup setup = test::flat_film({.duration = 0.1}, 1280, 1280);
        setup.impacts.clear();
        for (auto& column : setup.trace.values) column.clear();
        // The same pose with three forces: the first sets the scale, the arrows of the others are compared.
        sim::Pose pose = test::synthetic_pose(setup.problem, {}, 1.99);
        pose.nearest->touching = true, pose.nearest->gap = -1e-5, pose.nearest->friction = 0;
        setup.poses.clear();
        for (const double force : {200.0, 180.0, 90.0}) {
            pose.nearest->force = force;
            setup.poses.push_back(pose);
            pose.t += 0.01;
        }
        setup.layout = leaf({.kind = kind});
        setup.view.show.labels = false;  // F is beyond the tip
        const Color contact = palette(setup.view.theme).contact;
        Film film(std::move(setup));
        const Box box = film.geometry(1).layout.first(kind)->box;
        // Length along which the arrow's colour is found.
        const auto length = [&](int frame) {
            const Image image = drawn(film, frame);
            const FrameGeometry g = film.geometry(frame);
            const bool close = kind == PanelKind::close_up;
            const Vec2 along = close ? Vec2{0, 1} : g.beam.contact->normal;
            const double u = g.layout.unit;
            const Vec2 foot =
                close ? Vec2{box.x + 70 * u + (box.w - 78 * u) / 2, 0} : g.camera.to_pixels(g.beam.contact->on_disc);
            double top = -1e9, bottom = 1e9;
            for (int y = int(box.y + 46 * u); y < int(box.bottom()); ++y)
                for (int x = int(box.x); x < int(box.right()); ++x) {
                    const Vec2 off{x - foot.x, foot.y - y};
                    if (std::abs(cross(along, off)) > 10 * u) continue;
                    const std::uint32_t p = image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
                    if (std::abs((p >> 16 & 255) / 255.0 - contact.r) + std::abs((p >> 8 & 255) / 255.0 - contact.g) +
                            std::abs((p & 255) / 255.0 - contact.b) <
                        0.02)
                        top = std::max(top, dot(along, off)), bottom = std::min(bottom, dot(along, off));
                }
            return top - bottom - (close ? 3.5 : 5) * u;  // the dot reaches below the arrow's foot
        };
        EXPECT_GT(length(2), 40) << type_of(kind).name;
        // Antialiasing hides about two pixels of the tip.
        EXPECT_NEAR(length(1) / length(2), 2, 0.12) << type_of(kind).name;
    }
}

TEST(CloseUp, HasTwoMarksHoweverLow) {
    for (const int height : {240, 300, 400, 700}) {
        FilmSetup setup = test::flat_film({.duration = 0.1}, 960, height);
        setup.layout = leaf({.kind = PanelKind::close_up});
        Film film(std::move(setup));
        const FrameGeometry g = film.geometry(0);
        const Box box = g.layout.first(PanelKind::close_up)->box;
        const auto marks = std::ranges::count_if(g.texts, [&](const Box& b) {
            return b.right() < plot_area(box, g.layout.unit, g.layout.letters.words).x - 8 * g.layout.unit &&
                   b.y > box.y + 30 * g.layout.unit && b.bottom() < box.bottom() - 30 * g.layout.unit;
        });
        EXPECT_GE(marks, 2) << height;
    }
}

TEST(Mechanism, TheAngleIsDrawnInTheSenseTheHubHasTurned) {
    // The arc of 200° is counter-clockwise: it crosses the vertical above the hub.
    FilmSetup setup = test::flat_film({.duration = 0.1, .cam = false}, 1200, 1200);
    const double angle = 200 * std::numbers::pi / 180;
    for (sim::Pose& pose : setup.poses) {
        const std::size_t n = pose.centreline.size();
        for (std::size_t i = 0; i < n; ++i) pose.centreline[i] = sim::unit(angle) * (double(i) / double(n - 1));
        pose.theta = angle;
    }
    // The first frame's beam points to the right and leaves space.
    sim::Pose& other = setup.poses.front();
    for (std::size_t i = 0; i < other.centreline.size(); ++i)
        other.centreline[i] = sim::unit(0.1) * (double(i) / double(other.centreline.size() - 1));
    other.theta = 0.1;
    setup.layout = leaf({.kind = PanelKind::mechanism});
    const Color muted = palette(setup.view.theme).muted;
    Film film(std::move(setup));
    const FrameGeometry g = film.geometry(2);
    const Image image = drawn(film, 2);
    const Vec2 hub = g.camera.to_pixels({0, 0});
    const auto has_arc = [&](double side) {
        for (double r = 80 * g.layout.unit; r < 160 * g.layout.unit; ++r) {
            const auto x = std::size_t(hub.x), y = std::size_t(hub.y + side * r);
            const std::uint32_t p = image.pixels[y * std::size_t(image.width) + x];
            if (std::abs((p >> 16 & 255) / 255.0 - muted.r) + std::abs((p & 255) / 255.0 - muted.b) < 0.15) return true;
        }
        return false;
    };
    EXPECT_TRUE(has_arc(-1));
    EXPECT_FALSE(has_arc(1));
}

TEST(Layout, SharesDivideTheRoom) {
    using enum LayoutNode::Kind;
    const Layout l =
        layout(1920, 1080, grid(columns, {leaf({.kind = PanelKind::mechanism}, 3), leaf(strip(ChannelKind::theta))}));
    ASSERT_EQ(l.panels.size(), 2U);
    EXPECT_NEAR(l.panels[0].box.w / l.panels[1].box.w, 3, 0.01);
    EXPECT_EQ(l.panels[0].box.h, l.panels[1].box.h);
}

TEST(Layout, PanelsTooSmallToReadLeaveTheirRoomToOthers) {
    using enum LayoutNode::Kind;
    std::vector<LayoutNode> many;
    for (int i = 0; i < 12; ++i) many.push_back(leaf(strip(ChannelKind::theta)));
    const Layout l = layout(1280, 720, grid(rows, many));
    EXPECT_LT(l.panels.size(), 8U);
    EXPECT_GT(l.panels.size(), 1U);
    for (const PanelSlot& slot : l.panels) EXPECT_GE(slot.box.h, type_of(PanelKind::strip).smallest.y * l.unit - 1);
}

TEST(Layout, AGroupOfPanelsThatFindNoRoomLeavesItsOwn) {
    using enum LayoutNode::Kind;
    const LayoutNode wanted =
        grid(columns, {leaf({.kind = PanelKind::mechanism}, 3),
                       grid(rows, {leaf({.kind = PanelKind::energy}), leaf({.kind = PanelKind::phase})}, 1)});
    const Layout large = layout(1920, 1080, wanted), small = layout(400, 400, wanted);
    EXPECT_EQ(large.panels.size(), 3U);
    ASSERT_EQ(small.panels.size(), 1U);
    EXPECT_GT(small.panels[0].box.w, 0.85 * 400);
    EXPECT_EQ(omitted_panels(400, 400, wanted).size(), 2U);
}

TEST(Layout, ColumnsOfATallPictureStandBelowEachOther) {
    using enum LayoutNode::Kind;
    const LayoutNode two = grid(columns, {leaf({.kind = PanelKind::mechanism}), leaf(strip(ChannelKind::theta))});
    const Layout l = layout(1080, 1920, two);
    ASSERT_EQ(l.panels.size(), 2U);
    EXPECT_EQ(l.panels[0].box.x, l.panels[1].box.x);
    EXPECT_GT(l.panels[1].box.y, l.panels[0].box.bottom());
}

// In the middle of the close-up the height of the face above the rim equals the gap. The plot extends from 1.35 of the
// largest penetration below the rim to 1.9 above.
// Further impacts of a collision that the motion does not outlast are unknown.
TEST(CloseUp, CountsTheImpactsOfFinishedCollisionsOnly) {
    const auto inked = [](double end) {
        FilmSetup setup = test::flat_film({.duration = 0.4}, 960, 720);
        sim::Impact impact;
        impact.t_start = 0.1, impact.t_end = 0.3;
        setup.impacts = {impact};
        setup.end = end;
        setup.layout = leaf({.kind = PanelKind::close_up});
        Film film(std::move(setup));
        double wide = 0;
        for (const Box& text : film.geometry(12).texts) wide += text.w;
        return wide;
    };
    const double gap = *test::flat_film({.duration = 0.4}, 960, 720).problem.contact.collision_gap;
    EXPECT_EQ(inked(0.3 + 1.01 * gap), inked(10));       // "collision 1 · impact 1 of 1"
    EXPECT_LT(inked(0.3 + 0.99 * gap), inked(10) - 20);  // "collision 1 · impact 1"
}

TEST(CloseUp, TheDrawnGapIsTheSampledGap) {
    constexpr double kDeepest = 4e-5;  // [m]
    FilmSetup setup = test::flat_film({.duration = 0.4}, 960, 1080);
    setup.impacts.clear();
    for (std::size_t k = 0; k < setup.poses.size(); ++k) {
        sim::Nearest& near = *setup.poses[k].nearest;
        near.gap = kDeepest * (-1 + 2.4 * double(k) / double(setup.poses.size() - 1));
        near.force = 0, near.touching = false;
    }
    setup.layout = leaf({.kind = PanelKind::close_up});
    const auto poses = setup.poses;
    Film film(std::move(setup));
    const Layout places = film.geometry(0).layout;
    const Box box = places.first(PanelKind::close_up)->box;
    const double u = places.unit, low = -1.35 * kDeepest, high = 1.9 * kDeepest;
    const Box plot{std::round(box.x + 70 * u), std::round(box.y + 46 * u), std::round(box.w - 78 * u),
                   std::round(box.h - 86 * u)};
    const Color motion = palette(Theme::light).motion;
    // Centre of the rows that the line of the face covers.
    const auto row_of_face = [&](const Image& image) {
        double sum = 0, count = 0;
        const auto x = std::size_t(plot.x + plot.w / 2);
        for (int y = int(plot.y); y < int(plot.bottom()); ++y) {
            const std::uint32_t p = image.pixels[std::size_t(y) * std::size_t(image.width) + x];
            const double off = std::abs((p >> 16 & 255) / 255.0 - motion.r) +
                               std::abs((p >> 8 & 255) / 255.0 - motion.g) + std::abs((p & 255) / 255.0 - motion.b);
            if (off < 0.25) sum += y + 0.5, ++count;
        }
        return count > 0 ? sum / count : -1;
    };
    for (int k = 0; k < film.frames(); k += 2) {
        const double gap = poses[std::size_t(k)].nearest->gap;
        EXPECT_NEAR(row_of_face(drawn(film, k)), plot.bottom() - plot.h * (gap - low) / (high - low), 0.75)
            << "a gap of " << gap * 1e6 << " µm";
    }
}

// Harmonic motion with twelve rows per period: its portrait is an ellipse; chords would deviate by 3 %.
TEST(PhasePanel, DrawsCurvesBetweenTheRows) {
    FilmSetup setup = test::flat_film({.duration = 0.8}, 960, 960);
    setup.layout = leaf({.kind = PanelKind::phase});
    setup.title.clear();
    setup.chart.channels = {{ChannelKind::t, 0}, {ChannelKind::theta, 0}, {ChannelKind::theta_dot, 0}};
    setup.chart.values.assign(3, {});
    for (int i = 0; i <= 24; ++i) {
        const double turn = 2 * std::numbers::pi * i / 12;
        const double row[] = {0.8 * i / 24, std::cos(turn), std::sin(turn)};
        for (std::size_t c = 0; c < 3; ++c) setup.chart.values[c].push_back(row[c]);
    }
    for (sim::Pose& pose : setup.poses) pose.theta = pose.theta_dot = 0;
    const Color ink = series_color(palette(Theme::light), 0);
    Film film(std::move(setup));
    const Image image = drawn(film, film.frames() - 1);
    std::vector<Vec2> inked;
    Vec2 low{1e9, 1e9}, high{0, 0};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::uint32_t p = image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
            const double off = std::abs((p >> 16 & 255) / 255.0 - ink.r) + std::abs((p >> 8 & 255) / 255.0 - ink.g) +
                               std::abs((p & 255) / 255.0 - ink.b);
            if (off > 0.25) continue;
            inked.push_back({x + 0.5, y + 0.5});
            low = {std::min(low.x, x + 0.0), std::min(low.y, y + 0.0)};
            high = {std::max(high.x, x + 1.0), std::max(high.y, y + 1.0)};
        }
    const Vec2 half = 0.5 * (high - low), middle = low + half;
    ASSERT_GT(std::min(half.x, half.y), 150);
    int beside = 0;
    std::set<int> on;  // sectors of 6° with ink on the ellipse
    for (const Vec2& at : inked) {
        const double x = (at.x - middle.x) / half.x, y = (at.y - middle.y) / half.y, radius = std::hypot(x, y);
        if (radius < 0.1) continue;  // the point of now
        if (std::abs(radius - 1) < 0.015)
            on.insert(static_cast<int>(std::floor(std::atan2(y, x) * 30 / std::numbers::pi)));
        else
            ++beside;
    }
    EXPECT_GE(on.size(), 60u);
    EXPECT_EQ(beside, 0);
}

// The numbers of an axis have the unit of its label: the speed in rpm is drawn as its value in rad/s would be.
TEST(PhasePanel, ScalesEachAxisToItsOwnUnit) {
    const auto chart = [](SpeedUnit unit, double factor) {
        FilmSetup setup = test::flat_film({.duration = 0.8}, 960, 540);
        setup.layout = leaf({.kind = PanelKind::phase});
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

// Characters that no font has are removed instead of drawn as boxes.
TEST(Panels, PictographsLeaveNoBoxes) {
    FilmSetup plain = test::synthetic_film({.duration = 0.1}), decorated = plain;
    for (FilmSetup* setup : {&plain, &decorated}) {
        setup->width = 960, setup->height = 540;
        setup->view.style = Style::flat;
    }
    plain.title = "Fall θ₀ = 45°";
    decorated.title = "Fall\U0001F680 θ₀ = 45°\U0001F44D\uFE0F";
    Film a(std::move(plain)), b(std::move(decorated));
    EXPECT_EQ(drawn(a, 2), drawn(b, 2));
}

// Smallest distance in CIELAB with normal vision and each dichromacy (Machado, Oliveira and Fernandes 2009).
double seen_apart(Color a, Color b) {
    using Matrix = std::array<std::array<double, 3>, 3>;
    static constexpr std::array<Matrix, 4> kSights{{
        {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
        {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
        {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
        {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}},
    }};
    const auto lab = [](Color c, const Matrix& m) {
        const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
        const double in[] = {linear(c.r), linear(c.g), linear(c.b)};
        double v[3];
        for (std::size_t i = 0; i < 3; ++i)
            v[i] = std::clamp(m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2], 0.0, 1.0);
        const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
        const double x = f((0.4124 * v[0] + 0.3576 * v[1] + 0.1805 * v[2]) / 0.9505),
                     y = f(0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]),
                     z = f((0.0193 * v[0] + 0.1192 * v[1] + 0.9505 * v[2]) / 1.089);
        return std::array{116 * y - 16, 500 * (x - y), 200 * (y - z)};
    };
    double least = 1e300;
    for (const Matrix& m : kSights) {
        const auto p = lab(a, m), q = lab(b, m);
        least = std::min(least, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
    return least;
}

// A distance of ten is clearly visible side by side.
TEST(Colors, EightMotionsAreToldApartByEverybody) {
    for (const Theme theme : {Theme::light, Theme::dark, Theme::print})
        for (std::size_t i = 0; i < 8; ++i)
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_GT(seen_apart(series_color(palette(theme), i), series_color(palette(theme), k)), 15)
                    << i << " and " << k;
}

TEST(Colors, WordsStandOutFromThePaper) {
    for (Theme theme : {Theme::light, Theme::dark, Theme::print}) {
        const Palette& p = palette(theme);
        const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
        const auto light = [&](Color c) {
            return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b) + 0.05;
        };
        for (double share : {0.0, 0.2, 0.45, 0.7, 1.0}) {
            const Color words = readable(p, mix(p.paper, p.motion, share));
            EXPECT_GE(std::max(light(words), light(p.paper)) / std::min(light(words), light(p.paper)), 2.999) << share;
        }
        EXPECT_EQ(readable(p, p.ink).r, p.ink.r);
        EXPECT_EQ(readable(p, p.contact).r, p.contact.r);  // strong enough as it is
    }
}

TEST(Labels, SpeedsAreToldAsFractions) {
    EXPECT_EQ(speed_text(1, true), "");
    EXPECT_EQ(speed_text(0.02, true), "1/50 speed");
    EXPECT_EQ(speed_text(0.004 * (1 + 1e-9), true), "1/250 speed");  // rounding is no other speed
    EXPECT_EQ(speed_text(0.5, true), "1/2 speed");
    EXPECT_EQ(speed_text(0.037, false), "1/20 speed");  // on the way from one speed to another
    EXPECT_EQ(speed_text(0.97, false), "");
    EXPECT_TRUE(steady_speed({0.037, 0, 0.037}));
    EXPECT_FALSE(steady_speed({0.037, 0.04}));
    EXPECT_EQ(speed_text(0.037, true), "0.037× speed");
    EXPECT_EQ(speed_text(0.97, true), "0.97× speed");
    EXPECT_EQ(speed_text(0, true), "frozen");
    EXPECT_EQ(speed_text(4, true), "4× speed");
    EXPECT_EQ(speed_text(600, true), "600× speed");  // no exponents
    EXPECT_EQ(speed_text(6.73e-5, true), "1/14900 speed");
    EXPECT_EQ(speed_text(1.53, true), "1.5× speed");
}

TEST(Labels, UnusualParametersAreStated) {
    const auto has = [](const sim::Problem& problem, const char* text) {
        return std::ranges::any_of(parameter_pieces(problem),
                                   [&](const std::string& piece) { return to_plain(piece) == text; });
    };
    sim::Problem problem;
    const std::size_t usual = parameter_pieces(problem).size();
    problem.beam.damping_ratio = {0};
    EXPECT_EQ(parameter_pieces(problem).size(), usual);
    problem.gravity = 1.62;
    problem.hub.radius = 0.06, problem.hub.inertia = 0.05;
    problem.beam.damping_ratio = {0.01, 0.02};
    EXPECT_EQ(parameter_pieces(problem).size(), usual + 4);
    EXPECT_TRUE(has(problem, "g\u2009=\u20091.62\u00A0m/s²"));
    EXPECT_TRUE(has(problem, "a\u2009=\u200960\u00A0mm"));
    EXPECT_TRUE(has(problem, "I_h\u2009=\u20090.05\u00A0kg\u2009m²"));
    EXPECT_TRUE(has(problem, "ζ\u2009=\u20090.01 … 0.02"));
    problem.beam.damping_ratio.clear(), problem.beam.kelvin_voigt = 5e-4;
    EXPECT_TRUE(has(problem, "η\u2009=\u2009500\u00A0µs"));
}

TEST(Labels, BothCoefficientsOfStickSlipAreTold) {
    sim::Problem problem;
    problem.contact.friction = sim::StickSlipFriction{0.2, 0.35, {}};
    const std::vector<std::string> pieces = parameter_pieces(problem);
    const auto found =
        std::ranges::find_if(pieces, [](const std::string& piece) { return piece.find("0.2") != std::string::npos; });
    ASSERT_NE(found, pieces.end());
    EXPECT_NE(found->find("0.35"), std::string::npos) << *found;
}

TEST(Projection, FromTheFrontThePlaneOfMotionIsTheFlatView) {
    const Projection front = Projection::looking({400, 300}, 2000, 1, 0, 0);
    const Vec2 p = front.to_pixels({120, 50, 0});
    EXPECT_NEAR(p.x, 520, 1e-12);
    EXPECT_NEAR(p.y, 250, 1e-12);
    const Vec2 nearer = front.to_pixels({120, 50, 400});  // at four fifths of the distance
    EXPECT_NEAR(nearer.x, 400 + 150, 1e-9);
    EXPECT_NEAR(nearer.y, 300 - 62.5, 1e-9);
}

TEST(Projection, AxesAreOrthonormal) {
    const Projection p = Projection::looking({}, 1000, 1, 0.7, -0.3);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 &a = p.axes[i], &b = p.axes[j];
            EXPECT_NEAR(a.x * b.x + a.y * b.y + a.z * b.z, i == j ? 1 : 0, 1e-12);
        }
    EXPECT_GT(p.axes[2].x, 0);  // seen from the right
}

}  // namespace
}  // namespace beamcam::render
