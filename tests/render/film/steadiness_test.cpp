// Jitter, measured in pixels: static parts do not change, changing numbers do not move their neighbours, moving parts
// are drawn at their exact positions, and a touching contact has no gap.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "render/draw/canvas.hpp"
#include "render/film/film.hpp"
#include "render/plot/labels.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"
#include "tests/sanitizers.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

FilmSetup film_of(Style style, const test::Synthetic& how, std::optional<double> factor = {}) {
    FilmSetup setup = test::synthetic_film(how);
    setup.width = 1280, setup.height = 720;
    setup.view.style = style;
    setup.view.exaggeration = factor;
    return setup;
}

std::uint32_t at(const Image& image, Vec2 px) {
    return image.pixels[std::size_t(px.y) * std::size_t(image.width) + std::size_t(px.x)];
}

std::uint32_t opaque(Color c) {
    const auto byte = [](double v) { return std::uint32_t(std::lround(v * 255)); };
    return 0xFF000000U | byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

bool same_within(const Image& a, const Image& b, const Box& box) {
    for (int y = int(box.y); y < int(std::ceil(box.bottom())); ++y)
        for (int x = int(box.x); x < int(std::ceil(box.right())); ++x) {
            const Vec2 px{double(x), double(y)};
            if (x >= 0 && y >= 0 && x < a.width && y < a.height && at(a, px) != at(b, px)) return false;
        }
    return true;
}

// ---- a touching contact ------------------------------------------------------------------------

// No pixel on a line across the contact, from the disc to the beam, shows the paper.
void no_paper_between(Style style, std::optional<double> factor) {
    Film film(film_of(style, {.duration = 2}, factor));
    const std::uint32_t paper = opaque(palette(Theme::light).paper);
    const auto poses = film_of(style, {.duration = 2}).poses;
    int touching = 0;
    for (int k = 0; k < film.frames(); ++k) {
        if (!poses[std::size_t(k)].nearest->touching || (style == Style::lit && k % 3 != 0)) continue;
        ++touching;
        const FrameGeometry g = film.geometry(k);
        const Image image = drawn(film, k);
        const Vec2 from = g.camera.to_pixels(g.beam.contact->on_disc),
                   n{g.beam.contact->normal.x, -g.beam.contact->normal.y};
        for (double out = -5; out <= 5; out += 0.25) EXPECT_NE(at(image, from + n * out), paper) << k << ", " << out;
        EXPECT_LT(std::abs(g.beam.contact->gap) * g.camera.scale, 0.5) << k;
    }
    EXPECT_GT(touching, 5);
}

TEST(Steadiness, ATouchingContactShowsNoPaperBetween) {
    SKIP_UNDER_SANITIZERS();
    no_paper_between(Style::flat, 1);
    no_paper_between(Style::flat, {});
    no_paper_between(Style::flat, 20);
}

TEST(GlSteadiness, ATouchingContactShowsNoPaperBetween) {
    SKIP_WITHOUT_GL();
    no_paper_between(Style::lit, {});
}

// In the lit picture the beam never covers the drawn cam, for any exaggeration.
TEST(GlSteadiness, AnExaggeratedBeamEntersTheLitCamNowhere) {
    SKIP_WITHOUT_GL();
    for (const double factor : {1.0, 20.0}) {
        FilmSetup setup = film_of(Style::lit, {.duration = 2.4, .amplitude = 6e-3}, factor);
        setup.fps = 1e6;        // enough for the colours of the moment
        setup.impacts.clear();  // no rings, no traces, no arrows: only bodies, and the beam in one strong colour
        for (auto& column : setup.trace.values) column.clear();
        for (sim::Pose& pose : setup.poses) {
            pose.nearest->force = 0;
            std::ranges::fill(pose.moment, 1.0);
        }
        const auto poses = setup.poses;
        const double radius = setup.problem.cam->radius;
        Film film(std::move(setup));
        const auto colourful = [](std::uint32_t pixel) {
            const int r = int(pixel >> 16 & 255), g = int(pixel >> 8 & 255), b = int(pixel & 255);
            return std::max({r, g, b}) - std::min({r, g, b}) > 40;
        };
        int touching = 0, coloured = 0;
        for (int k = 0; k < film.frames(); k += 3) {
            const sim::Pose& pose = poses[std::size_t(k)];
            if (pose.nearest->gap > 0.05) continue;
            const FrameGeometry g = film.geometry(k);
            const Image image = drawn(film, k);
            const Vec2 centre = g.camera.to_pixels(pose.disc_centre);
            const double r = radius * g.camera.scale - 1.5;
            for (int y = int(centre.y - r); y <= int(centre.y + r); ++y)
                for (int x = int(centre.x - r); x <= int(centre.x + r); ++x) {
                    const Vec2 px{double(x), double(y)};
                    if (norm(px + Vec2{0.5, 0.5} - centre) > r) continue;
                    ASSERT_FALSE(colourful(at(image, px)))
                        << "frame " << k << " at " << x << ", " << y << ", ×" << factor;
                }
            if (!pose.nearest->touching) continue;
            ++touching;
            const DrawnContact& contact = *g.beam.contact;
            EXPECT_LT(std::abs(contact.gap) * g.camera.scale, 0.5) << k;
            const Vec2 n{contact.normal.x, -contact.normal.y};
            coloured += colourful(at(image, g.camera.to_pixels(contact.on_face) + n * 9));
        }
        EXPECT_GT(touching, 5) << factor;
        EXPECT_EQ(coloured, touching) << factor;
    }
}

// ---- static parts ------------------------------------------------------------------------------

// Title, parameters, colour scale and note have the same pixels in every frame.
void static_parts_stay(FilmSetup setup) {
    setup.speeds.assign(setup.frames(), 0.01);  // slow enough for the colours of moments
    Film film(std::move(setup));
    const Layout places = film.geometry(0).layout;
    const Image first = drawn(film, 0);
    for (int k = 1; k < film.frames(); k += 3) {
        const Image image = drawn(film, k);
        for (const auto& box : {places.title, places.parameters, places.scale, places.warning}) {
            ASSERT_TRUE(box);
            EXPECT_TRUE(same_within(first, image, *box)) << "frame " << k << ", box at " << box->x << ", " << box->y;
        }
        // The axes of values and the starts of headings, left of the plots and above them.
        for (const PanelSlot& slot : places.panels) {
            if (slot.spec.kind != PanelKind::strip) continue;
            const Box plot = plot_area(slot.box, places.unit, places.letters.words);
            EXPECT_TRUE(same_within(first, image, {slot.box.x, slot.box.y, plot.x - 8 - slot.box.x, slot.box.h})) << k;
            EXPECT_TRUE(same_within(first, image, {slot.box.x, slot.box.y, 0.4 * slot.box.w, plot.y - 8 - slot.box.y}))
                << k;
        }
    }
}

TEST(Steadiness, WhatIsStaticHasTheSameBitsInEveryFrame) {
    for (const Theme theme : {Theme::light, Theme::dark, Theme::print}) {
        FilmSetup setup = film_of(Style::flat, {.duration = 1});
        setup.view.theme = theme;
        setup.warning = "energy closes";
        static_parts_stay(std::move(setup));
    }
}

TEST(GlSteadiness, WhatIsStaticHasTheSameBitsInEveryFrame) {
    SKIP_WITHOUT_GL();
    FilmSetup setup = film_of(Style::lit, {.duration = 0.4});
    setup.warning = "energy closes";
    static_parts_stay(std::move(setup));
}

// ---- numbers -----------------------------------------------------------------------------------

TEST(Steadiness, FiguresAreTabular) {
    Image image(16, 16);
    const Fonts fonts(false);
    Canvas canvas(image, fonts);
    for (const Weight weight : {Weight::regular, Weight::medium, Weight::semibold}) {
        const TextStyle style{.size = 30, .weight = weight, .tabular = true};
        const double zero = canvas.measure("00.00", style).w;
        for (const char* number : {"11.11", "47.19", "88.88"}) EXPECT_NEAR(canvas.measure(number, style).w, zero, 0.05);
        EXPECT_NEAR(canvas.measure("\u20071.11", style).w, zero, 0.05);
    }
}

// When the clock changes from 9.9 s to 10.0 s, "t =" and the pill beside it do not move.
TEST(Steadiness, TheClockDoesNotPushItsNeighbours) {
    FilmSetup setup = film_of(Style::flat, {.duration = 0.5}, 5);
    for (sim::Pose& pose : setup.poses) pose.t += 9.8;
    for (double& t : setup.chart.values[0]) t += 9.8;
    Film film(std::move(setup));
    const FrameGeometry g = film.geometry(0);
    Image scratch(16, 16);
    const Fonts fonts(false);
    Canvas canvas(scratch, fonts);
    const TextStyle big{.size = g.layout.letters.title, .weight = Weight::semibold};
    const double head = canvas.measure("$t$\u2009=", big).w, number = canvas.measure("\u200900.000\u00A0s", big).w;
    const Box clock = *g.layout.clock;
    const Image before = drawn(film, 0), after = drawn(film, film.frames() - 1);
    EXPECT_TRUE(same_within(before, after, {clock.x, clock.y, head, clock.h}));
    EXPECT_FALSE(same_within(before, after, {clock.x + head, clock.y, number, clock.h}));
    EXPECT_TRUE(
        same_within(before, after, {clock.x + head + number + 3, clock.y, clock.w - head - number - 3, clock.h}));
}

// ---- moving parts ------------------------------------------------------------------------------

// A horizontal beam displaced by fractions of a pixel: the covered length of pixel rows at its end changes by the same
// amount.
TEST(Steadiness, TheDrawnTipFollowsThePoseWithinATwentiethOfAPixel) {
    FilmSetup setup = film_of(Style::flat, {.duration = 0.5, .cam = false}, 1);
    setup.fps = 1e6;  // enough for the colours of the moment
    const std::size_t n = setup.poses[0].centreline.size();
    for (std::size_t k = 0; k < setup.poses.size(); ++k) {
        sim::Pose& pose = setup.poses[k];
        pose.theta = 0;
        std::ranges::fill(pose.moment, -1.0);  // one strong colour
        const double length = 1 + 0.0004 * std::sin(0.7 * double(k));
        for (std::size_t i = 0; i < n; ++i) pose.centreline[i] = {length * double(i) / double(n - 1), 0};
    }
    const auto poses = setup.poses;
    Film film(std::move(setup));
    const FrameGeometry g = film.geometry(0);
    const std::uint32_t paper = opaque(palette(Theme::light).paper) & 0xFF;
    // Covered length of a row: its darkness relative to that of the section.
    const auto covered = [&](const Image& image) {
        const Vec2 end = g.camera.to_pixels({1, 0});
        const double y = end.y + 5;
        const double inside = double(paper) - double(at(image, {end.x - 20, y}) & 0xFF);
        double sum = 0;
        for (double x = std::floor(end.x) - 20; x < end.x + 20; ++x)
            sum += (double(paper) - double(at(image, {x, y}) & 0xFF)) / inside;
        return sum;
    };
    const double reference = covered(drawn(film, 0)) - g.camera.scale * poses[0].centreline.back().x;
    for (int k = 1; k < film.frames(); ++k) {
        const double drawn_end = covered(drawn(film, k)) - reference;
        EXPECT_NEAR(drawn_end, g.camera.scale * poses[std::size_t(k)].centreline.back().x, 0.05) << k;
    }
}

TEST(Steadiness, TheTipOfTheGeometryIsThePosesAtFactorOne) {
    FilmSetup setup = film_of(Style::flat, {.duration = 1}, 1);
    const auto poses = setup.poses;
    Film film(std::move(setup));
    for (int k = 0; k < film.frames(); k += 7) {
        const FrameGeometry g = film.geometry(k);
        EXPECT_LT(norm(g.beam.line.back() - poses[std::size_t(k)].centreline.back()) * g.camera.scale, 0.05) << k;
    }
}

// ---- the path of the tip -----------------------------------------------------------------------

// A rod that rotates by two radians per frame.
TEST(Steadiness, TheTrailOfAFastTurnIsRound) {
    FilmSetup setup = film_of(Style::flat, {.duration = 1, .fps = 10, .cam = false});
    for (sim::Pose& pose : setup.poses) {
        pose.theta = 20 * pose.t;
        const double last = double(pose.centreline.size() - 1);
        for (std::size_t i = 0; i < pose.centreline.size(); ++i)
            pose.centreline[i] = sim::unit(pose.theta) * (setup.problem.beam.length * double(i) / last);
    }
    Film film(setup);
    const Image image = drawn(film, 6);
    const FrameGeometry g = film.geometry(6);
    const double length = norm((g.beam.face(g.beam.line.size() - 1) + g.beam.back(g.beam.line.size() - 1)) * 0.5);
    for (double part = 0.1; part < 1; part += 0.1)
        EXPECT_NE(at(image, g.camera.to_pixels(sim::unit(20 * 0.5 + 2 * part) * length)),
                  opaque(palette(Theme::light).paper))
            << part;
}

namespace {

sim::Pose turned(sim::Pose pose, const FilmSetup& setup, double t, double angle) {
    const double last = double(pose.centreline.size() - 1);
    pose.t = t, pose.theta = angle;
    for (std::size_t i = 0; i < pose.centreline.size(); ++i)
        pose.centreline[i] = sim::unit(angle) * (setup.problem.beam.length * double(i) / last);
    return pose;
}

std::vector<sim::Pose> poses_at(const FilmSetup& setup, const std::vector<double>& times,
                                const std::function<double(double)>& angle) {
    std::vector<sim::Pose> all;
    for (const double t : times) all.push_back(turned(setup.poses.front(), setup, t, angle(t)));
    return all;
}

std::vector<double> times_between(double from, double to, double rate) {
    std::vector<double> out;
    for (int k = 0; k <= std::lround((to - from) * rate); ++k) out.push_back(from + k / rate);
    return out;
}

// A rod that is led by `angle`, from an instant on.
FilmSetup led_film(double from, double fps, const std::function<double(double)>& angle) {
    FilmSetup setup = film_of(Style::flat, {.duration = 1, .fps = fps, .cam = false});
    const sim::Pose first = setup.poses.front();
    for (sim::Pose& pose : setup.poses) pose = turned(first, setup, from + pose.t, angle(from + pose.t));
    std::vector<double> surveyed = times_between(from, from + 1, 200);
    surveyed.push_back(from + 0.5);  // samples of collisions come last
    setup.survey = poses_at(setup, surveyed, angle);
    return setup;
}

bool is_painted_at_tip(FilmSetup setup, int frame, double angle) {
    Film film(std::move(setup));
    const Image image = drawn(film, frame);
    const FrameGeometry g = film.geometry(frame);
    const double length = norm((g.beam.face(g.beam.line.size() - 1) + g.beam.back(g.beam.line.size() - 1)) * 0.5);
    return at(image, g.camera.to_pixels(sim::unit(angle) * length)) != opaque(palette(Theme::light).paper);
}

}  // namespace

// At each frame the rod is level; between two frames it rises to half a radian.
TEST(Steadiness, TheTrailFollowsThePosesBetweenFrames) {
    const auto angle = [](double t) { return 0.5 * std::pow(std::sin(5 * 3.14159265358979 * t), 2); };
    FilmSetup setup = led_film(0, 5, angle);
    EXPECT_FALSE(is_painted_at_tip(setup, 3, 0.3));
    setup.path = poses_at(setup, times_between(0, 1, 60), angle);
    EXPECT_TRUE(is_painted_at_tip(setup, 3, 0.3));
}

// The trail of the tip does not change while time is frozen.
TEST(Steadiness, AFreezeIsOnePicture) {
    FilmSetup setup = film_of(Style::flat, {.duration = 1});
    setup.impacts.clear();  // no rings that open
    for (std::size_t k = 20; k < 50; ++k) setup.poses[k] = setup.poses[20];
    setup.speeds.assign(setup.poses.size(), 1);
    for (std::size_t k = 21; k < 50; ++k) setup.speeds[k] = 0;
    Film film(std::move(setup));
    const Image early = drawn(film, 21), late = drawn(film, 49);
    EXPECT_EQ(early.pixels, late.pixels);
}

// ---- fading in time of the film ------------------------------------------------------------------

// Three seconds of film of a fall at a tenth of real time, in which the tip visits each place once.
FilmSetup slow_fall(double fps) {
    FilmSetup setup = film_of(Style::flat, {.duration = 0.3});
    setup.fps = fps;
    setup.poses.clear();
    for (int k = 0; k < 3 * fps; ++k) setup.poses.push_back(test::synthetic_pose(setup.problem, {}, 0.1 * k / fps));
    setup.impacts.clear();
    return setup;
}

// Duration of the trail that is visible at 2.5 s, found from pixels along the path [s].
double length_of_trail(double fps) {
    Film film(slow_fall(fps));
    const int now = static_cast<int>(2.5 * fps);
    const Image image = drawn(film, now);
    double longest = 0;
    for (int k = 0; k < now; ++k) {
        const FrameGeometry g = film.geometry(k);
        const Vec2 tip =
            g.camera.to_pixels((g.beam.face(g.beam.line.size() - 1) + g.beam.back(g.beam.line.size() - 1)) * 0.5);
        if (at(image, tip) != opaque(palette(Theme::light).paper)) longest = std::max(longest, (now - k) / fps);
    }
    return longest;
}

TEST(Steadiness, TheTrailIsAsLongAtAnyFrameRate) {
    for (const double fps : {24.0, 30.0, 60.0}) EXPECT_NEAR(length_of_trail(fps), 1.15, 0.06) << fps;
}

TEST(Steadiness, TheRingOfAnImpactLastsAsLongAtAnyFrameRate) {
    for (const double fps : {24.0, 30.0, 60.0}) {
        FilmSetup setup = film_of(Style::flat, {.duration = 0.8, .fps = fps});
        setup.fps = fps;
        setup.layout = LayoutNode{};    // no ticks of impacts
        setup.view.show = Show::clean;  // no peaks beside the clock
        setup.impacts.resize(1);
        setup.impacts[0].t_start = 0.3;
        Film film(setup);
        setup.impacts[0].t_start = 10;
        Film without(setup);
        int shown = 0;
        for (int k = 0; k < film.frames(); ++k) shown += drawn(film, k) != drawn(without, k);
        EXPECT_NEAR(shown / fps, 0.3, 1.5 / fps) << fps;  // the oldest ring is faint
    }
}

}  // namespace
}  // namespace beamcam::render
