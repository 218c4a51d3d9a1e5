// Words and formulas of pictures.
#include "render/plot/user_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/draw/formula.hpp"
#include "render/draw/markup.hpp"
#include "render/plot/lang.hpp"
#include "tests/render/drawing.hpp"

namespace beamcam::render {
namespace {

using ::testing::HasSubstr;

class Words : public ::testing::Test {
  protected:
    Image image_{400, 100};
    const std::unique_ptr<Canvas> owned_ = std::make_unique<Canvas>(image_, fonts());
    Canvas& canvas_ = *owned_;
    const TextStyle style_{.size = 40};
    double width(const std::string& markup) { return canvas_.measure(markup, style_).w; }
};

TEST_F(Words, WithoutDollarsAreWhatTheyAre) {
    for (const char* text : {"a & b <b>", "5 $ a day", "\\omega", "x_{1}^2", "costs $"})
        EXPECT_EQ(text_markup(canvas_, text), escape(text)) << text;
    EXPECT_EQ(text_markup(canvas_, "\\$5 and \\$6"), "$5 and $6");
    EXPECT_EQ(text_markup(canvas_, "$\\nonsense$"), "$\\nonsense$");
    EXPECT_THAT(markup_problem("a $\\nonsense$"), HasSubstr("\\nonsense is not among the commands"));
    EXPECT_EQ(markup_problem("$\\dot\\theta_1^2$ and 5 $"), "");
}

TEST_F(Words, FormulasAreSetAsMathematics) {
    EXPECT_EQ(text_markup(canvas_, "$\\omega$"), math("ω"));
    EXPECT_EQ(text_markup(canvas_, "at $\\r{Re} x$"), "at Re " + math("x"));
    for (const char* text : {"$x_c$", "$\\dot\\theta$", "$\\frac{a}{2}$", "$\\sqrt{a}$", "$\\lambda_1^2$"})
        EXPECT_EQ(text_markup(canvas_, std::string("at ") + text), "at " + formula(text));
    std::string deep = "x";
    for (int k = 0; k < 200; ++k) deep = "\\frac{1}{" + deep + "}";
    EXPECT_NE(markup_problem("$" + deep + "$"), "");
}

// By the rules of labels (label_test.cpp), in the letters of pictures.
TEST_F(Words, PartsOfFormulasStandWhereTheyShould) {
    const TextStyle small{.size = 40 * 0.64};
    const double parts = std::max(canvas_.measure("1", small).w, canvas_.measure("1000", small).w);
    EXPECT_NEAR(width(formula("$\\frac{1}{1000}$")), parts + 2 * 0.09 * 40, 1e-9);
    const Box box = canvas_.measure(formula("$\\frac{1}{2}$"), style_), digit = canvas_.measure("1", style_);
    EXPECT_LT(box.y, digit.y);
    EXPECT_GT(box.bottom(), digit.bottom());
    EXPECT_NEAR(width("1" + formula("$2_1^1$") + "3"),
                width("1") + width("2") + canvas_.measure("1", {.size = 28.8}).w + width("3"), 1e-9);
    EXPECT_EQ(canvas_.text({200, 50}, formula("$\\frac{1}{2}$"), {.size = 40, .align = HAlign::right}).right(), 200);
}

// Within a formula only where it needs more than a line.
TEST_F(Words, LinesBreakBetweenWordsAndBeforeSigns) {
    TextStyle narrow = style_;
    narrow.max_width = 320;
    const auto lines = wrapped_lines(canvas_, "speeds of $a = b + c + d$ of it all", narrow, 5);
    EXPECT_EQ(lines.front(), "speeds of");
    EXPECT_EQ(lines[1], text_markup(canvas_, "$a = b + c + d$ of it"));
    EXPECT_EQ(lines.back(), "all");
    narrow.max_width = 150;
    const auto broken = wrapped_lines(canvas_, "$a = b + c + d$", narrow, 5);
    ASSERT_EQ(broken.size(), 2u);
    EXPECT_EQ(broken[0], text_markup(canvas_, "$a = b$"));
    EXPECT_EQ(broken[1], text_markup(canvas_, "$+ c + d$"));
}

TEST(PlainWords, AreForOtherPrograms) {
    EXPECT_EQ(plain_text("F = $K\\delta^{3/2}$, $\\omega_1$ \\$"), "F = Kδ^3/2, ω_1 $");
    EXPECT_EQ(plain_text("$\\frac{\\lambda_1}{L}\\sqrt{EI}$"), "(λ_1)/L√(EI)");
    EXPECT_EQ(to_latex("$\\frac{λ_1}{L}$"), "$\\frac{\\lambda_{\\mathrm{1}}}{L}$");
}

TEST_F(Words, CharactersThatNoFontHasAreFound) {
    EXPECT_EQ(characters_without_font("plain text"), "");
    EXPECT_EQ(characters_without_font("ω₁ → 30° é"), "");
    EXPECT_EQ(characters_without_font("fall 🙂 and 🙂"), "🙂");
}

TEST(Lang, TellsThePicturesOwnWordsInChinese) {
    EXPECT_EQ(in(Lang::en, "bending moment"), "bending moment");
    EXPECT_EQ(in(Lang::zh, "bending moment"), "弯矩");
    EXPECT_EQ(in(Lang::zh, "1/50 speed"), "1/50 倍速");
    EXPECT_EQ(in(Lang::zh, "first-order, 2 modes"), "一阶模型, 2 阶模态");
}

}  // namespace
}  // namespace beamcam::render
