// Figures of random scenes: no two texts meet, and none in the ink of the axes lies over a curve.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "render/base/error.hpp"
#include "render/draw/fonts.hpp"
#include "scenes/figures/figure_types.hpp"
#include "tests/scenes/figures/simulated.hpp"

namespace beamcam::scenes {
namespace {

namespace plot = render::figure;

class Dice {
  public:
    explicit Dice(unsigned seed) : random_(seed) {}
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
    bool chance(int of = 2) { return below(of) == 0; }
    double between(double low, double high) { return low + (high - low) * (below(10'000) / 10'000.0); }
    const char* one_of(std::initializer_list<const char*> words) { return words.begin()[below(std::ssize(words))]; }

  private:
    std::mt19937 random_;
};

// A beam from millimetres to metres, with or without a cam, falling, driven or thrown, for half of its swing and more.
std::string mechanics(Dice& dice) {
    const double length = std::pow(10, dice.between(-3, 1));
    std::string text = fmt::format(
        R"("title": "random", "beam": {{"length": {0}, "area": {1}, "second_moment": {2}, "depth": {3}, "modes": {4},
            "damping_ratio": {5}, "model": "{6}"}}, "initial": {{"angle": {7}}}, )",
        length, 7e-5 * length * length, 8e-9 * std::pow(length, 4), 0.04 * length, 1 + dice.below(3),
        dice.chance() ? 0 : 0.01, dice.one_of({"first-order", "first-order", "zeroth-order", "rigid"}),
        dice.between(0.4, 1.4));
    text += dice.chance(8)
                ? R"("cam": null, )"
                : fmt::format(R"("cam": {{"centre": [{}, {}], "radius": {}, "eccentricity": {},
            "phase": {}, "speed": {}}}, "contact": {{"stiffness": 1e7}}, )",
                              dice.between(0.25, 0.6) * length, dice.between(-0.1, 0.05) * length, 0.1 * length,
                              dice.between(0, 0.05) * length, dice.between(0, 6), dice.between(-6, 6));
    if (dice.chance(4)) text += fmt::format(R"("hub": {{"radius": {}, "inertia": 0.01}}, )", 0.1 * length);
    return text + fmt::format(R"("time": {{"end": {}}})", dice.between(0.5, 2.5) * std::sqrt(length));
}

std::string series(Dice& dice) {
    std::string channels;
    for (const char* each :
         {"theta", "contact_force", "tip_deflection", "gap", "theta_dot", "energy_kinetic", "contact_x"})
        if (dice.chance(3)) channels += fmt::format("{}\"{}\"", channels.empty() ? "" : ", ", each);
    std::string text = fmt::format(R"("channels": [{}])", channels.empty() ? "\"theta\"" : channels);
    if (dice.chance(4)) text = R"("panels": [{"channels": ["theta"], "title": "hub $θ$"}])";
    const bool over_time = dice.chance();
    text += fmt::format(R"(, "x": "{}")", over_time ? "t" : dice.one_of({"theta", "turns", "phase", "frequency"}));
    if (over_time && dice.chance()) text += R"(, "impacts": true)";
    if (dice.chance(3))
        text += R"(, "compare": [{"label": "as it is"}, {"label": "rigid", "set": {"beam.model": "rigid"}}])";
    return text;
}

// What is written on the sheet, and the picture.
struct Drawn {
    std::vector<plot::PageCanvas::Written> written;
    render::Image image;
    render::Box page;
    bool has_axes = true;
};
constexpr double kDpi = 144;

Drawn drawn(const Scene& scene, const FigureOutput& how) {
    plot::Figure figure = testing::simulated(scene, how);
    const plot::Page page = plot::page_of(figure, *plot::column_named(how.column));
    const render::Fonts fonts(plot::needs_chinese(figure), render::Typefaces::print);
    const double w = plot::points(page.width), h = plot::points(page.height);
    plot::PageCanvas sheet(render::Medium::png, {w, h, kDpi}, fonts);
    plot::draw(figure, page, sheet);
    return {sheet.written, sheet.image(), {0, 0, w, h}, figure.panels.front().shapes.empty()};
}

// Of the pixels within, how many have the colour of a line, and how many are as dark as letters of the axes.
struct Ink {
    int coloured = 0, dark = 0, all = 0;
};
Ink ink(const render::Image& image, const render::Box& box) {
    constexpr double kScale = kDpi / render::kPointsPerInch;
    constexpr unsigned kPlain = 80, kDark = 110;  // of 255: between the channels of a colour; the lightest channel
    const auto from = [](double edge) { return std::max(0, static_cast<int>(edge * kScale)); };
    Ink out;
    for (int y = from(box.y); y < std::min(image.height, from(box.bottom())); ++y)
        for (int x = from(box.x); x < std::min(image.width, from(box.right())); ++x) {
            const std::uint32_t pixel = image.pixels[static_cast<std::size_t>(y * image.width + x)];
            const auto [low, high] = std::minmax({pixel >> 16 & 255, pixel >> 8 & 255, pixel & 255});
            out.coloured += high - low > kPlain, out.dark += high < kDark, ++out.all;
        }
    return out;
}

void expect_clear(const Drawn& all, const std::string& what) {
    for (std::size_t i = 0; i < all.written.size(); ++i) {
        const auto& one = all.written[i];
        // A box has room for descenders beneath subscripts too.
        EXPECT_TRUE(all.page.contains(one.box, std::max(1.5, 0.2 * one.smallest))) << one.markup << " leaves the page\n"
                                                                                   << what;
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_FALSE(one.box.inset(0.5).overlaps(all.written[k].box.inset(0.5)))
                << one.markup << " over " << all.written[k].markup << '\n'
                << what;
    }
}

// Letters in a line's colour are its own label.
void expect_no_curve_beneath(const Drawn& all, const std::string& what) {
    if (!all.has_axes) return;
    for (const auto& one : all.written) {
        const Ink within = ink(all.image, one.box.inset(0.5));
        if (within.dark < 0.03 * within.all) continue;
        EXPECT_LE(within.coloured, 0.02 * within.all) << one.markup << '\n' << what;
    }
}

void try_scenes(unsigned seed, int count) {
    Dice dice(seed);
    const std::vector<std::string> columns = plot::column_names();
    int made = 0;
    for (int k = 0; k < count; ++k) {
        const char* name = dice.one_of({"series", "series", "series", "schematic", "free-fall", "deflection",
                                        "distance", "collision", "energy", "contact-places", "phase", "kymograph",
                                        "spectrogram", "strobe", "impact-maps", "tip-vibration"});
        const std::string output = std::string(name) == "series" ? ", " + series(dice) : "";
        const std::string& column = columns[static_cast<std::size_t>(k) % columns.size()];
        const std::string text =
            fmt::format(R"({{{}, "outputs": [{{"type": "figure", "figure": "{}", "column": "{}", "lang": "{}"{}}}]}})",
                        mechanics(dice), name, column, dice.chance(5) ? "zh" : "en", output);
        const Reading reading = testing::read(text);
        if (!reading.scene) continue;  // such a scene has no such figure
        try {
            const Drawn all = drawn(*reading.scene, std::get<FigureOutput>(reading.scene->outputs.front()));
            expect_clear(all, text);
            expect_no_curve_beneath(all, text);
            ++made;
        } catch (const render::PictureError&) {  // nothing strikes the cam, or the page has no room
        } catch (const sim::SolverError&) {
        }
    }
    EXPECT_GT(made, count / 2);
}

TEST(RandomScenes, HaveFiguresWhoseTextsKeepClear) {
    SKIP_UNDER_SANITIZERS();
    try_scenes(1, 20);
}

TEST(LongRandomScenes, HaveFiguresWhoseTextsKeepClearInTwoHundred) {
    SKIP_UNDER_SANITIZERS();
    try_scenes(2, 200);
}

}  // namespace
}  // namespace beamcam::scenes
