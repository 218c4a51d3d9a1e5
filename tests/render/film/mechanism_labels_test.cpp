// The letters of the mechanism and its names have fixed places.
#include "render/film/mechanism_labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/film/force_curve.hpp"
#include "render/film/mechanism_legend.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

// A film of the mechanism and the clock.
FilmSetup bare(FilmSetup setup) {
    setup.layout = LayoutNode{};
    setup.view.style = Style::flat;
    setup.view.show = Show::paper;
    setup.impacts.clear();
    return setup;
}

// The letters and the text of the scale bar.
std::vector<Box> letters(const FrameGeometry& frame) {
    std::vector<Box> out = frame.texts;
    std::erase_if(out, [&](const Box& text) { return !frame.layout.panels.front().box.overlaps(text); });
    return out;
}
std::vector<Box> letters(const FilmSetup& setup, int frame) { return letters(Film(setup).geometry(frame)); }

// A text whose middle is within `far` of the place [px].
bool has_at(const std::vector<Box>& texts, Vec2 place, double far) {
    return std::ranges::any_of(texts, [&](const Box& text) { return norm(text.centre() - place) < far; });
}

TEST(MechanismLabels, ThetaIsOutsideItsArcOnTheBisector) {
    for (const double angle : {1.2, 0.8, -0.9}) {
        const FilmSetup setup = bare(test::led_rod(angle, 0, 0.1));
        const FilmContext context(std::make_shared<const FilmSetup>(setup));
        const MechanismView home(context, *context.places.first(PanelKind::mechanism));
        ASSERT_TRUE(home.arc_radius);
        const double radius = *home.arc_radius + 18 * home.unit;
        const Vec2 hinge = home.px({0, 0});
        EXPECT_TRUE(has_at(letters(setup, 1), hinge + down(angle / 2) * radius, 8)) << angle;
    }
}

// At small angles there is no letter.
TEST(MechanismLabels, ThetaIsNeitherOnTheBeamNorOnTheHorizontal) {
    FilmSetup setup = bare(test::led_rod(0.6, -0.6, 0.9));
    setup.problem.cam.reset();
    Film film(setup);
    int shown = 0, frames = 0;
    for (int k = 0; k < film.frames(); k += 5, ++frames) {
        const FrameGeometry g = film.geometry(k);
        const double reach = 0.3 * g.camera.scale;
        const Vec2 hinge = g.camera.to_pixels({0, 0});
        for (const Box& letter : g.texts) {
            const Vec2 way = letter.centre() - hinge;
            if (norm(way) > reach || way.x < 0) continue;
            const double angle = std::atan2(-way.y, way.x), theta = setup.poses[std::size_t(k)].theta;
            EXPECT_GT(std::abs(theta - angle) * norm(way), (g.beam.high - g.beam.low) / 2 * g.camera.scale) << k;
            EXPECT_GT(std::abs(way.y), letter.h / 3) << k;
            EXPECT_TRUE(angle / theta > 0 && angle / theta < 1) << k;
            ++shown;
        }
    }
    EXPECT_TRUE(shown > 0 && shown < frames) << shown;
}

TEST(MechanismLabels, OmegaIsBesideItsArrowAndNoneIsOnACamAtRest) {
    FilmSetup setup = bare(test::synthetic_film({.duration = 0.1}));
    const std::size_t turning = letters(setup, 2).size();
    setup.problem.cam->speed = 0;
    EXPECT_EQ(letters(setup, 2).size() + 1, turning);
}

// A force whose arrow is shorter than its head has no letter.
TEST(MechanismLabels, TheForceIsBeyondTheTipOfItsArrow) {
    constexpr double kHead = 0.13;  // of the longest arrow
    for (const double zoom : {1.0, 3.0}) {
        FilmSetup setup = bare(test::synthetic_film({.duration = 2}));
        setup.view.shot = {.zoom = zoom, .follow = {zoom > 1 ? Anchor::Kind::contact : Anchor::Kind::all, {}}};
        Film film(setup);
        double largest = 0;
        for (const sim::Pose& pose : setup.poses) largest = std::max(largest, pose.nearest->force);
        int forces = 0;
        for (int k = 0; k < film.frames(); k += 3) {
            const FrameGeometry g = film.geometry(k);
            const sim::Pose& pose = setup.poses[std::size_t(k)];
            if (!(pose.nearest->force > kHead * largest)) continue;
            ++forces;
            const Vec2 foot = g.camera.to_pixels(g.beam.contact->on_disc),
                       n{g.beam.contact->normal.x, -g.beam.contact->normal.y};
            const double depth = (g.beam.high - g.beam.low) * g.camera.scale;
            EXPECT_TRUE(std::ranges::any_of(g.texts,
                                            [&](const Box& text) {
                                                const Vec2 way = text.centre() - foot;
                                                return dot(way, n) > depth && std::abs(cross(way, n)) < 8;
                                            }))
                << zoom << ", " << k;
        }
        EXPECT_GT(forces, 0);
    }
}

TEST(MechanismLabels, StayWithinTheViewOfANearCamera) {
    FilmSetup setup = bare(test::synthetic_film({.duration = 1}));
    setup.view.shot = {.zoom = 5, .follow = {Anchor::Kind::contact, {}}};
    Film film(setup);
    for (int k = 0; k < film.frames(); k += 3) {
        const FrameGeometry g = film.geometry(k);
        const Box& view = g.layout.first(PanelKind::mechanism)->box;
        for (const Box& text : letters(g)) EXPECT_TRUE(view.contains(text, 0.5)) << k;
    }
}

// The arc of the angle is outside the hub, beyond a cam that leaves no room before it.
TEST(MechanismLabels, TheArcIsBesideTheHubAndTheCam) {
    for (const Style style : {Style::flat, Style::solid})
        for (const double radius : {0.05, 0.1, 0.3})
            for (const double centre : {0.0, 0.1, 0.5}) {
                FilmSetup setup = test::led_rod(0.7, -0.2, 0.1);
                setup.problem.hub.radius = radius;
                setup.view.style = style;
                if (centre == 0) setup.problem.cam.reset();
                if (centre > 0)
                    setup.problem.cam->centre = {radius + centre, 0}, setup.problem.cam->radius = 0.8 * centre;
                const FilmContext context(std::make_shared<const FilmSetup>(setup));
                const MechanismView home(context, *context.places.first(PanelKind::mechanism));
                ASSERT_TRUE(home.arc_radius) << int(style) << ", " << radius << ", " << centre;
                EXPECT_GT(*home.arc_radius, home.hub());
            }
}

// ---- names -------------------------------------------------------------------------------------

TEST(MechanismLegend, NamesAreInOneRowAndCutWhereTheyHaveNoRoom) {
    for (const Comparison how : {Comparison::ghosts, Comparison::panels})
        for (const bool at_length : {false, true})
            for (const auto& [width, height] : {std::pair{1920, 1080}, {640, 360}, {320, 180}}) {
                FilmSetup setup = bare(test::synthetic_film({.duration = 0.1}));
                setup.width = width, setup.height = height, setup.comparison = how;
                setup.label = at_length ? "a cam at rest at its lowest point" : "0";
                for (int i = 1; i < 4; ++i)
                    setup.others.push_back(setup), setup.others.back().label = setup.label + std::to_string(i);
                if (how == Comparison::panels) setup.layout.reset();
                const FilmContext context(std::make_shared<const FilmSetup>(setup));
                const PanelSlot& slot = *context.places.first(PanelKind::mechanism);
                const MechanismView home(context, slot);
                const MechanismLegend legend(home);
                Image image(width, height);
                Canvas canvas(image, *context.fonts);
                std::vector<Box> texts;
                canvas.record = &texts;
                legend.draw(canvas, home);
                std::erase_if(texts, [&](const Box& text) { return text.y > slot.box.centre().y; });  // the scale bar
                EXPECT_EQ(texts.size(), how == Comparison::ghosts ? 4U : 1U) << width;
                EXPECT_LE(legend.cuts_names(), at_length) << width;
                EXPECT_GE(legend.cuts_names(), at_length && width == 320) << width;
                EXPECT_EQ(Film(setup).cut_texts().size(), legend.cuts_names() ? 1U : 0U) << width;
                for (std::size_t i = 0; i < texts.size(); ++i) {
                    EXPECT_TRUE(slot.box.contains(texts[i], 1)) << width;
                    EXPECT_TRUE(i == 0 || texts[i].x > texts[i - 1].right()) << width;
                }
            }
}

// ---- peaks -------------------------------------------------------------------------------------

sim::Impact brief_impact(double start, double force, int collision = 0) {
    sim::Impact impact;
    impact.t_start = start, impact.t_end = start + 1e-3, impact.force_peak = force, impact.collision = collision;
    return impact;
}

void without_rows(FilmSetup& setup) {
    for (sim::Table* table : {&setup.chart, &setup.trace})
        for (auto& column : table->values) column.clear();
}

TEST(Peaks, AreTheLargestForcesOfAPart) {
    FilmSetup setup = test::flat_film({.duration = 2}, 640, 360);
    setup.impacts = {brief_impact(0.3, 100), brief_impact(0.34, 20), brief_impact(1.6, 50, 1)};
    without_rows(setup);
    setup.trace.values.assign(setup.trace.values.size(), {0, 0});
    setup.trace.values[0] = {0, 2};
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    const Peaks peaks(context, {0, 2});
    EXPECT_TRUE(std::isnan(peaks.of(0, {0, 0.28}).y));
    EXPECT_EQ(peaks.of(0, {0, 0.32}).y, 100);
    EXPECT_NEAR(peaks.of(0, {0, 0.32}).x, 0.3005, 1e-9);
    EXPECT_EQ(peaks.of(0, {0, 1.7}).y, 100);
    EXPECT_EQ(peaks.of(0, {1.6, 1.7}).y, 50);
    EXPECT_EQ(Peaks(context, {1, 2}).of(0, {0, 1.7}).y, 50);
}

// While a contact lasts, its peak is the largest force so far.
TEST(Peaks, OfAContactThatLastsGrow) {
    FilmSetup setup = test::flat_film({.duration = 1}, 640, 360);
    setup.impacts = {brief_impact(0.3, 100)};
    setup.impacts[0].t_end = 0.6;
    without_rows(setup);
    for (int i = 0; i <= 30; ++i) {
        const double t = 0.3 + 0.01 * i;
        for (auto& column : setup.trace.values) column.push_back(0.1);
        setup.trace.values[0].back() = t,
        setup.trace.values[3].back() = 100 * std::sin(std::numbers::pi * (t - 0.3) / 0.3);
    }
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    const Peaks peaks(context, {0, 1});
    EXPECT_NEAR(peaks.of(0, {0, 0.4}).y, 50 * std::sqrt(3), 3);
    EXPECT_NEAR(peaks.of(0, {0, 0.55}).y, 100, 1);
    EXPECT_EQ(peaks.of(0, {0, 2.0 / 3}).y, 100);
}

}  // namespace
}  // namespace beamcam::render
