// Charts of channels against time: past and future, windows, collisions, readings.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "render/film/strip_content.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

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
                const std::uint32_t p = pixel_at(image, x, y);
                if (difference(p, faint) < 0.03) return (plot.bottom() - y) / plot.h;
            }
        return 0.0;
    };
    // The axis ends at 102, rounded up to 120 or 150.
    EXPECT_GT(highest(1), 0.6);
    EXPECT_GT(highest(0.5), 0.6);
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
            const std::uint32_t p = pixel_at(image, x, y);
            if (difference(p, past) < 0.35) return (plot.bottom() - y) / plot.h;
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
    EXPECT_NEAR(reading_width(0.6), reading_width(9), 2);
    EXPECT_GT(reading_width(0.4), reading_width(9));       // "<1 N": it is not zero
    EXPECT_GT(reading_width(90), 1.1 * reading_width(9));  // another digit
}

// Several forces have readings of zero, as one force alone has.
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

// Before the first collision there is nothing to show.
TEST(CollisionStrip, BeginsWithTheFirstTouch) {
    FilmSetup setup = test::flat_film({.duration = 1}, 1280, 720);
    sim::Impact impact;
    impact.t_start = 0.3, impact.t_end = 0.32;
    setup.impacts = {impact};
    PanelSpec by_collision = strip(ChannelKind::contact_force);
    by_collision.by_collision = true;
    setup.layout = leaf(by_collision);
    Film film(std::move(setup));
    for (const int frame : {0, 17}) EXPECT_FALSE(has_reading(film.geometry(frame))) << frame;
    for (const int frame : {18, 59}) EXPECT_TRUE(has_reading(film.geometry(frame))) << frame;
}

// Compared motions have their touches at one place, and each a row up to its own time; nothing without a touch.
TEST(CollisionStrip, EachMotionHasItsOwnTouch) {
    PanelSpec by_collision = strip(ChannelKind::contact_force);
    by_collision.by_collision = true;
    FilmSetup setup = struck(by_collision, {0.0502, 0.071});
    Motion later = setup;
    for (double& t : later.chart.values[0]) t += 0.02;
    later.impacts[0].t_start += 0.02, *later.impacts[0].t_end += 0.02;
    setup.label = "a", later.label = "b";
    setup.others = {later};
    FilmSetup untouched = setup;
    untouched.others[0].impacts.clear();
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    Film both(std::move(setup)), one(std::move(untouched));
    const FrameGeometry g = both.geometry(0);
    const Box plot = plot_area(g.layout.first(PanelKind::strip)->box, g.layout.unit, g.layout.letters.words);
    const auto columns = [&](int frame, int member, bool touched = true) {  // of the curve's colour
        const Image image = drawn(touched ? both : one, frame);
        const double gap = g.layout.letters.words,
                     bottom = plot.bottom() - (1 - member) * (plot.h + gap) / 2;  // of its row
        std::vector<int> found;
        for (int x = int(plot.x); x < int(plot.right()); ++x)
            for (int y = int(bottom - 0.4 * plot.h); y < int(bottom - 0.06 * plot.h); ++y)
                if (difference(pixel_at(image, x, y), context.member_color(member)) < 0.1) {
                    found.push_back(x);
                    break;
                }
        return found;
    };
    ASSERT_FALSE(columns(1, 0).empty());
    ASSERT_FALSE(columns(1, 1).empty());
    EXPECT_NEAR(columns(1, 0).front(), columns(1, 1).front(), 2);
    EXPECT_NEAR(columns(1, 0).back(), columns(1, 1).back(), 2);
    EXPECT_LT(columns(0, 0).back(), columns(1, 0).back() - 50);
    EXPECT_TRUE(columns(0, 1).empty());
    EXPECT_FALSE(columns(1, 0, false).empty());
    EXPECT_TRUE(columns(1, 1, false).empty());
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

TEST(Strips, ManyPeriodsOfADeflectionAreShownInAWindow) {
    const auto window = [](double frequency) -> std::optional<double> {
        FilmSetup setup = test::flat_film({.duration = 1}, 960, 540);
        setup.problem.cam.reset(), setup.layout.reset(), setup.trace = {}, setup.impacts.clear();
        for (sim::Pose& pose : setup.poses) pose.nearest.reset();
        setup.chart.channels.push_back({ChannelKind::tip_deflection, 0});
        std::vector<double>& v = setup.chart.values.emplace_back();
        for (const double t : setup.chart.values[0]) v.push_back(std::sin(6.2832 * frequency * t));
        for (const PanelSlot& slot : Film(std::move(setup)).geometry(0).layout.panels)
            if (slot.spec == strip(ChannelKind::theta))
                EXPECT_FALSE(slot.spec.window);
            else if (slot.spec.kind == PanelKind::strip)
                return slot.spec.window;
        return -1;
    };
    EXPECT_EQ(window(20), std::nullopt);
    EXPECT_NEAR(window(50).value_or(0), 8 / 50.0, 0.01);
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

}  // namespace
}  // namespace beamcam::render
