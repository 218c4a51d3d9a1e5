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

ParameterLine line_in(double width,
                      const std::string& title = "A title that leaves no room for anything beside it at all") {
    Measuring with;
    Layout places;
    places.title = Box{0, 0, width, 54};
    places.parameters = Box{0, 54, width, 36};
    return parameter_line(with.canvas, places, title, kPieces);
}

TEST(ParameterLine, KeepsItsDesignWhereThereIsRoom) {
    const ParameterLine line = line_in(1200);
    EXPECT_EQ(line.size, 21);
    EXPECT_EQ(line.pieces.size(), kPieces.size());
    EXPECT_TRUE(line.omitted.empty());
}

TEST(ParameterLine, RatherLeavesOutThanWritesTooSmall) {
    Measuring with;
    Layout places;
    places.unit = 0.5, places.tick = 11;  // of 960×540
    bool omits = false;
    for (double width = 400; width > 40; width -= 10) {
        places.parameters = Box{0, 0, width, 18};
        const ParameterLine line = parameter_line(with.canvas, places, "", kPieces);
        if (!line.pieces.empty()) {
            EXPECT_GE(line.size, 10) << width;
        }
        omits = omits || !line.omitted.empty();
    }
    EXPECT_TRUE(omits);
}

// At 640×360, where the numbers at axes are as small.
TEST(ParameterLine, HasLettersOfNinePixelsAtLeast) {
    Measuring with;
    Layout places;
    places.unit = 0.5, places.tick = 9;
    for (double width = 400; width > 40; width -= 10) {
        places.parameters = Box{0, 0, width, 18};
        const ParameterLine line = parameter_line(with.canvas, places, "", kPieces);
        if (line.pieces.empty()) continue;
        EXPECT_GE(line.size, 9) << width;
    }
}

TEST(ParameterLine, StandsCloserThenSmallerBeforeAnythingIsLeftOut) {
    double size = 21;
    std::size_t shown = kPieces.size();
    bool smaller = false;
    for (double width = 1200; width > 20; width -= 10) {
        const ParameterLine line = line_in(width);
        EXPECT_LE(line.pieces.size(), shown) << width;
        EXPECT_EQ(line.pieces.size() + line.omitted.size(), kPieces.size());
        if (line.pieces.size() == kPieces.size()) {
            EXPECT_LE(line.size, size);
            smaller = smaller || line.size < 21;
            size = line.size;
        }
        for (std::size_t i = 0; i < line.pieces.size(); ++i) EXPECT_EQ(line.pieces[i].markup, kPieces[i]);
        shown = line.pieces.size();
    }
    EXPECT_TRUE(smaller);
    EXPECT_EQ(shown, 0U);
}

TEST(ParameterLine, TheFirstPiecesStandBesideAShortTitle) {
    const ParameterLine alone = line_in(500), beside = line_in(500, "Fall");
    EXPECT_FALSE(alone.omitted.empty());
    EXPECT_GT(beside.pieces.size(), alone.pieces.size());
    Measuring with;
    const double title = with.canvas.measure("Fall", title_style(1)).w;
    EXPECT_GT(beside.pieces.front().baseline.x, title + 30);
    EXPECT_LT(beside.pieces.front().baseline.y, beside.pieces.back().baseline.y);
    for (std::size_t i = 0; i < beside.pieces.size(); ++i) {
        const ParameterLine::Piece& piece = beside.pieces[i];
        EXPECT_LE(piece.baseline.x + with.canvas.measure(piece.markup, {.size = beside.size}).w, 500);
        if (i > 0) {  // in reading order
            EXPECT_GE(piece.baseline.y, beside.pieces[i - 1].baseline.y);
        }
    }
}

TEST(ParameterLine, WithoutATitleThereAreTwoLinesInTheirOrder) {
    const ParameterLine line = line_in(500, "");
    ASSERT_GT(line.pieces.size(), 2U);
    EXPECT_TRUE(line.omitted.empty());
    EXPECT_EQ(line.pieces.front().baseline.x, 0);
    for (std::size_t i = 1; i < line.pieces.size(); ++i)
        EXPECT_GE(line.pieces[i].baseline.y, line.pieces[i - 1].baseline.y) << i;
    EXPECT_GT(line.pieces.back().baseline.y, line.pieces.front().baseline.y);
}

TEST(ParameterLine, ALongTitleFillsTwoLinesInEveryScript) {
    Image image(1, 1);
    const Fonts fonts(true);
    Canvas canvas(image, fonts);
    const Box box{0, 0, 1100, 54};
    for (const char* title :
         {"Experimental and numerical investigation of the multiple impacts of a flexible beam that falls onto a cam",
          "旋转柔性梁与偏心凸轮之间多次碰撞的实验与数值研究以及考虑接触阻尼和摩擦影响的动力学响应分析及其在不同转速下的"
          "比较与验证"}) {
        const FittedTitle fitted = fitted_title(canvas, title, box, 1);
        ASSERT_EQ(fitted.lines.size(), 2u) << title;
        EXPECT_FALSE(fitted.cut) << title;
        for (const FittedTitle::Line& line : fitted.lines) {
            EXPECT_LE(canvas.measure(line.markup, fitted.style).w, box.w);
            EXPECT_LT(line.baseline.y, box.bottom());
        }
    }
    EXPECT_EQ(fitted_title(canvas, "Fall", box, 1).lines.size(), 1u);
}

// 200 letters in the box of a title at 320×180.
TEST(ParameterLine, AVeryLongTitleOfASmallPictureTakesThreeLinesThatDoNotTouch) {
    Measuring with;
    const std::string title =
        "A very long title that a supervisor insisted upon: experimental and numerical investigation of the multiple "
        "sub-impacts of a flexible Euler–Bernoulli beam falling onto a rotating eccentric cam under gravity";
    const Box box{13, 10, 294, 27};
    const FittedTitle fitted = fitted_title(with.canvas, title, box, 0.5);
    EXPECT_FALSE(fitted.cut);
    ASSERT_EQ(fitted.lines.size(), 3u);
    double lowest = 0;
    for (const FittedTitle::Line& line : fitted.lines) {
        const Box ink = with.canvas.measure(line.markup, fitted.style);
        EXPECT_GT(line.baseline.y + ink.y, lowest);
        lowest = line.baseline.y + ink.bottom();
        EXPECT_LE(ink.w, box.w);
    }
    EXPECT_LE(lowest, box.bottom());
    EXPECT_GE(fitted.style.size, 7);
}

TEST(ParameterLine, WhatFindsNoRoomIsNamedInPlainWords) {
    const sim::Problem problem;
    EXPECT_TRUE(omitted_text(1920, 1080, {}, 1, "Fall", {&problem}).empty());
    const std::vector<std::string> tiny = omitted_text(320, 180, {}, 1, "Fall", {&problem});
    ASSERT_EQ(tiny.size(), kPieces.size() + 1);
    EXPECT_EQ(tiny.front(), "L = 1 m");
    EXPECT_EQ(tiny.back(), "colour scales");
    const std::string essay =
        "A beam falls onto a cam that turns, strikes it, bounces, strikes again and follows it to the end";
    EXPECT_EQ(omitted_text(480, 270, {}, 1, essay, {&problem}).front(), "colour scales");          // on two lines
    EXPECT_EQ(omitted_text(480, 270, {}, 1, essay + essay, {&problem}).front(), "colour scales");  // in small letters
    EXPECT_EQ(omitted_text(480, 270, {}, 1, essay + essay + essay, {&problem}).front(), "colour scales");  // on three
    EXPECT_EQ(omitted_text(480, 270, {}, 1, essay + essay + essay + essay + essay + essay, {&problem}).front(),
              "the end of the title");
    EXPECT_TRUE(omitted_text(1920, 1080, {}, 1, essay, {&problem}).empty());
    EXPECT_EQ(omitted_text(160, 90, {}, 1, "Fall", {&problem}).front(), "the title");
    EXPECT_EQ(tiny[4], "K = 10⁸ N m^−1.5, c_r = 0.7");
}

// Lines break before operators, and end with an ellipsis if truncated; tall formulas do not overlap the line below.
TEST(ParameterLine, TitlesOfFormulasAreBrokenCutAndKeptApart) {
    Measuring with;
    const Box box{0, 0, 600, 54};
    const auto judge = [&](const std::string& title) {
        const FittedTitle fitted = fitted_title(with.canvas, title, box, 1);
        double below = -20;
        for (const FittedTitle::Line& line : fitted.lines) {
            const Box ink = with.canvas.measure(line.markup, fitted.style);
            EXPECT_LE(ink.w, box.w) << title;
            EXPECT_GE(line.baseline.y + ink.y, below) << title;
            below = line.baseline.y + ink.bottom();
        }
        EXPECT_LE(below, box.bottom() + 1.5) << title;
        return fitted;
    };
    std::string sum = "$a", fractions = "$\\frac{a}{b}";
    for (int k = 0; k < 12; ++k) sum += " + b_{k}", fractions += " + \\frac{c}{d}";
    EXPECT_EQ(judge(sum + " = \\frac{\\frac{a}{b}}{\\sqrt{\\frac{c}{d}}}$").lines.size(), 2u);
    judge("$\\frac{\\frac{a}{b}}{\\sqrt{\\frac{c}{d}}}$");
    judge(fractions + "$");
    for (int k = 0; k < 100; ++k) sum += " + b_{k}";
    const FittedTitle cut = judge(sum + "$");
    EXPECT_TRUE(cut.cut);
    EXPECT_TRUE(cut.lines.back().markup.ends_with("…"));
}

}  // namespace
}  // namespace beamcam::render
