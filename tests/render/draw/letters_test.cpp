// Which fonts write the letters of a text.
#include "render/draw/letters.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace beamcam::render {
namespace {

// The families of the fonts that write the text.
std::set<std::string> families(Typefaces typefaces, const std::string& text) {
    const Fonts fonts(true, typefaces);
    const TextStyle style{.size = 20};
    std::set<std::string> found;
    for (const SetRun& run : set_text(fonts, text, style).runs) {
        PangoLayout* layout = layout_of(fonts, run, style);
        for (GSList* at = pango_layout_get_line_readonly(layout, 0)->runs; at != nullptr; at = at->next) {
            const auto* glyphs = static_cast<PangoGlyphItem*>(at->data);
            PangoFontDescription* font = pango_font_describe(glyphs->item->analysis.font);
            found.insert(pango_font_description_get_family(font));
            pango_font_description_free(font);
        }
    }
    return found;
}

// The fonts of mathematics have a few letters and brackets of these scripts, as U+306E.
TEST(Letters, OfChineseJapaneseAndKoreanComeFromOneFont) {
    for (const Typefaces typefaces : {Typefaces::screen, Typefaces::print, Typefaces::serif})
        for (const char* text : {"ビームの衝突", "の", "梁〈凸轮〉〒", "「梁」は《動く》", "보의 충돌"})
            EXPECT_EQ(families(typefaces, text).size(), std::string(text).find(' ') == std::string::npos ? 1u : 2u)
                << text;
    EXPECT_EQ(families(Typefaces::screen, "の"), families(Typefaces::screen, "ビ"));
}

TEST(Letters, OfOtherScriptsBesideThemKeepTheirFont) {
    const std::string latin = *families(Typefaces::screen, "Beam").begin();
    EXPECT_TRUE(families(Typefaces::screen, "Beamの衝突").contains(latin));
}

}  // namespace
}  // namespace beamcam::render
