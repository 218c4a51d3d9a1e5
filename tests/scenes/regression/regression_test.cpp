// `beamcam test`: what it catches, what it lets pass, what it touches.
#include "scenes/regression/regression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/commands/commands.hpp"
#include "tests/scenes/regression/guarded.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;
using testing::Finished, testing::Folder, testing::Guarded, testing::kBaselines, testing::shell, testing::slurp;

TEST(Regression, WhatWasNeverAcceptedIsMissingAndFails) {
    const Guarded folder;
    const Finished finished = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(finished.code, 7) << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("missing     fall"));
    EXPECT_EQ(slurp(folder / "b.json"), kBaselines);
}

TEST(Regression, UpdateEndsWithSevenAndThenAllIsIdentical) {
    const Guarded folder;
    const Finished updated = folder.update();
    EXPECT_EQ(updated.code, 7) << updated.err;
    EXPECT_THAT(updated.err, HasSubstr("references were changed"));
    EXPECT_TRUE(std::filesystem::exists(folder / "b/hit/0001.png"));
    const Finished again = shell(folder, "$BEAMCAM test b.json --strict -j1");
    EXPECT_EQ(again.code, 0) << again.out << again.err;
    EXPECT_THAT(again.err, HasSubstr("4 entries: 4 identical"));
    EXPECT_THAT(again.err, HasSubstr("2 simulations, 4 pictures"));  // three entries share one motion
}

TEST(Regression, AnEntryAloneIsJudgedAsAmongOthers) {
    const Guarded folder;
    folder.update();
    for (const char* name : {"fall", "hit", "motion", "fast"})
        EXPECT_EQ(shell(folder, std::string("$BEAMCAM test b.json --strict --filter ") + name).code, 0) << name;
}

TEST(Regression, DistinguishesAPictureThatMovedFromAMotionThatMoved) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "another title"})");
    const Finished picture = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(picture.code, 7);
    EXPECT_THAT(picture.out, HasSubstr("different   fall"));
    EXPECT_THAT(picture.out, HasSubstr("motion identical"));
    EXPECT_THAT(picture.out, HasSubstr("identical   motion"));
    EXPECT_THAT(picture.out, HasSubstr("expected    b/fall/0000.png"));
    folder.write("s.json", R"({"time": {"end": 0.35}, "contact": {"stiffness": 1.001e8}})");
    const Finished motion = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(motion.code, 7);
    EXPECT_THAT(motion.out, HasSubstr("motion different: impacts.0."));
    EXPECT_THAT(motion.out, HasSubstr("different   motion"));
}

// One shows the scene's motion, one two variants of it, one none.
TEST(Regression, FiguresAreGuardedWithTheMotionBehindThem) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.3}})");
    folder.write("b.json", R"({"entries": {
        "angle": {"scene": "s.json", "output": {"type": "figure", "figure": "angle", "file": "a.pdf", "dpi": 60}},
        "fall": {"scene": "s.json", "output": {"type": "figure", "figure": "free-fall", "dpi": 60}},
        "sketch": {"scene": "s.json", "output": {"type": "figure", "figure": "schematic", "dpi": 60, "lang": "zh"}}}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --update angle fall sketch").code, 7);
    const Finished again = shell(folder, "$BEAMCAM test b.json --strict -j2");
    EXPECT_EQ(again.code, 0) << again.out << again.err;
    EXPECT_THAT(again.out, HasSubstr("angle   picture identical | motion identical"));
    EXPECT_THAT(again.out, HasSubstr("fall    picture identical | motion identical"));
    EXPECT_THAT(again.out, HasSubstr("sketch  picture identical\n"));
    EXPECT_THAT(again.err, HasSubstr("3 simulations, 3 pictures"));
    // The same pixels as the file that the command makes.
    ASSERT_EQ(shell(folder, "$BEAMCAM figure s.json angle -o a.png --dpi 60 -q").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b/angle/0000.png").code, 0);
    folder.write("s.json", R"({"time": {"end": 0.3}, "beam": {"length": 1.02}})");
    const Finished longer = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(longer.code, 7);
    for (const char* part : {"different   angle", "different   fall", "picture different", "motion different"})
        EXPECT_THAT(longer.out, HasSubstr(part));
    // No collision in time: a verdict, not a failure of the test itself.
    folder.write("c.json", R"({"entries": {"close": {"scene": {"time": {"end": 0.1}},
        "output": {"type": "figure", "figure": "collision"}}}})");
    const Finished none = shell(folder, "$BEAMCAM test c.json");
    EXPECT_EQ(none.code, 7) << none.err;
    EXPECT_THAT(none.out, HasSubstr("time.end"));
}

TEST(Regression, UpdateTouchesOnlyTheEntriesItNames) {
    const Guarded folder;
    folder.update();
    const std::string fast = slurp(folder / "b/fast/0000.png");
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "another"})");
    const Finished finished = shell(folder, "$BEAMCAM test b.json --update fall");
    EXPECT_EQ(finished.code, 7);
    EXPECT_THAT(finished.out, HasSubstr("pixels"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --filter fall fast motion").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --filter hit").code, 7);
    EXPECT_EQ(slurp(folder / "b/fast/0000.png"), fast);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update fal").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --filter fal").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update fall --filter hit").code, 2);
}

TEST(Regression, ReadsOnlyAsFarAsTheEntryShows) {
    const Folder folder;
    folder.write(
        "b.json",
        R"({"entries": {"e": {"scene": {"time": {"end": 1000}}, "output": {"type": "frames", "to": 0.05, "fps": 20, "size": [64, 64], "view": {"style": "flat"}}}}})");
    EXPECT_EQ(shell(folder, "timeout 20 $BEAMCAM test b.json --update e").code, 7);
    EXPECT_THAT(slurp(folder / "b/e/impacts.json"), HasSubstr("\"reproducible_until\": 0.05"));
}

TEST(Regression, AnUpdateThatChangesNothingSaysSo) {
    const Guarded folder;
    folder.update();
    const auto written = [&](const char* file) { return std::filesystem::last_write_time(folder / file); };
    const auto motion = written("b/motion/motion.csv"), picture = written("b/fall/0000.png");
    const Finished again = folder.update();
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_THAT(again.out, Not(HasSubstr("wrote")));
    EXPECT_THAT(again.err, Not(HasSubstr("changed")));
    EXPECT_EQ(written("b/motion/motion.csv"), motion);
    EXPECT_EQ(written("b/fall/0000.png"), picture);
}

TEST(Regression, EntriesAreMeantByPatterns) {
    const Guarded folder;
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update 'f*'").code, 7);
    EXPECT_THAT(shell(folder, "$BEAMCAM test b.json --filter '*a*'").err, HasSubstr("2 entries: 2 identical"));
    EXPECT_THAT(shell(folder, "$BEAMCAM test b.json --filter hit 'm*'").err, HasSubstr("2 entries: 0 identical"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --filter 'x*'").code, 2);
    const Finished all = shell(folder, "$BEAMCAM test b.json --update all");
    EXPECT_EQ(all.code, 7);
    EXPECT_THAT(all.err, HasSubstr("4 entries"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --strict").code, 0);
}

// After 4 s the motion of the default scene is another one on another processor.
TEST(Regression, PicturesOfWhatIsNotReproducibleAreRejected) {
    const Folder folder;
    folder.write("b.json", R"({"entries": {
  "late": {"scene": {"time": {"end": 8}}, "output": {"type": "still", "at": 8, "size": [64, 64], "view": {"style": "flat"}}},
  "early": {"scene": {"time": {"end": 8}}, "output": {"type": "still", "at": 1, "size": [64, 64], "view": {"style": "flat"}}},
  "table": {"scene": {"time": {"end": 8}}, "output": {"type": "trajectory", "rate": 10, "channels": ["theta"]}}}})");
    const Finished updated = shell(folder, "$BEAMCAM test b.json --update all");
    EXPECT_EQ(updated.code, 7);
    EXPECT_THAT(updated.out, AllOf(HasSubstr("not accepted: it shows the motion until 8 s"), HasSubstr(" s, not from "),
                                   HasSubstr("choose an earlier instant")));
    EXPECT_FALSE(std::filesystem::exists(folder / "b/late"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --filter early table").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --filter late").code, 7);
}

TEST(Regression, MistakesInBaselinesAreReportedWithTheirPlaces) {
    const Folder folder;
    folder.write("s.json", "{}");
    folder.write("b.json", R"({
  "tolerance": {"chanel": 2, "share": 3},
  "entries": {
    "a": {"scene": "s.json", "output": {"type": "still"}},
    "b": {"scene": "absent.json", "output": {"type": "still", "at": 0}},
    "c": {"scene": {"beam": {"lenght": 1}}, "output": {"type": "still", "at": 0}},
    "d": {"scene": "s.json", "output": {"type": "video"}, "accepted": []},
    "../e": {},
    "f": 3,
    "g": {"scene": "s.json", "output": {"type": "page"}},
    "h": {"scene": "s.json", "output": {"type": "summary"}}
  }
})");
    const Finished finished = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(finished.code, 3) << finished.err;
    for (const char* part :
         {"b.json:2:17: unknown key \"chanel\"", "b.json:2:39: tolerance.share",
          "b.json:4:40: entries.a.output needs \"at\"", "b.json:5:20: entries.b.scene: cannot read absent.json",
          "b.json:6:30: unknown key \"lenght\"", "films are compared before they are encoded",
          "this type has no pictures", "a \"trajectory\" guards the motion and its impacts", "unknown key \"accepted\"",
          "b.json:8:5: \"../e\"", "b.json:9:10"})
        EXPECT_THAT(finished.err, HasSubstr(part));
    EXPECT_THAT(finished.err, Not(HasSubstr("entries.f needs")));
    for (const char* text : {"", "[]", "{}", "{\"entries\": {}}", "{\"entries\": 3}", "{\"entries\": {\"a\": {}",
                             "nonsense", "\xff\xfe"}) {
        folder.write("b.json", text);
        EXPECT_EQ(shell(folder, "$BEAMCAM test b.json").code, 3) << text;
    }
    EXPECT_EQ(shell(folder, "$BEAMCAM test absent.json").code, 6);
    EXPECT_EQ(shell(folder, "$BEAMCAM test .").code, 6);
}

TEST(Regression, DamagedReferencesAreErrorsNotVerdicts) {
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "another"})");
    const std::string png = slurp(folder / "b/fall/0000.png");
    folder.write("b/fall/0000.png", png.substr(0, png.size() / 2));
    const Finished cut = shell(folder, "$BEAMCAM test b.json --filter fall");
    EXPECT_EQ(cut.code, 6);
    EXPECT_THAT(cut.out, HasSubstr("b/fall/0000.png: it is not a readable PNG file; restore it, or replace it with"));
    folder.write("b/fall/0000.png", png);
    folder.write("b/fall/motion.csv", "t,theta\n0,zero\n");
    const Finished table = shell(folder, "$BEAMCAM test b.json --filter fall");
    EXPECT_EQ(table.code, 6);
    EXPECT_THAT(table.out, HasSubstr("motion.csv:2:3"));
    std::filesystem::remove(folder / "b/fall/motion.csv");
    EXPECT_THAT(shell(folder, "$BEAMCAM test b.json --filter fall").out, HasSubstr("motion missing"));
}

TEST(Regression, AnUpdateThatCannotBeWrittenLosesNothing) {
#if defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the thread sanitizer itself writes a file at the start, which must not be cut off";
#endif
    const Guarded folder;
    folder.update();
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "another"})");
    const std::string picture = slurp(folder / "b/fall/0000.png");
    const Finished finished = shell(folder, "ulimit -f 2; $BEAMCAM test b.json --update fall");
    EXPECT_EQ(finished.code, 6) << finished.out << finished.err;
    EXPECT_EQ(slurp(folder / "b/fall/0000.png"), picture);
}

// ---- what must not pass ----------------------------------------------------------------------------

TEST(Regression, AMotionThatThePictureComparesIsJudgedAsTheScenesOwn) {
    const Folder folder;
    const auto write = [&](const std::string& text, const std::string& stiffness) {
        std::string changed = text;
        if (const std::size_t at = changed.find("1e8"); at != std::string::npos) changed.replace(at, 3, stiffness);
        folder.write("b.json", changed);
    };
    write(R"({"entries": {"g": {"scene": {"time": {"end": 0.6}}, "output": {"type": "still", "at": 0.4,
        "size": [320, 180], "view": {"style": "flat"}, "compare": [{"label": "stiff"},
        {"label": "soft", "set": {"beam.modes": 3, "contact.stiffness": 1e8}}]}}}})",
          "1e8");
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --update g").code, 7);
    const std::string accepted = slurp(folder / "b.json");
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --strict").code, 0);
    for (const char* stiffness : {"1.001e8", "1.01e8"}) {
        write(accepted, stiffness);
        const Finished changed = shell(folder, "$BEAMCAM test b.json");
        EXPECT_EQ(changed.code, 7) << stiffness;
        EXPECT_THAT(changed.out, HasSubstr("motion different: soft: "));
    }
    folder.write("b.json", accepted);
    std::filesystem::remove(folder / "b/g/motion-2.csv");
    EXPECT_THAT(shell(folder, "$BEAMCAM test b.json").out, HasSubstr("soft: there is no motion in b/"));
}

// The picture that is compared is the reference: its digest alone never lets another one pass.
TEST(Regression, APictureThatDiffersFromItsReferenceFailsWhateverTheDigests) {
    const Guarded folder;
    folder.update();
    shell(folder, "ffmpeg -v error -i b/fall/0000.png -vf negate -y x.png && mv x.png b/fall/0000.png");
    const Finished finished = shell(folder, "$BEAMCAM test b.json --filter fall");
    EXPECT_EQ(finished.code, 7);
    EXPECT_THAT(finished.out, HasSubstr("picture different: "));
}

TEST(Regression, AMotionThatIsNotTheReferenceFails) {
    const Guarded folder;
    folder.update();
    folder.write("x.json", R"({"time": {"end": 0.35}, "contact": {"stiffness": 1.01e8}})");
    ASSERT_EQ(shell(folder,
                    "$BEAMCAM simulate x.json --trajectory b/motion/motion.csv --channels theta --rate 50 "
                    "--impacts b/motion/impacts.json --force -q")
                  .code,
              0);
    const Finished finished = shell(folder, "$BEAMCAM test b.json --filter motion");
    EXPECT_EQ(finished.code, 7);
    EXPECT_THAT(finished.out, AllOf(HasSubstr("motion different: "), HasSubstr("impacts.0.")));
    folder.swap("b/motion/motion.csv", "\n0.02,", "\n0.03,");
    EXPECT_THAT(shell(folder, "$BEAMCAM test b.json --filter motion").out,
                HasSubstr("the times (column t) differ first in row 2: 0.03 became 0.02"));
}

// ---- one entry's misfortune --------------------------------------------------------------------------

TEST(Regression, WhatIsWrongWithOneEntryCostsNoOther) {
    const Guarded folder;
    folder.update();
    const std::string right = slurp(folder / "b.json");
    folder.write("b/hit/motion.csv", "t,theta\n0,zero\n");
    const Finished damaged = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(damaged.code, 6) << damaged.out;
    for (const char* line : {"identical   fall", "identical   fast", "not-run     hit", "b/hit/motion.csv:2:3"})
        EXPECT_THAT(damaged.out, HasSubstr(line));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update hit").code, 7);  // replaces it
    folder.swap("b.json", R"("motion": {"scene": "s.json")", R"("motion": {"scene": "gone.json")");
    const Finished gone = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(gone.code, 3) << gone.out;
    EXPECT_THAT(gone.err, HasSubstr(":25: entries.motion.scene: cannot read gone.json: No such file"));
    for (const char* line : {"identical   fall", "identical   fast", "identical   hit", "not-run     motion"})
        EXPECT_THAT(gone.out, HasSubstr(line));
    folder.write("b.json", right);
    folder.swap("b.json", R"("at": "0.2 s")", R"("at": "impact:9")");
    const Finished unreachable = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(unreachable.code, 7);
    EXPECT_THAT(unreachable.out, HasSubstr("impact 9 does not occur"));
    for (const char* line : {"different   fall", "identical   hit", "identical   motion"})
        EXPECT_THAT(unreachable.out, HasSubstr(line));
}

TEST(GlRegression, WantOfOpenGlCostsLitEntriesAlone) {
    const Folder folder;
    folder.write("b.json", R"({"entries": {
  "lit": {"scene": {"time": {"end": 0.1}}, "output": {"type": "still", "at": 0.1, "size": [64, 64]}},
  "flat": {"scene": {"time": {"end": 0.1}}, "output": {"type": "still", "at": 0.1, "size": [64, 64], "view": {"style": "flat"}}}}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --update all").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --strict").code, 0);
    const Finished finished = shell(folder, "export BEAMCAM_GL=none; $BEAMCAM test b.json");
    EXPECT_EQ(finished.code, 5) << finished.err;
    EXPECT_THAT(finished.out, AllOf(HasSubstr("not-run     lit   picture not-run: "), HasSubstr("identical   flat")));
}

// ---- what is no change -------------------------------------------------------------------------------

TEST(Regression, AnErrorOfTheSolverIsNoMotion) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.6}})");
    folder.write("b.json", R"({"entries": {"m": {"scene": "s.json", "output": {"type": "trajectory", "rate": 200}}}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --update m").code, 7);
    EXPECT_THAT(slurp(folder / "b/m/motion.csv"), Not(HasSubstr("energy_residual")));
    for (const char* solver : {R"("rtol": 1e-9)", R"("method": "rk8")"}) {
        folder.write("s.json", std::string(R"({"time": {"end": 0.6}, "solver": {)") + solver + "}}");
        const Finished finished = shell(folder, "$BEAMCAM test b.json");
        EXPECT_EQ(finished.code, 0) << finished.out;
        EXPECT_THAT(finished.out, HasSubstr("equivalent  m"));
    }
}

// As on a processor without FMA, whose sines end in other digits.
TEST(Regression, AnotherMathematicalLibraryIsNoChange) {
    const Guarded folder;
    folder.update();
    const Finished finished = shell(
        folder,
        "export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-AVX2_Usable,-FMA_Usable; $BEAMCAM test b.json");
    EXPECT_EQ(finished.code, 0) << finished.out;
}

TEST(Regression, MessagesOfLibrariesAreNotInTheJson) {
    const Guarded folder;
    const Finished finished = shell(folder, "export PIXMAN_DISABLE=fast FC_DEBUG=1; $BEAMCAM test b.json --json");
    EXPECT_EQ(finished.out.substr(0, 2), "{\n") << finished.out;
    EXPECT_THAT(finished.out, Not(HasSubstr("pixman: ")));
}

}  // namespace
}  // namespace beamcam::scenes
