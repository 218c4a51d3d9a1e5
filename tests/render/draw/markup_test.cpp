#include "render/draw/markup.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace beamcam::render {
namespace {

TEST(Markup, OneMarkupIsDrawnAndWrittenAsLatexAndPlain) {
    EXPECT_EQ(to_plain("$θ$ / (rad s^{−1})"), "θ / (rad s⁻¹)");
    EXPECT_EQ(to_html("$c$_{r} < 1, s^{−1}"), "<i>c</i><sub>r</sub> &lt; 1, s<sup>−1</sup>");
    EXPECT_EQ(to_plain("a\\_b\\^\\$c\\\\d"), "a_b^$c\\d");
    const std::vector<render::Run> runs = parse_markup("$x_{\\r{max}}$2");
    ASSERT_EQ(runs.size(), 3u);
    EXPECT_TRUE(runs[0].symbol);
    EXPECT_EQ(runs[1].script, -1);
    EXPECT_FALSE(runs[1].symbol);
    EXPECT_THROW(parse_markup("$θ"), std::invalid_argument);
    EXPECT_THROW(parse_markup("m^{2"), std::invalid_argument);
}

}  // namespace
}  // namespace beamcam::render
