// The reports of `beamcam test`: pages and JUnit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/regression/guarded.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;
using testing::Finished, testing::Guarded, testing::shell, testing::slurp;

// Servers show pages of CI runs under a policy that forbids scripts and everything inline.
TEST(Report, IsAPageWithoutScriptsOrAnythingInline) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "a <b> & \"c\""})");
    const Finished finished = shell(folder, "$BEAMCAM test b.json --report r --json");
    EXPECT_EQ(finished.code, 7) << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("\"verdict\": \"different\""));
    for (const char* file : {"actual", "expected", "difference"})
        EXPECT_TRUE(std::filesystem::exists(folder / ("r/fall/0000-" + std::string(file) + ".png"))) << file;
    const std::string page = slurp(folder / "r/index.html");
    for (const char* forbidden : {"<style", "style=", "<script", "javascript:", "data:", "http", " on"})
        EXPECT_THAT(page, Not(HasSubstr(std::string(forbidden) + (forbidden[0] == ' ' ? "input=" : ""))));
    for (const char* view : {"fall-0-actual", "fall-0-expected", "fall-0-blink", "fall-0-difference", "show-failed"})
        EXPECT_THAT(page, HasSubstr("id=\"" + std::string(view) + "\""));
    EXPECT_THAT(shell(folder, "$BEAMCAM info r/index.html").out, HasSubstr("made by        beamcam\n"));
    EXPECT_THAT(slurp(folder / "r/report.css"), HasSubstr("#show-failed:checked ~ main .passes"));
}

TEST(Report, JUnitHasACaseForEachPictureAndMotion) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "a <b> & \"c\""})");
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --junit j.xml").code, 7);
    const Finished xml =
        shell(folder,
              "/usr/bin/python3 -c \"import xml.dom.minidom as m; d = m.parse('j.xml').documentElement; "
              "cases = d.getElementsByTagName('testcase'); "
              "print(d.getAttribute('tests'), d.getAttribute('failures'), len(cases), "
              "len(d.getElementsByTagName('failure')), cases[0].getAttribute('classname'), "
              "cases[0].getAttribute('name'), float(cases[0].getAttribute('time')) > 0)\"");
    EXPECT_EQ(xml.out, "7 2 7 2 b.fall picture True\n") << xml.err;
    folder.write("mine.xml", "mine");
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --junit mine.xml").code, 6);
    EXPECT_EQ(slurp(folder / "mine.xml"), "mine");
}

TEST(Report, JUnitCallsAnEntryThatCannotRunAnError) {
    const Guarded folder;
    folder.update();
    folder.swap("b.json", R"("hit": {"scene": "s.json")", R"("hit": {"scene": "none.json")");
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --junit j.xml").code, 3);
    const std::string xml = slurp(folder / "j.xml");
    EXPECT_THAT(xml, HasSubstr("failures=\"0\" errors=\"1\""));
    EXPECT_THAT(xml, HasSubstr("<error type=\"not-run\" message=\"not-run: b.json:"));
    EXPECT_THAT(xml, Not(HasSubstr("<failure")));
}

TEST(Report, SaysWhyAnEntryIsNotStrictlyTheSame) {
    const Guarded folder;
    folder.update();
    folder.allow("\"motion\": 1e-3");
    const std::string command = "$BEAMCAM test b.json -q --filter motion";
    folder.write("s.json", R"({"time": {"end": 0.35}, "solver": {"rtol": 1e-9}})");
    EXPECT_EQ(shell(folder, command).code, 0);
    const Finished strict = shell(folder, command + " --strict");
    EXPECT_EQ(strict.code, 7);
    EXPECT_THAT(strict.out, HasSubstr("equivalent  motion"));
}

// The pictures of a report go nowhere else, even if a link lies in the folder.
TEST(Report, FollowsNoLinkOutOfItsFolder) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "other"})");
    ASSERT_EQ(shell(folder, "mkdir r victim; ln -s ../victim r/fall").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --report r").code, 6);
    EXPECT_TRUE(std::filesystem::is_empty(folder / "victim"));
}

}  // namespace
}  // namespace beamcam::scenes
