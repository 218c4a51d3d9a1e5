// The reports of `beamcam test`: pages, JUnit, annotations; and `beamcam accept`, which accepts a report.
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

TEST(Report, AnnotatesOnGitHub) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "100 %"})");
    const std::string command = "$BEAMCAM test b.json -q --only fall motion";
    EXPECT_THAT(shell(folder, command).err, Not(HasSubstr("::error")));
    const Finished annotated = shell(folder, "export GITHUB_ACTIONS=true GITHUB_STEP_SUMMARY=summary.md; " + command);
    EXPECT_EQ(annotated.code, 7);
    EXPECT_THAT(annotated.err, HasSubstr("::error file=b.json,title=fall: different::picture different: "));
    EXPECT_THAT(annotated.err, HasSubstr("%25)"));  // a share of the pixels, its sign escaped
    EXPECT_THAT(slurp(folder / "summary.md"),
                AllOf(HasSubstr("1 of 2 entries identical"), HasSubstr("| **fails** | fall | different | picture ")));
    EXPECT_THAT(shell(folder, "export GITHUB_ACTIONS=true; " + command + " --annotate none").err,
                Not(HasSubstr("::error")));
    EXPECT_THAT(shell(folder, command + " --annotate github").err, HasSubstr("::error"));
}

TEST(Report, SaysWhyAnEntryIsNotStrictlyTheSame) {
    const Guarded folder;
    folder.update();
    const std::string command = "$BEAMCAM test b.json -q --only motion --tolerance motion=1e-3";
    folder.write("s.json", R"({"time": {"end": 0.35}, "solver": {"rtol": 1e-9}})");
    EXPECT_EQ(shell(folder, command).code, 0);
    const Finished strict = shell(folder, command + " --strict");
    EXPECT_EQ(strict.code, 7);
    EXPECT_THAT(strict.out, HasSubstr("equivalent  motion"));
}

// Entries whose pictures another tool made, and entries that are held to a file.
TEST(Foreign, PicturesOfAnotherToolAreJudgedByDigestOrTolerance) {
    const Guarded folder;
    shell(folder, "ffmpeg -v error -f lavfi -i testsrc=size=64x48:rate=5:duration=1 t-%04d.png");
    folder.write("f.json", R"({"entries": {"one": {"file": "t-0001.png"}, "all": {"file": "t-####.png"}}})");
    EXPECT_EQ(shell(folder, "$BEAMCAM test f.json").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM test f.json --update all").code, 7);
    const Finished same = shell(folder, "$BEAMCAM test f.json --strict");
    EXPECT_EQ(same.code, 0) << same.out;
    EXPECT_THAT(same.err, HasSubstr("2 identical, 0 equivalent, 0 different, 0 missing; 0 simulations, 6 pictures"));
    shell(folder, "ffmpeg -v error -i t-0002.png -vf 'lutrgb=r=min(val+3\\,255)' -y x.png && mv x.png t-0002.png");
    const Finished other = shell(folder, "$BEAMCAM test f.json");
    EXPECT_EQ(other.code, 7);
    EXPECT_THAT(other.out, AllOf(HasSubstr("identical   one"), HasSubstr("different   all"),
                                 HasSubstr("1 of 5 pictures changed, number 1 most")));
    EXPECT_EQ(shell(folder, "$BEAMCAM test f.json --tolerance channel=3").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM test f.json --tolerance ssim=0.9").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM test f.json --tolerance ssim=1").code, 7);
    shell(folder, "rm t-0005.png");
    EXPECT_THAT(shell(folder, "$BEAMCAM test f.json --only all").out, HasSubstr("4 pictures drawn, 5 expected"));
    shell(folder, "rm t-*.png");
    EXPECT_EQ(shell(folder, "$BEAMCAM test f.json").code, 6);
}

TEST(Foreign, AnAcceptedFilmIsWhatASceneIsHeldTo) {
    SKIP_UNDER_SANITIZERS();
    const Guarded folder;
    folder.write("film.json", R"({"time": {"end": 0.4}, "outputs": [
  {"type": "video", "file": "film.mp4", "fps": 10, "size": [320, 180], "view": {"style": "flat"}}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run film.json").code, 0);
    folder.write("f.json",
                 R"({"entries": {"film": {"scene": {"time": {"end": 0.4}}, "expected": "film.mp4", "physics": false,
  "output": {"type": "frames", "fps": 10, "size": [320, 180], "view": {"style": "flat"}}, "tolerance": {"ssim": 0.97}}}})");
    const std::string accepted = slurp(folder / "f.json");
    const Finished alike = shell(folder, "$BEAMCAM test f.json --report r");
    EXPECT_EQ(alike.code, 0) << alike.out;
    EXPECT_THAT(slurp(folder / "r/index.html"), HasSubstr("1 entry, 1 simulation, 4 pictures"));
    EXPECT_THAT(alike.out, HasSubstr("equivalent  film"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test f.json --tolerance ssim=1").code, 7);
    EXPECT_EQ(slurp(folder / "f.json"), accepted);
    shell(folder, "sed -i 's/\"time\": {\"end\": 0.4}/\"time\": {\"end\": 0.4}, \"gravity\": 5/' f.json");
    const Finished other = shell(folder, "$BEAMCAM test f.json");
    EXPECT_EQ(other.code, 7);
    EXPECT_THAT(other.out, HasSubstr("SSIM"));
    shell(folder, "sed -i 's/, \"gravity\": 5//; s/0.4}}/0.3}}/' f.json");
    EXPECT_THAT(shell(folder, "$BEAMCAM test f.json").out, HasSubstr("film.mp4 has more"));
}

TEST(Foreign, DifferencesAreMeasuredBySimilarityToo) {
    const Guarded folder;
    shell(folder,
          "ffmpeg -v error -f lavfi -i testsrc=size=64x48:duration=1 -frames:v 1 a.png; "
          "ffmpeg -v error -i a.png -vf 'lutrgb=r=min(val+3\\,255)' b.png");
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b.png").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b.png --ssim 0.9").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b.png --ssim 1").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b.png --ssim 2").code, 2);
}

TEST(Accept, TakesPicturesAndMotionsOfAReport) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "gravity": 9.7, "title": "other"})");
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --report run/r --junit j.xml").code, 7);
    const Finished accepted = shell(folder, "$BEAMCAM accept run");  // as services unpack it
    EXPECT_EQ(accepted.code, 0) << accepted.err;
    EXPECT_EQ(accepted.out, "replaced  fall\nreplaced  hit\nreplaced  motion\n");
    const Finished again = shell(folder, "$BEAMCAM test b.json --strict");
    EXPECT_EQ(again.code, 0) << again.out;
    EXPECT_EQ(shell(folder, "$BEAMCAM hash b/fall/0000.png").out.substr(0, 64),
              shell(folder, "$BEAMCAM hash run/r/fall/0000-actual.png").out.substr(0, 64));
}

TEST(Accept, UndoesAnUpdateThatWasKilledFirst) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "other"})");
    shell(
        folder,
        "$BEAMCAM test b.json --report r; mkdir b/.beamcam-update; touch b/.beamcam-update/.beamcam.24a89ba2.journal");
    const Finished accepted = shell(folder, "$BEAMCAM accept r");
    EXPECT_EQ(accepted.code, 0) << accepted.err;
    EXPECT_THAT(accepted.err, HasSubstr("b.json: removed an update of the references that was interrupted"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --strict").code, 0);
}

TEST(Accept, TakesTheNamedEntriesOnly) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "other"})");
    shell(folder, "$BEAMCAM test b.json --report r");
    EXPECT_EQ(shell(folder, "$BEAMCAM accept r 'f*' --baselines b.json").out, "replaced  fall\n");
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --only fall --strict").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --only hit").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM accept r nothing").code, 2);
}

TEST(Accept, RejectsWhatIsDamagedAndChangesNothing) {
    const Guarded folder;
    folder.update();
    const std::string before = slurp(folder / "b.json");
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "other"})");
    shell(folder, "$BEAMCAM test b.json --report r");
    shell(folder, "cp b/fast/0000.png r/hit/0001-actual.png");
    const Finished exchanged = shell(folder, "$BEAMCAM accept r");
    EXPECT_EQ(exchanged.code, 6);
    EXPECT_THAT(exchanged.err, HasSubstr("r/hit/0001-actual.png is not the picture that was tested"));
    EXPECT_EQ(shell(folder, "$BEAMCAM accept b").code, 6);
    folder.write("r/report.json", "{");
    EXPECT_EQ(shell(folder, "$BEAMCAM accept r").code, 6);
    EXPECT_EQ(slurp(folder / "b.json"), before);
    EXPECT_FALSE(std::filesystem::exists(folder / "b/.beamcam-update"));
}

// What has nothing to accept costs no other entry.
TEST(Accept, NamesWhatHasNothingAndTakesTheOthers) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "gravity": 9.7})");
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --report r").code, 7);  // it holds a motion that is out of date soon
    folder.write("s.json", R"({"time": {"end": 0.35}, "solver": {"max_steps": 1}})");
    shell(folder, "sed -i 's/cam.speed=5/cam.speed=6/' b.json");
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --only motion fast --report r").code, 7);
    const std::string motion = slurp(folder / "b/motion/motion.csv");
    const Finished accepted = shell(folder, "$BEAMCAM accept r");
    EXPECT_EQ(accepted.code, 7);
    EXPECT_THAT(accepted.out, AllOf(HasSubstr("rejected  motion: the solver failed"), HasSubstr("replaced  fast\n")));
    EXPECT_EQ(slurp(folder / "b/motion/motion.csv"), motion);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --only fast --strict").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM accept r motion").code, 7);
}

// Through a report no more is accepted than by --update.
TEST(Accept, RejectsPicturesOfWhatIsNotReproducible) {
    const Guarded folder;
    folder.write("b.json", R"({"entries": {
  "late": {"scene": {"time": {"end": 8}}, "output": {"type": "still", "at": 8, "size": [64, 64], "view": {"style": "flat"}}},
  "table": {"scene": {"time": {"end": 8}}, "output": {"type": "trajectory", "rate": 10, "channels": ["theta"]}}}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --report r").code, 7);
    const Finished accepted = shell(folder, "$BEAMCAM accept r");
    EXPECT_EQ(accepted.code, 7);
    EXPECT_THAT(accepted.out, AllOf(HasSubstr("rejected  late: not accepted: it shows the motion until 8 s"),
                                    HasSubstr("replaced  table\n")));
    EXPECT_FALSE(std::filesystem::exists(folder / "b/late"));
    EXPECT_THAT(slurp(folder / "b.json"), HasSubstr("\"reproducible_until\": "));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --only table --strict").code, 0);
}

TEST(Accept, TakesNoFilesButThoseThatWereTested) {
    const Guarded folder;
    folder.update();
    const std::string before = slurp(folder / "b.json");
    folder.write("s.json", R"({"time": {"end": 0.35}, "gravity": 9.7})");
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --only motion --report r").code, 7);
    const std::string report = slurp(folder / "r/report.json");
    for (const char* name : {"../secret.csv", ".beamcam-reference"}) {
        folder.write("r/report.json", report);
        folder.swap("r/report.json", "motion.csv\": ", std::string(name) + "\": ");
        const Finished rejected = shell(folder, "$BEAMCAM accept r");
        EXPECT_EQ(rejected.code, 6) << name;
        EXPECT_THAT(rejected.err, HasSubstr("is not the name of a file")) << rejected.err;
    }
    folder.write("r/report.json", report);
    folder.swap("r/report.json", "\"motion\": {\n      \"verdict\"",
                "\"motion\": {\"renderer\": \"../x\",\n      \"verdict\"");
    EXPECT_EQ(shell(folder, "$BEAMCAM accept r").code, 6);
    folder.write("r/report.json", report);
    const std::string inner = "\"motion\": {\n        \"verdict\": ";
    folder.swap("r/report.json", inner + "\"different\"", inner + "\"differing\"");
    EXPECT_THAT(shell(folder, "$BEAMCAM accept r").err, HasSubstr("\"differing\" is not a verdict"));
    folder.write("r/report.json", report);
    shell(folder, "sed -i '$d' r/motion/motion.csv");
    const Finished changed = shell(folder, "$BEAMCAM accept r");
    EXPECT_EQ(changed.code, 6);
    EXPECT_THAT(changed.err, HasSubstr("r/motion/motion.csv is not the motion that was tested"));
    EXPECT_EQ(slurp(folder / "b.json"), before);
}

}  // namespace
}  // namespace beamcam::scenes
