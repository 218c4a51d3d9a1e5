#include "output/files/text_safety.hpp"

#include <gtest/gtest.h>

namespace beamcam::output {
namespace {

TEST(TextSafety, PlainTextOfAnyLanguageStays) {
    for (const char* text : {"", "plain\n\ttext", "θ₀ = 45°, 梁", "שלום", "𝜔", "a\xCC\x81"})
        EXPECT_EQ(visible(text), text);
}

TEST(TextSafety, NothingSpeaksToTheTerminal) {
    EXPECT_EQ(visible("a\x1b[31mb\a\r\x7f"), "a\uFFFD[31mb\uFFFD\uFFFD\uFFFD");
    EXPECT_EQ(visible("\u009b31m"), "\uFFFD31m");
    for (const char* mark : {"\u061c", "\u200e", "\u200f", "\u202a", "\u202e", "\u2066", "\u2069", "\u2028", "\u2029",
                             "\ufeff", "\u200b", "\U000e0041"})
        EXPECT_EQ(visible(mark), "\uFFFD");
    EXPECT_EQ(visible(std::string_view("\0", 1)), "\uFFFD");
}

TEST(TextSafety, BytesThatAreNoTextBecomeReplacements) {
    for (const char* bytes : {"\xff", "\x80", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82"}) {
        std::string expected;
        for (const char* at = bytes; *at != 0; ++at) expected += "\uFFFD";
        EXPECT_EQ(visible(bytes), expected);
    }
}

TEST(TextSafety, AValueKeepsToItsLine) { EXPECT_EQ(one_line("a\nmade by\tme"), "a made by me"); }

TEST(TextSafety, JsonKeepsItsMeaning) {
    EXPECT_EQ(escaped_json("{\n \"a\": \"\u202e\u009b\U000e0041\"\n}"),
              "{\n \"a\": \"\\u202e\\u009b\\udb40\\udc41\"\n}");
}

}  // namespace
}  // namespace beamcam::output
