// Positions of the runs of a label, for letters half as wide as their size.
#include "render/draw/label.hpp"

#include <gtest/gtest.h>

namespace beamcam::render {
namespace {

constexpr double kSize = 10;

SetLabel set(std::string_view markup, double smallest = 0) {
    const auto extent = [](const SetRun& run) -> RunExtent {
        return {0.5 * run.size * static_cast<double>(run.run.text.size()), 0.7 * run.size};
    };
    return set_label(parse_markup(markup), kSize, {.cap_height = 0.7, .smallest = smallest}, extent);
}

TEST(Label, TextIsAsWideAsItsLetters) {
    const SetLabel label = set("abc");
    EXPECT_DOUBLE_EQ(label.width, 15);
    EXPECT_DOUBLE_EQ(label.ascent, 7);
    EXPECT_DOUBLE_EQ(label.descent, 0);
    EXPECT_DOUBLE_EQ(label.smallest_letter, kSize);
}

TEST(Label, ScriptsStandBehindTheirBase) {
    const SetLabel label = set("1^{22}");
    ASSERT_EQ(label.runs.size(), 2u);
    EXPECT_DOUBLE_EQ(label.runs[1].x, 5);
    EXPECT_DOUBLE_EQ(label.runs[1].y, -3.6);
    EXPECT_DOUBLE_EQ(label.runs[1].size, 7.2);
    EXPECT_DOUBLE_EQ(label.width, 5 + 7.2);
    EXPECT_DOUBLE_EQ(set("1^{22}", 9).runs[1].size, 9);  // no letter is smaller
}

// Both scripts start at the same place, further from the baseline than one alone; the wider one determines the width.
TEST(Label, ScriptsOfOneBaseStandAboveEachOther) {
    for (const char* markup : {"1_{2}^{33}", "1^{33}_{2}"}) {
        const SetLabel label = set(markup);
        ASSERT_EQ(label.runs.size(), 3u) << markup;
        EXPECT_DOUBLE_EQ(label.runs[1].x, 5);
        EXPECT_DOUBLE_EQ(label.runs[2].x, 5);
        EXPECT_DOUBLE_EQ(std::min(label.runs[1].y, label.runs[2].y), -4.2);
        EXPECT_DOUBLE_EQ(std::max(label.runs[1].y, label.runs[2].y), 2.4);
        EXPECT_DOUBLE_EQ(label.width, 5 + 7.2);
    }
    // A superscript of two runs, one italic, has one height; the next run starts after both.
    const SetLabel mixed = set("$2^{n+1}_3$4");
    ASSERT_EQ(mixed.runs.size(), 5u);
    EXPECT_DOUBLE_EQ(mixed.runs[1].y, -4.2);
    EXPECT_DOUBLE_EQ(mixed.runs[2].y, -4.2);
    EXPECT_DOUBLE_EQ(mixed.runs[2].x, 5 + 3.6);
    EXPECT_DOUBLE_EQ(mixed.runs[3].x, 5);
    EXPECT_DOUBLE_EQ(mixed.runs[4].x, 5 + 3 * 3.6);
}

// An upright superscript, before or after a subscript.
TEST(Label, SuperscriptsLeanAwayFromItalicLetters) {
    EXPECT_DOUBLE_EQ(set("$x^2$").runs[1].x, 5 + 0.8);
    EXPECT_DOUBLE_EQ(set("$x^2_1$").runs[1].x, 5 + 0.8);
    EXPECT_DOUBLE_EQ(set("$x_1^2$").runs[2].x, 5 + 0.8);
    EXPECT_DOUBLE_EQ(set("$x_1^2$").runs[1].x, 5);
    EXPECT_DOUBLE_EQ(set("$x^n$").runs[1].x, 5);
    EXPECT_DOUBLE_EQ(set("$x$)").runs[1].x, 5 + 0.3);
}

}  // namespace
}  // namespace beamcam::render
