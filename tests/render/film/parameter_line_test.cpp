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

TEST(ParameterLine, IsSmallerBeforeAnythingIsLeftOut) {
    double size = 24;
    std::size_t shown = kPieces.size();
    bool smaller = false;
    for (double width = 1400; width > 20; width -= 10) {
        const ParameterLine line = line_in(width);
        EXPECT_LE(line.pieces.size(), shown) << width;
        if (line.pieces.size() == kPieces.size()) {
            EXPECT_LE(line.size, size);
            smaller = smaller || line.size < 24;
            size = line.size;
        }
        for (std::size_t i = 0; i < line.pieces.size(); ++i) EXPECT_EQ(line.pieces[i].markup, kPieces[i]);
        shown = line.pieces.size();
    }
    EXPECT_TRUE(smaller);
    EXPECT_EQ(shown, 0U);
}

TEST(ParameterLine, ATitleHasTwoSizesThenTwoLinesThenAnEllipsis) {
    Image image(1, 1);
    const Fonts fonts(true);
    const Canvas canvas(image, fonts);
    const double natural = canvas.measure("A beam falls", title_style({})).w;
    const auto fitted = [&](const std::string& title, double width) {
        const std::vector<FittedText> lines = fitted_title(canvas, title, {0, 0, width, 54}, {});
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
