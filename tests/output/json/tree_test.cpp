#include "output/json/tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

namespace beamcam {
namespace {

std::string first_message(const std::string& text) {
    const Parsed parsed = parse(text);
    if (parsed.messages.empty()) return "";
    const LineColumn at = locate(text, parsed.messages.front().place.offset);
    return std::to_string(at.line) + ":" + std::to_string(at.column) + " " + parsed.messages.front().text;
}

TEST(Tree, CommentsAndTrailingCommasAreSkipped) {
    const Parsed parsed =
        parse("{ // a \"comment\", \n \"a//b\": [1, 2,], /* , } */ \"c\\\"/*\": 3, // x\n } /* the end */ // y");
    ASSERT_TRUE(parsed.is_json);
    EXPECT_EQ(one_line(parsed.root), "{\"a//b\": [1, 2], \"c\\\"/*\": 3}");
    EXPECT_EQ(first_message("{\"a\": 1 /* }"),
              "1:9 a comment that is not closed, or of an unknown kind; write // … or /* … */");
}

TEST(Tree, OtherCommasWithoutAValueAreErrors) {
    for (const char* text : {"[,]", "{,}", "[1,,]", "{\"a\":,}", ",", "[1,/**/,2]"})
        EXPECT_FALSE(parse(text).is_json) << text;
}

TEST(Tree, KeysAndValuesHavePositions) {
    const std::string text = "{\n  \"α\": \"x\", \"b\" : [ -1.5e3, {\"c\": true}, \"\\\"]\" , null],\n\t\"d\":{}}";
    const Parsed parsed = parse(text);
    ASSERT_TRUE(parsed.is_json);
    auto at = [&](const SourcePosition& place) {
        const LineColumn where = locate(text, place.offset);
        return std::to_string(where.line) + ":" + std::to_string(where.column);
    };
    const Node& root = parsed.root;
    EXPECT_EQ(at(root.find("α")->key_place), "2:3");
    EXPECT_EQ(at(root.find("α")->value.place), "2:8");
    EXPECT_EQ(at(root.find("b")->key_place), "2:13");
    const Node& b = root.find("b")->value;
    EXPECT_EQ(at(b.place), "2:19");
    EXPECT_EQ(at(b.items[0].place), "2:21");
    EXPECT_EQ(b.items[0].text, "-1.5e3");
    EXPECT_EQ(b.items[0].number, -1500);
    EXPECT_EQ(at(b.items[1].find("c")->value.place), "2:35");
    EXPECT_EQ(b.items[2].text, "\"]");
    EXPECT_EQ(at(b.items[3].place), "2:50");
    EXPECT_EQ(at(root.find("d")->value.place), "3:6");
}

TEST(Tree, AByteOrderMarkIsNoCharacter) {
    const std::string text = "\xEF\xBB\xBF{\"a\": 1}";
    const Parsed parsed = parse(text);
    ASSERT_TRUE(parsed.is_json);
    EXPECT_EQ(locate(text, parsed.root.find("a")->key_place.offset).column, 2u);
}

TEST(Tree, DuplicateKeysAreReportedAndTheFirstCounts) {
    const Parsed parsed = parse("{\"a\": {\"b\": 1,\n \"b\": {\"c\": [2]}, \"d\": 3}}");
    ASSERT_TRUE(parsed.is_json);
    ASSERT_EQ(parsed.messages.size(), 1u);
    EXPECT_NE(parsed.messages[0].text.find("duplicate key \"b\""), std::string::npos);
    const Node& a = parsed.root.find("a")->value;
    ASSERT_EQ(a.members.size(), 2u);
    EXPECT_EQ(a.find("b")->value.number, 1);
    EXPECT_EQ(a.find("d")->value.number, 3);
}

TEST(Tree, SyntaxErrorsNameThePlaceAndTheRemedy) {
    EXPECT_EQ(first_message(""), "1:1 the file is empty; the smallest scene is {}");
    EXPECT_EQ(first_message("{\"a\": 1\n \"b\": 2}"), "2:2 a comma is missing before this");
    EXPECT_EQ(first_message("{\"a\" 1}"), "1:6 a colon is missing between a key and its value");
    EXPECT_EQ(first_message("{\"a\": }"), "1:7 a value is missing before this; write it, or remove the key");
    EXPECT_EQ(first_message("{\"a\": [1, 2}"), "1:12 '}' closes what '[' in line 1 opened; write ']'");
    EXPECT_EQ(first_message("{\"a\": [1, 2]"), "1:1 this object is never closed: the file ends before its '}'");
    EXPECT_EQ(first_message("{\"a\": \"b\n\"}"),
              "1:7 this text has no closing quote in its line; close it with \" (a line break inside a text is \\n)");
    EXPECT_EQ(first_message("{\"a\": \"b\tc\"}"),
              "1:7 this text contains a control character; write it as \\t or \\u0000");
    for (const char* text : {"{\"a\": \"\\ud800\"}", "{\"a\": \"\\ud800\\n\"}", "{\"a\": \"\\q\"}"})
        EXPECT_TRUE(first_message(text).starts_with("1:7 this text contains an escape that JSON does not have"))
            << text;
    for (const char* word : {"1.5.2", "1.", "-", "+1", ".5", "0x10", "1e", "2-1"})
        EXPECT_EQ(
            first_message(std::string("[0, ") + word + "]"),
            std::string("1:5 \"") + word +
                "\" is not a number in JSON; write for example 0.5, -3 or 1e-8, and \"12 mm\" with a unit in quotes");
    EXPECT_EQ(
        first_message("[trues]"),
        "1:2 \"trues\" has no quotes; put names and texts in double quotes (only true, false and null have none)");
    EXPECT_EQ(first_message("[1 /**/ 2]"), "1:9 a comma is missing before this");
    EXPECT_EQ(first_message("{1: 2}"), "1:2 a key is expected here, in double quotes: \"key\": value");
    EXPECT_EQ(first_message("{\"a\": 09}"), "1:7 number 09 begins with 0; JSON writes it without");
    EXPECT_EQ(first_message("{\"a\": 1e999}"), "1:7 number 1e999 is too large for a double; the largest is 1.8e308");
    EXPECT_EQ(first_message("{\"a\": " + std::string(5000, '9') + "}"),
              "1:7 number " + std::string(60, '9') + "… is too large for a double; the largest is 1.8e308");
    EXPECT_EQ(first_message("{} {}"), "1:4 text after the end of the scene; a file holds one object { … }");
    EXPECT_EQ(first_message("{\"a\": yes}"),
              "1:7 \"yes\" has no quotes; put names and texts in double quotes (only true, false and null have none)");
    EXPECT_EQ(first_message("{\"a\": 12 mm}"),
              "1:10 \"mm\" has no quotes; put names and texts in double quotes (only true, false and null have none)");
    EXPECT_EQ(first_message("{\"a\": \"\xff\"}"), "1:8 byte 0xff is not UTF-8; save the file as UTF-8");
    EXPECT_EQ(first_message(std::string("{\0}", 3)),
              "1:2 a NUL byte; the file is not text, or it is damaged: save it as UTF-8 text");
    EXPECT_EQ(first_message(std::string(100, '[')), "1:65 more than 64 nested brackets; a scene needs only a few");
}

TEST(Tree, NumbersAreThoseThatAreWritten) {
    const Parsed parsed =
        parse("[-0, -0.0, 18446744073709551615, 18446744073709551616, -9223372036854775808, 1e5, 5e-324]");
    ASSERT_TRUE(parsed.is_json);
    std::vector<double> numbers;
    for (const Node& item : parsed.root.items) numbers.push_back(item.number);
    EXPECT_EQ(numbers, (std::vector<double>{0, 0, 0x1p64, 0x1p64, -0x1p63, 1e5, 5e-324}));
    EXPECT_TRUE(std::signbit(numbers[0]) && std::signbit(numbers[1]));
    EXPECT_EQ(parsed.root.items[3].text, "18446744073709551616");
    EXPECT_EQ(first_message("[0, 1e-400]"), "1:5 number 1e-400 is too small for a double; write 0 if zero is meant");
    EXPECT_EQ(first_message("[0e-400]"), "");
}

TEST(Tree, ManyDuplicateKeysAreReportedInOnePass) {
    std::string text = "{\"a\": 0";
    for (int i = 0; i < 200; ++i) text += ",\n\"a\": 1";
    const Parsed parsed = parse(text + "}");
    ASSERT_EQ(parsed.messages.size(), 200U);
    EXPECT_EQ(parsed.messages[99].text, "duplicate key \"a\", first in line 1; remove one of them");
    EXPECT_EQ(parsed.messages[100].text, "duplicate key \"a\"; remove one of them");  // only counted in reports
}

TEST(Tree, NoPrefixOfASceneIsMistakenForAWholeOneOrCrashes) {
    const std::string text =
        "{\"a\": [1.5e-3, \"x\\u00e9\\n\", {\"b\": null, // c\n \"d\": [true, false,],}], /* e */ \"f\": \"é\"}";
    ASSERT_TRUE(parse(text).is_json);
    for (std::size_t n = 0; n < text.size(); ++n) {
        const Parsed parsed = parse(text.substr(0, n));
        EXPECT_FALSE(parsed.is_json) << n;
        ASSERT_EQ(parsed.messages.size(), 1u) << n;
        EXPECT_LE(parsed.messages[0].place.offset, n);
    }
}

TEST(Tree, AnyOneDamagedByteGivesATreeOrOneMessage) {
    const std::string text = "{\"a\": [1.5e-3, \"x\\u00e9\", {\"b\": null}], \"f\": -0}";
    for (std::size_t i = 0; i < text.size(); ++i)
        for (int byte = 0; byte < 256; ++byte) {
            std::string damaged = text;
            damaged[i] = static_cast<char>(byte);
            const Parsed parsed = parse(damaged);
            if (parsed.is_json) continue;
            ASSERT_EQ(parsed.messages.size(), 1u) << damaged;
            EXPECT_LE(parsed.messages[0].place.offset, damaged.size());
        }
}

bool has_trailing_comma(const std::string& text) {
    for (std::size_t at = text.find(','); at != std::string::npos; at = text.find(',', at + 1))
        if (const std::size_t next = text.find_first_not_of(" \t\r\n", at + 1);
            next != std::string::npos && (text[next] == ']' || text[next] == '}'))
            return true;
    return false;
}

// The tree of nlohmann-json is built in another way, and without trailing commas.
TEST(Tree, AgreesWithNlohmannsOwnTreeOnDamagedTexts) {
    const std::string whole =
        "{\"a\": [1.5e-3, \"x\\u00e9\\ud83d\\ude00\\n\", {\"b\": null, \"c\": [[], {}]}], \"f\": -0, \"t\": [true, "
        "false, 1e5, "
        "-2.5E+7]} ";
    const std::string bytes = "{}[]\",:\\u0e19+-. tfn\n\t\x01";
    std::mt19937 random(1);
    long accepted = 0;
    for (int k = 0; k < 50'000; ++k) {
        std::string text = whole;
        for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
            const std::size_t at = random() % text.size();
            const char byte = bytes[random() % bytes.size()];
            switch (random() % 3) {
                case 0:
                    text[at] = byte;
                    break;
                case 1:
                    text.erase(at, 1 + random() % 5);
                    break;
                default:
                    text.insert(at, 1, byte);
            }
        }
        if (has_trailing_comma(text)) continue;  // nlohmann's rejects it
        const Parsed parsed = parse(text);
        const auto other = nlohmann::json::parse(text, nullptr, false);
        ASSERT_EQ(parsed.is_json, !other.is_discarded()) << text;
        if (!parsed.is_json || !parsed.messages.empty()) continue;  // nlohmann's keeps the last of equal keys
        ++accepted;
        ASSERT_EQ(nlohmann::json::parse(to_text(parsed.root)), other) << text;
    }
    EXPECT_GT(accepted, 2000);
}

TEST(Source, TheCaretIsBelowThePlaceWhateverPrecedesIt) {
    const std::vector<Source> sources = {{"f.json", "{\n\t\"αβ\": \"x\"}", true}};
    const std::size_t offset = sources[0].text.find("\"x");
    EXPECT_EQ(describe(sources, Message{{0, offset}, "wrong", true}),
              "f.json:2:8: wrong\n    2 |  \"αβ\": \"x\"}\n      |        ^\n");
}

TEST(Source, LongLinesAreCutAroundThePlace) {
    const std::string line = std::string(500, 'a') + "X" + std::string(500, 'b');
    const std::string text = describe(std::vector<Source>{{"f", line, true}}, Message{{0, 500}, "wrong", true});
    const std::size_t second = text.find('\n') + 1, third = text.find('\n', second) + 1;
    EXPECT_LT(third - second, 130u);
    EXPECT_NE(text.find("aX"), std::string::npos);
}

}  // namespace
}  // namespace beamcam
