#include "render/film/film.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <vector>

#include "render/base/error.hpp"
#include "render/draw/canvas.hpp"
#include "render/film/panel.hpp"
#include "render/mechanism/mechanism.hpp"
#include "render/mechanism/trace.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

// Sets an environment variable during a test.
class Variable {
  public:
    Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
    ~Variable() { unsetenv(name_); }

  private:
    const char* name_;
};

FilmSetup small_film(Style style, test::Synthetic how = {.duration = 0.8}) {
    FilmSetup setup = test::synthetic_film(how);
    setup.width = 960, setup.height = 540;
    setup.view.style = style;
    return setup;
}

void same_pixels_in_any_order(Style style) {
    Film film(small_film(style));
    const int frames[] = {0, 5, 18, 30, 47};
    std::vector<Image> forward;
    for (int k : frames) forward.push_back(drawn(film, k));
    for (int i = 4; i >= 0; --i) EXPECT_EQ(drawn(film, frames[i]), forward[std::size_t(i)]) << frames[i];
    Film fresh = film.for_thread();
    EXPECT_EQ(drawn(fresh, 30), forward[3]);
    EXPECT_NE(forward[0], forward[1]);
}

TEST(Film, SamePixelsInAnyOrder) { same_pixels_in_any_order(Style::flat); }
TEST(LitFilm, SamePixelsInAnyOrder) {
    SKIP_WITHOUT_GL();
    same_pixels_in_any_order(Style::lit);
}

void same_pixels_on_threads(Style style) {
    Film film(small_film(style));
    std::vector<Image> one(12), two(12);
    for (int k = 0; k < 12; ++k) film.draw(k * 4, one[std::size_t(k)]);
    const auto half = [&](int start) {
        Film own = film.for_thread();
        for (int k = start; k < 12; k += 2) own.draw(k * 4, two[std::size_t(k)]);
    };
    std::thread other(half, 1);
    half(0);
    other.join();
    for (std::size_t k = 0; k < 12; ++k) EXPECT_EQ(one[k], two[k]) << k;
}
TEST(Film, SamePixelsOnThreads) { same_pixels_on_threads(Style::flat); }
TEST(LitFilm, SamePixelsOnThreads) {
    SKIP_WITHOUT_GL();
    same_pixels_on_threads(Style::lit);
}

// At the instant of a touch the gap, and with it the force, is zero but for rounding.
TEST(Film, ForcesBelowABillionthOfTheLargestAreNotShown) {
    FilmSetup setup = small_film(Style::flat);
    std::size_t touching = 0;
    while (!setup.poses[touching].nearest->touching) ++touching;
    setup.poses[touching].nearest->force = 2.4e-16;
    setup.poses[touching].nearest->friction = 1e-16;
    const FilmContext context(std::make_shared<const FilmSetup>(std::move(setup)));
    ASSERT_GT(context.scales.largest_force, 0);
    const sim::Pose pose = context.pose(0, static_cast<int>(touching));
    EXPECT_EQ(pose.nearest->force, 0);
    EXPECT_EQ(pose.nearest->friction, 0);
}

TEST(Film, EveryPixelIsOpaque) {
    Film film(small_film(Style::flat));
    for (std::uint32_t p : drawn(film, 20).pixels) ASSERT_EQ(p >> 24, 255U);
}

TEST(Film, FlatViewLoadsNoOpenGl) {
    const auto loaded = [](const char* library) { return dlopen(library, RTLD_NOW | RTLD_NOLOAD) != nullptr; };
    const bool osmesa = loaded("libOSMesa.so.8"), egl = loaded("libEGL.so.1");
    const Variable nowhere("BEAMCAM_MODULE_DIR", "/nonexistent");
    Film film(small_film(Style::flat));
    drawn(film, 3);
    EXPECT_EQ(loaded("libOSMesa.so.8"), osmesa);
    EXPECT_EQ(loaded("libEGL.so.1"), egl);
}

TEST(Film, MissingLitRendererNamesThePackageAndTheFlatView) {
    const Variable nowhere("BEAMCAM_MODULE_DIR", "/nonexistent");
    Film film(small_film(Style::lit));
    try {
        drawn(film, 0);
        FAIL() << "no error";
    } catch (const GlError& e) {
        EXPECT_NE(std::string(e.what()).find("libosmesa6"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("flat"), std::string::npos) << e.what();
    }
}

TEST(Film, MissingFontNamesThePackage) {
    const Variable nowhere("BEAMCAM_FONT_DIR", "/nonexistent");
    try {
        Film film(small_film(Style::flat));
        FAIL() << "no error";
    } catch (const FontError& e) {
        EXPECT_NE(std::string(e.what()).find("fonts-inter"), std::string::npos) << e.what();
    }
}

TEST(Film, ImpossibleRequestsAreRefusedInWords) {
    FilmSetup empty = small_film(Style::flat);
    empty.poses.clear();
    EXPECT_THROW(Film{std::move(empty)}, PictureError);
    for (int width : {0, -3, 100000}) {
        FilmSetup odd = small_film(Style::flat);
        odd.width = width;
        EXPECT_THROW(Film{std::move(odd)}, PictureError) << width;
    }
    FilmSetup less = small_film(Style::flat);
    less.view.exaggeration = 0.5;
    EXPECT_THROW(Film{std::move(less)}, PictureError);
}

TEST(Film, BeamStaysInTheMechanismsBoxAtEveryFrame) {
    Film film(small_film(Style::flat, {.duration = 0.5}));
    for (int k = 0; k < film.frames(); ++k) {
        const FrameGeometry g = film.geometry(k);
        for (std::size_t i = 0; i < g.beam.line.size(); ++i)
            for (Vec2 p : {g.beam.face(i), g.beam.back(i)}) {
                const Vec2 px = g.camera.to_pixels(p);
                EXPECT_TRUE(g.layout.first(PanelKind::mechanism)->box.contains({px.x, px.y, 0, 0})) << k;
            }
    }
}

TEST(Film, DrawnGapOfATouchingContactIsBelowHalfAPixel) {
    FilmSetup setup = small_film(Style::flat, {.duration = 2});
    setup.width = 1920, setup.height = 1080;
    const auto poses = setup.poses;
    Film film(std::move(setup));
    int touching = 0;
    for (int k = 0; k < film.frames(); ++k) {
        const auto& nearest = *poses[std::size_t(k)].nearest;
        if (!nearest.touching) continue;
        ++touching;
        const FrameGeometry g = film.geometry(k);
        EXPECT_LT(std::abs(g.beam.contact->gap - nearest.gap) * g.camera.scale, 0.5) << k;
    }
    EXPECT_GT(touching, 10);
}

TEST(Film, ScaleOfTheMechanismDoesNotChangeItsPlaceInThePicture) {
    Film one(small_film(Style::flat, {.duration = 0.5}));
    for (double size : {1e-3, 100.0}) {
        Film other(small_film(Style::flat, {.duration = 0.5, .size = size}));
        const FrameGeometry a = one.geometry(20), b = other.geometry(20);
        EXPECT_NEAR(b.camera.scale * size / a.camera.scale, 1, 1e-3) << size;
        EXPECT_EQ(one.exaggeration(), other.exaggeration());
    }
}

TEST(Film, WithoutACamThereIsNothingOfIt) {
    Film film(small_film(Style::flat, {.duration = 0.5, .cam = false}));
    const FrameGeometry g = film.geometry(10);
    EXPECT_FALSE(g.beam.contact);
    EXPECT_EQ(g.layout.panels.size(), 2U);
}

TEST(Film, OddAndTinySizesAreDrawn) {
    for (auto [w, h] : {std::pair{321, 241}, {1, 1}, {2, 500}, {500, 2}, {64, 48}, {17, 1001}}) {
        FilmSetup setup = small_film(Style::flat, {.duration = 0.4});
        setup.width = w, setup.height = h;
        Film film(std::move(setup));
        const Image image = drawn(film, 20);
        EXPECT_EQ(image.width, w);
        EXPECT_EQ(image.height, h);
    }
}

TEST(Mechanism, MarkOfTheDiscStandsAtTheCamAngle) {
    const FilmSetup film = test::synthetic_film();
    MechanismLook look;
    look.camera = {500, {100, 400}};
    look.depth = beam_depth(film.problem.beam);
    for (int k : {0, 13, 77}) {
        const sim::Pose& pose = film.poses[std::size_t(k)];
        const DrawnBeam beam = drawn_beam(film.problem, pose, 1, look.depth);
        const DiscShape disc = *mechanism_shape(film.problem, pose, beam, look, palette(Theme::light)).disc;
        const Vec2 ray = disc.mark - disc.centre;
        EXPECT_NEAR(std::remainder(std::atan2(-ray.y, ray.x) - pose.cam_angle, 2 * M_PI), 0, 1e-12);
        EXPECT_LT(norm(ray) + disc.mark_radius, disc.radius);
        EXPECT_LT(norm(disc.axis - disc.centre) + disc.bore, disc.radius);
    }
}

// The section is placed beside the radius along which it leaves the hub, without a wedge between them.
TEST(Mechanism, TheBeamsRootIsWithinItsHub) {
    for (const double radius : {0.0, 0.03, 0.1, 0.3}) {
        FilmSetup film = test::synthetic_film({.duration = 0.1, .cam = false});
        film.problem.hub.radius = radius;
        MechanismLook look;
        look.camera = {900, {100, 400}};
        look.depth = beam_depth(film.problem.beam);
        sim::Pose pose = film.poses.front();
        for (Vec2& p : pose.centreline) p = p + sim::unit(pose.theta) * radius;
        const DrawnBeam beam = drawn_beam(film.problem, pose, 1, look.depth);
        const MechanismShape shape = mechanism_shape(film.problem, pose, beam, look, palette(Theme::light));
        ASSERT_EQ(shape.face.size(), shape.back.size());
        ASSERT_EQ(shape.face.size(), shape.colors.size());
        for (Vec2 corner : {shape.face.front(), shape.back.front()})
            EXPECT_LT(norm(corner - shape.hinge), shape.hub) << radius;
        EXPECT_NEAR(norm(shape.face.back() - look.camera.to_pixels(beam.face(beam.line.size() - 1))), 0, 1e-9);
    }
}

// In small pictures hub and support are in proportion to the beam, down to a readable minimum.
TEST(Mechanism, HubAndSupportShrinkWithTheBeam) {
    const sim::Problem problem;
    EXPECT_EQ(mark_unit(problem, {900, {}}, 1), 1);
    EXPECT_EQ(mark_unit(problem, {1800, {}}, 2), 2);
    EXPECT_DOUBLE_EQ(mark_unit(problem, {250, {}}, 0.5), 250.0 / 640);
    EXPECT_DOUBLE_EQ(mark_unit(problem, {10, {}}, 0.5), 0.25);
    FilmSetup setup = small_film(Style::flat, {.duration = 0.5});
    setup.width = 320, setup.height = 180;
    const sim::Problem filmed = setup.problem;
    Film film(std::move(setup));
    const FrameGeometry g = film.geometry(0);
    const double hub = hub_radius(filmed, g.camera, g.layout.unit);
    EXPECT_GE(hub, 4.5);
    EXPECT_LE(hub, 6);
    EXPECT_LT(support_reach(hub, mark_unit(filmed, g.camera, g.layout.unit)), 0.25 * g.camera.scale);
}

// The centre of the drawn section has the colour of the moment; a point outside the face has not.
TEST(Film, FlatBeamIsDrawnWhereItsGeometrySays) {
    FilmSetup setup = small_film(Style::flat);
    const Palette& p = palette(setup.view.theme);
    Film film(std::move(setup));
    const Image image = drawn(film, 0);
    const FrameGeometry g = film.geometry(0);
    const std::size_t i = 70;
    const auto at = [&](Vec2 world) {
        const Vec2 px = g.camera.to_pixels(world);
        return image.pixels[std::size_t(px.y) * std::size_t(image.width) + std::size_t(px.x)];
    };
    const std::uint32_t paper = 0xFF000000U | std::uint32_t(std::lround(p.paper.r * 255)) << 16 |
                                std::uint32_t(std::lround(p.paper.g * 255)) << 8 |
                                std::uint32_t(std::lround(p.paper.b * 255));
    EXPECT_NE(at((g.beam.face(i) + g.beam.back(i)) * 0.5), paper);
    const Vec2 away = g.beam.face(i) - g.beam.back(i);
    EXPECT_EQ(at(g.beam.face(i) + away * (3 / g.camera.scale / norm(away))), paper);
}

TEST(LitFilm, LitBeamIsDrawnWhereItsGeometrySays) {
    SKIP_WITHOUT_GL();
    Film film(small_film(Style::lit));
    const Image lit = drawn(film, 0);
    Film flat_film(small_film(Style::flat));
    const Image flat = drawn(flat_film, 0);
    const FrameGeometry g = film.geometry(0);
    for (std::size_t i : {20U, 60U, 90U}) {
        const Vec2 px = g.camera.to_pixels((g.beam.face(i) + g.beam.back(i)) * 0.5);
        const std::size_t k = std::size_t(px.y) * std::size_t(lit.width) + std::size_t(px.x);
        EXPECT_NE(lit.pixels[k], lit.pixels[0]);
        // Not mirrored, not shifted: both styles show metal here; colours differ by light only.
        for (int shift : {0, 8, 16})
            EXPECT_LT(std::abs(int((lit.pixels[k] >> shift) & 255) - int((flat.pixels[k] >> shift) & 255)), 70) << i;
    }
}

TEST(LitFilm, AMechanismThatStandsStillIsDrawnOnceInEveryStyle) {
    SKIP_WITHOUT_GL();
    for (const Style style : {Style::lit, Style::solid}) {
        FilmSetup setup = small_film(style, {.duration = 0.2});
        for (sim::Pose& pose : setup.poses) pose = setup.poses.front();
        setup.callouts = {{3, 8, "a text that comes and goes", 0}};
        Film film(std::move(setup));
        for (int k = 0; k < film.frames(); ++k) drawn(film, k);
        EXPECT_EQ(film.counts().bodies_drawn, 1) << int(style);
        EXPECT_EQ(film.counts().gl_contexts, 1) << int(style);
    }
}

// The mark of the axis C is in the bore of the disc; without paper it needs a ground of its own.
TEST(LitFilm, TheBoreOfATransparentDiscIsFilled) {
    SKIP_WITHOUT_GL();
    FilmSetup setup = test::synthetic_film({.duration = 0.1});
    setup.width = 1280, setup.height = 720;
    setup.view.transparent = true;
    Film film(setup);
    const Vec2 axis = film.geometry(0).camera.to_pixels(setup.pose(0).cam_centre);
    const Image image = drawn(film, 0);
    for (const Vec2 off : {Vec2{-4, -4}, {3, 3}}) {
        const auto x = static_cast<std::size_t>(axis.x + off.x), y = static_cast<std::size_t>(axis.y + off.y);
        EXPECT_EQ(image.pixels[y * 1280 + x] >> 24, 255U) << off.x;
    }
}

TEST(Trace, KeepsTheLargestForceOfEachPlace) {
    const std::vector<TraceSample> samples{{0, 0.5, 0.1, 3}, {1, 0.5, 0.1, 2}, {2, 0.9, 6.2, 7}, {3, 0.5, 0.1, 5}};
    const Trace early = trace_until(samples, 1.5, 2 * M_PI, 100, 1, 10),
                whole = trace_until(samples, 3, 2 * M_PI, 100, 1, 10);
    EXPECT_EQ(early.beam[5], 3);
    EXPECT_EQ(early.rim[1], 3);
    EXPECT_EQ(early.rim[98], 0);
    EXPECT_EQ(early.beam[9], 0);
    EXPECT_EQ(whole.beam[5], 5);
    EXPECT_EQ(whole.rim[98], 7);
}

TEST(Trace, RowsWithoutContactAreNoSamples) {
    using K = sim::ChannelKind;
    const sim::Table table{{{K::t, 0}, {K::contact_x, 0}, {K::contact_s, 0}, {K::contact_force, 0}},
                           {{0, 1, 2}, {0.1, 0.2, std::nan("")}, {1, 1, 1}, {0, 4, 4}}};
    const auto samples = contact_samples(table, {});
    ASSERT_EQ(samples.size(), 1U);
    EXPECT_EQ(samples[0].x, 0.2);
}

TEST(Fonts, ChineseIsRecognized) {
    EXPECT_FALSE(needs_cjk("Flexible beam θ, ω · 10⁻³ – “quoted”"));
    for (const char* words : {"柔性梁", "t = 1 s（慢）", "かむ", "캠", "𠮷"}) EXPECT_TRUE(needs_cjk(words)) << words;
    for (const char* words : {"\U0001F680", "\U0001F44D\uFE0F", "\U0001D703", "\xF0\x9F", ""})
        EXPECT_FALSE(needs_cjk(words)) << words;
}

// System settings that would replace every font do not change pixels.
TEST(Fonts, SystemSettingsDoNotInfluencePixels) {
    Film plain(small_film(Style::flat, {.duration = 0.1}));
    const Image expected = drawn(plain, 2);
    const Variable config("FONTCONFIG_FILE", "/nonexistent/fonts.conf");
    Film other(small_film(Style::flat, {.duration = 0.1}));
    EXPECT_EQ(drawn(other, 2), expected);
}

// Pango sorts fonts in its own threads, which may still run when a picture is complete.
TEST(Fonts, ComeAndGoOnManyThreads) {
    constexpr int kThreads = 4, kTimes = 50;
    std::array<Image, kThreads> pictures;
    std::vector<std::jthread> threads;
    for (Image& picture : pictures)
        threads.emplace_back([&picture] {
            for (int k = 0; k < kTimes; ++k) {
                const Fonts fonts;
                picture = Image(80, 24);
                Canvas canvas(picture, fonts);
                canvas.text({2, 20}, "θ = 0.37 rad", {.size = 14});
            }
        });
    threads.clear();
    const Image none(80, 24);
    for (const Image& picture : pictures) {
        EXPECT_NE(picture, none);
        EXPECT_EQ(picture, pictures.front());
    }
}

// ---- vector graphics ---------------------------------------------------------------------------

// A flat frame has no image in it, not even of the past of its charts.
TEST(Films, AFrameAsVectorGraphicsHasImagesOfSolidBodiesAlone) {
    const auto svg = [](Style style) {
        FilmSetup setup = test::flat_film({.duration = 0.3}, 960, 540);
        setup.view.style = style;
        Film film(std::move(setup));
        const Document document{.title = "a & b", .subject = {}, .scene = "{}", .creator = "beamcam"};
        const std::string first = film.draw(10, Medium::svg, document);
        EXPECT_EQ(film.draw(10, Medium::svg, document), first);
        EXPECT_TRUE(film.draw(10, Medium::pdf, document).starts_with("%PDF"));
        EXPECT_NE(first.find("<title>a &amp; b</title>"), std::string::npos);
        return first;
    };
    EXPECT_EQ(svg(Style::flat).find("<image"), std::string::npos);
    EXPECT_NE(svg(Style::lit).find("<image"), std::string::npos);
}

}  // namespace
}  // namespace beamcam::render
