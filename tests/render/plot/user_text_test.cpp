// Words and formulas of pictures.
#include "render/plot/user_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "render/draw/markup.hpp"
#include "render/plot/labels.hpp"
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
        EXPECT_EQ(plain_text(text), text);
    EXPECT_EQ(plain_text("\\$5 and \\$6"), "$5 and $6");
    EXPECT_EQ(plain_text("$\\nonsense$"), "$\\nonsense$");
    EXPECT_THAT(markup_problem("a $\\nonsense$"), HasSubstr("\\nonsense is not among the commands"));
    EXPECT_EQ(markup_problem("$\\dot\\theta_1^2$ and 5 $"), "");
}

TEST_F(Words, FormulasAreSetAsMathematics) {
    for (const char* text : {"$\\omega$", "$\\r{Re} x$", "$\\dot\\theta$", "$\\frac{a}{2}$", "$\\sqrt{a}$"})
        EXPECT_EQ(text_markup(std::string("a_b ") + text), std::string("a\\_b ") + text);
    std::string deep = "x";
    for (int k = 0; k < 200; ++k) deep = "\\frac{1}{" + deep + "}";
    EXPECT_NE(markup_problem("$" + deep + "$"), "");
}

// By the rules of labels (label_test.cpp), in the letters of pictures.
TEST_F(Words, PartsOfFormulasStandWhereTheyShould) {
    EXPECT_NEAR(width("$\\frac{1}{1000}$"), width("1/") + width("1000"), 1e-9);
    EXPECT_NEAR(width("1$2_1^1$3"),
                width("1") + width("2") + canvas_.measure("1", {.size = 40 * 1690. / 2816}).w + width("3"), 1e-9);
    EXPECT_EQ(canvas_.text({200, 50}, "$\\frac{1}{2}$", {.size = 40, .align = HAlign::right}).right(), 200);
}

// Fractions and roots are written in one line.
TEST(PlainWords, AreForOtherPrograms) {
    EXPECT_EQ(plain_text("F = $K\\delta^{3/2}$, $\\omega_1$ \\$"), "F = Kδ^(3/2), ω₁ $");
    EXPECT_EQ(plain_text("$\\frac{\\lambda_1}{L}\\sqrt{EI}$"), "λ₁/L·√(EI)");
    EXPECT_EQ(plain_text("$1 + \\frac{3(1-c^2)}{4}\\frac{\\dot\\delta}{\\dot\\delta_0}$"), "1 + (3(1−c²))/4·δ̇/δ̇₀");
    EXPECT_EQ(plain_text("$K\\frac{1}{2L}x_{max}$"), "K·1/(2L)·x_max");
    EXPECT_EQ(plain_text("$x_1\\frac{a}{b}^2$, $x^{\\frac{1}{2L}}$"), "x₁·(a/b)², x^(1/(2L))");
    EXPECT_EQ(plain_text("$e^{-\\zeta t}$"), "e^(−ζt)");
}

TEST(UserMarkup, NamesOfFunctionsAreUpright) {
    const auto runs = parse_markup("$\\ddot\\theta = -\\frac{3g}{2L}\\cos\\theta$");
    ASSERT_GE(runs.size(), 3u);
    EXPECT_THAT(runs[runs.size() - 2].text, ::testing::EndsWith("cos\u2009"));
    EXPECT_FALSE(runs[runs.size() - 2].symbol);
    EXPECT_TRUE(runs.back().symbol);
    EXPECT_EQ(plain_text("$\\frac{3g}{2L}\\cos x$"), "(3g)/(2L)·cos\u2009x");
    EXPECT_EQ(plain_text("$\\sin(\\omega t)$, $\\cos^2\\theta$"), "sin(ωt), cos²θ");
    EXPECT_EQ(plain_text("$\\left(x_{\\mathrm{tip}}\\right)$"), "(x_tip)");
}

TEST(UserMarkup, ColouredLettersAreARun) {
    const auto symbols = parse_markup("\\color{#0072b2}{$θ$}, b");
    ASSERT_EQ(symbols.size(), 2u);
    EXPECT_EQ(symbols[0].color, 0x0072b2u);
    EXPECT_FALSE(symbols[1].color);
    for (const char* wrong : {"\\color{#0072}{a}", "\\color{#0072b2}a", "\\color{#0072b2}{a"})
        EXPECT_THROW(parse_markup(wrong), std::invalid_argument) << wrong;
}

TEST_F(Words, CharactersThatNoFontHasAreFound) {
    EXPECT_EQ(characters_without_font("plain text"), "");
    EXPECT_EQ(characters_without_font("ω₁ → 30° é"), "");
    EXPECT_EQ(characters_without_font("fall 🙂 and 🙂"), "🙂");
}

TEST(Lang, TranslatesWholePhrases) {
    EXPECT_EQ(phrase(Lang::en, "bending moment (√ scale)"), "bending moment (√ scale)");
    EXPECT_EQ(phrase(Lang::zh, "bending moment (√ scale)"), "弯矩（√ 标度）");
    EXPECT_EQ(phrase(Lang::zh, "hub to {} in {}", "3\u00A0rad/s", "2\u00A0s"),
              "轮毂加速至 3\u00A0rad/s，历时 2\u00A0s");
    EXPECT_EQ(phrase(Lang::zh, "multiple tips"), "multiple tips");
    EXPECT_EQ(speed_text(0.02, true, Lang::zh), "1/50 倍速");
    EXPECT_THAT(parameter_pieces({}, Lang::zh), ::testing::Contains("2 阶模态"));
}

// Every piece of the parameter line, for every drive, contact, friction and model: what is left in Latin letters are
// symbols and units.
TEST(Lang, LeavesNoEnglishWordInTheParameters) {
    const auto english_word = [](const std::string& text) {
        static const std::regex kWord("[A-Za-z]{3,}");
        static const std::set<std::string> kUnits{"rad", "rpm"};
        std::string found;
        for (std::sregex_iterator at(text.begin(), text.end(), kWord), end; at != end; ++at)
            if (!kUnits.contains(at->str())) found += at->str() + " ";
        return found;
    };
    std::vector<sim::Problem> problems(1);
    const auto more = [&](auto change) { change(problems.emplace_back()); };
    for (const sim::Drive& drive :
         std::initializer_list<sim::Drive>{sim::ConstantTorque{2}, sim::HarmonicTorque{1, 5}, sim::ConstantSpeed{0},
                                           sim::ConstantSpeed{3}, sim::SpinUp{3, 2}})
        more([&](sim::Problem& p) { p.hub.drive = drive; });
    for (const sim::ModelKind model : {sim::ModelKind::rigid, sim::ModelKind::zeroth_order, sim::ModelKind::first_order,
                                       sim::ModelKind::second_order, sim::ModelKind::exact, sim::ModelKind::paper})
        more([&](sim::Problem& p) { p.beam.model = model; });
    more([](sim::Problem& p) { p.contact.model = sim::ContactModel::restitution, p.gravity = 0; });
    more([](sim::Problem& p) { p.contact.friction = sim::CoulombFriction{0.2}; });
    more([](sim::Problem& p) { p.contact.damping = sim::DampingLaw::none; });
    for (const sim::Problem& problem : problems)
        for (const std::string& piece : parameter_pieces(problem, Lang::zh))
            EXPECT_EQ(english_word(piece), "") << piece;
}

}  // namespace
}  // namespace beamcam::render
