#include "render/film/parameter_line.hpp"

#include <gtest/gtest.h>

#include "render/plot/labels.hpp"

namespace beamcam::render {
namespace {

struct Measuring {
    Image image{1, 1};
    Fonts fonts;
    Canvas canvas{image, fonts};
};

const std::vector<std::string> kPieces = parameter_pieces(sim::Problem{});

ParameterLine line_in(double width) {
    Measuring with;
    Layout places;
    places.parameters = Box{0, 54, width, 36};
    return parameter_line(with.canvas, places, kPieces);
}

TEST(ParameterLine, KeepsItsDesignWhereThereIsRoom) {
    const ParameterLine line = line_in(1400);
    EXPECT_EQ(line.size, 24);
    EXPECT_EQ(line.pieces.size(), kPieces.size());
}

TEST(ParameterLine, RatherLeavesOutThanWritesTooSmall) {
    Measuring with;
    Layout places;
    places.unit = 0.5, places.letters.words = 11;  // of 960×540
    bool omits = false;
    for (double width = 400; width > 40; width -= 10) {
        places.parameters = Box{0, 0, width, 18};
        const ParameterLine line = parameter_line(with.canvas, places, kPieces);
        if (!line.pieces.empty()) {
            EXPECT_GE(line.size, 9) << width;
        }
        omits = omits || line.pieces.size() < kPieces.size();
    }
    EXPECT_TRUE(omits);
}

TEST(ParameterLine, FillsTheLinesOfItsBoxBeforeAnythingIsLeftOut) {
    const auto shown = [](double width, double height) {
        Measuring with;
        Layout places;
        places.parameters = Box{0, 54, width, height};
        const ParameterLine line = parameter_line(with.canvas, places, kPieces);
        for (std::size_t i = 0; i < line.pieces.size(); ++i) EXPECT_EQ(line.pieces[i].markup, kPieces[i]);
        return line.pieces.size();
    };
    EXPECT_LT(shown(700, 36), kPieces.size());
    EXPECT_EQ(shown(700, 72), kPieces.size());
    EXPECT_EQ(shown(20, 72), 0U);
}

TEST(ParameterLine, ATitleHasTwoSizesThenTwoLinesThenAnEllipsis) {
    Image image(1, 1);
    const Fonts fonts(true);
    const Canvas canvas(image, fonts);
    const double natural = canvas.measure("A beam falls", title_style({})).w;
    const auto fitted = [&](const std::string& title, double width) {
        const std::vector<FittedText> lines = fitted_lines(canvas, title, title_style({}), 35, 30, width);
        for (const FittedText& line : lines)
            EXPECT_LE(canvas.measure(line.markup, {.size = line.size, .weight = Weight::semibold}).w, width) << title;
        return lines;
    };
    const auto whole = fitted("A beam falls", natural + 1), smaller = fitted("A beam falls", 0.8 * natural),
               two = fitted("A beam falls", 0.5 * natural), cut = fitted("A beam falls", 0.25 * natural);
    EXPECT_EQ(whole.front().size, title_style({}).size);
    EXPECT_LT(smaller.front().size, whole.front().size);
    EXPECT_EQ(smaller.front().markup, "A beam falls");
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].markup, "A beam");
    EXPECT_EQ(two[1].markup, "falls");
    EXPECT_LT(two[1].size, smaller.front().size);
    EXPECT_TRUE(cut.back().cut && cut.back().markup.ends_with("…")) << cut.back().markup;
    for (const char* title :
         {"旋转柔性梁与偏心凸轮之间多次碰撞的实验与数值研究", "sums $a + b + c$ of $\\frac{a}{b}$ and more and more"})
        EXPECT_TRUE(fitted(title, 200).back().cut) << title;
    EXPECT_EQ(fitted("$a + b + c + d + e + f$", 40).front().markup, "…");  // no part of a formula
}

}  // namespace
}  // namespace beamcam::render
