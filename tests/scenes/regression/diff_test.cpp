// `beamcam diff` as people and scripts meet it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr, ::testing::StartsWith;

constexpr const char* kFramesAndTable =
    R"({"outputs": [{"type": "frames", "file": "f-##.png", "size": [192, 108], "fps": 20, "from": 0.1, "to": 0.3, "view": {"style": "flat"}},
                    {"type": "trajectory", "file": "t.csv", "rate": 50, "channels": ["theta"]}], "time": {"end": 0.3}})";

TEST(Diff, RejectsWhatIsNoPictureWithSix) {
    const Folder folder;
    folder.write("empty.png", "");
    folder.write("text.png", "no picture");
    folder.write("film.mp4", "no picture");
    for (const char* file :
         {"empty.png", "text.png", "film.mp4", "absent.png", ".", "/dev/null", "$'\\xff\\xfe.png'"}) {
        const Finished finished = shell(folder, std::string("$BEAMCAM diff ") + file + " " + file);
        EXPECT_EQ(finished.code, 6) << file << finished.err;
        EXPECT_THAT(finished.err, StartsWith("beamcam: ")) << file;
        EXPECT_EQ(finished.out, "") << file;
    }
}

TEST(Diff, MeasuresDifferencesBySimilarityToo) {
    const Folder folder;
    shell(folder,
          "ffmpeg -v error -f lavfi -i testsrc=size=64x48:duration=1 -frames:v 1 a.png; "
          "ffmpeg -v error -i a.png -vf 'lutrgb=r=min(val+3\\,255)' b.png");
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b.png").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b.png --ssim 0.9").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b.png --ssim 1").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.png b.png --ssim 2").code, 2);
}

TEST(Diff, EndsWithZeroForTheSameAndSevenForOthers) {
    const Folder folder;
    folder.write("s.json", kFramesAndTable);
    ASSERT_EQ(shell(folder, "$BEAMCAM run -q s.json && $BEAMCAM run -q s.json -o b --set cam.phase=0.3").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff f-02.png f-02.png").code, 0);
    const Finished differs = shell(folder, "$BEAMCAM diff f-02.png f-03.png -o d.png");
    EXPECT_EQ(differs.code, 7) << differs.err;
    EXPECT_EQ(shell(folder, "$BEAMCAM diff f-02.png f-03.png -o ./f-03.png").code, 2);
    EXPECT_THAT(differs.out, HasSubstr("different"));
    EXPECT_THAT(differs.out, HasSubstr("largest channel difference"));
    EXPECT_THAT(differs.err, HasSubstr("wrote d.png"));
    EXPECT_EQ(shell(folder, "$BEAMCAM diff f-02.png f-03.png --tolerance 255").code, 0);
    const Finished json = shell(folder, "$BEAMCAM diff f-02.png f-03.png --json");
    EXPECT_THAT(json.out, HasSubstr("\"verdict\": \"different\""));
    EXPECT_THAT(json.out, HasSubstr("\"pixels\": 20736"));
}

TEST(Diff, SizeIsAVerdictOfItsOwn) {
    const Folder folder;
    folder.write("s.json", "{}");
    ASSERT_EQ(shell(folder,
                    "for w in 160 162; do $BEAMCAM render -q s.json --style flat --at 0 --size ${w}x90 -o $w.png; done")
                  .code,
              0);
    const Finished finished = shell(folder, "$BEAMCAM diff 160.png 162.png --tolerance 255");
    EXPECT_EQ(finished.code, 7);
    EXPECT_THAT(finished.out, HasSubstr("size 160x90 became 162x90"));
}

TEST(Diff, ComparesTablesOfBothFormats) {
    const Folder folder;
    folder.write("s.json", kFramesAndTable);
    ASSERT_EQ(shell(folder,
                    "$BEAMCAM simulate -q s.json --channels theta --rate 50 --trajectory a.npz && "
                    "$BEAMCAM simulate -q s.json --channels theta --rate 50 --trajectory a.csv && "
                    "$BEAMCAM simulate -q s.json --channels theta --rate 50 --trajectory b.csv --set gravity=9.82")
                  .code,
              0);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.npz a.csv").code, 0);
    const Finished differs = shell(folder, "$BEAMCAM diff a.csv b.csv");
    EXPECT_EQ(differs.code, 7);
    EXPECT_THAT(differs.out, HasSubstr("theta: largest difference"));
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.csv b.csv --tolerance 1e-2").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.csv b.csv --tolerance 1e-6").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.csv s.json").code, 2);
    folder.write("late.csv", "t,theta\n0,1\n0.5,1\n");
    folder.write("later.csv", "t,theta\n0,1\n0.6,1\n");
    EXPECT_THAT(shell(folder, "$BEAMCAM diff late.csv later.csv").out,
                HasSubstr("the times (column t) differ first in row 2: 0.5 became 0.6"));
    folder.write("bad.csv", "t,theta\n0\n");
    const Finished bad = shell(folder, "$BEAMCAM diff a.csv bad.csv");
    EXPECT_EQ(bad.code, 6);
    EXPECT_THAT(bad.err, HasSubstr("bad.csv:2:1"));
}

TEST(Diff, ComparesTextsOfTables) {
    const Folder folder;
    folder.write("a.csv", "case,x\n\"stiff, \"\"hard\"\"\",1\nsoft,2\n3,3\n");
    folder.write("b.csv", "case,x\n\"stiff, hard\",1\nsoft,2\nthree,3\n");
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.csv a.csv").code, 0);
    const Finished differs = shell(folder, "$BEAMCAM diff a.csv b.csv --tolerance 1");
    EXPECT_EQ(differs.code, 7);
    EXPECT_THAT(differs.out, HasSubstr("case: 2 texts differ\n1 of 2 columns identical in 3 rows\n"));
    // Classes of motion are names too, in the column that sweeps write; elsewhere they are texts.
    for (const char* column : {"class", "case"}) {
        folder.write("periodic.csv", std::string("cam.speed,") + column + "\n1,periodic\n2,rest\n");
        folder.write("chaotic.csv", std::string("cam.speed,") + column + "\n1,periodic\n2,chaotic\n");
        const Finished classes = shell(folder, "$BEAMCAM diff periodic.csv chaotic.csv --tolerance 10");
        EXPECT_EQ(classes.code, 7) << column;
        EXPECT_THAT(classes.out, HasSubstr(std::string(column) + ": 1 text differs\n"));
    }
    // Instants that are texts.
    folder.write("t.csv", "t,x\nfirst,1\nsecond,2\n");
    folder.write("u.csv", "t,x\nfirst,1\nsecond,3\n");
    EXPECT_THAT(shell(folder, "$BEAMCAM diff t.csv u.csv").out,
                HasSubstr("x: largest difference 1, 1 of its range 1\n"));
    EXPECT_THAT(shell(folder, "$BEAMCAM info a.csv").out,
                HasSubstr("a.csv: table with texts\n  columns        2\n  rows           3\n"));
}

TEST(Diff, NetcdfFilesAreNotRead) {
    const Folder folder;
    folder.write("a.nc", "CDF");
    folder.write("a.csv", "t\n1\n");
    const Finished done = shell(folder, "$BEAMCAM diff a.nc a.csv");
    EXPECT_EQ(done.code, 6);
    EXPECT_THAT(done.err, HasSubstr("a.nc: NetCDF files are written only; write .npz or .csv, too"));
    EXPECT_THAT(shell(folder, "$BEAMCAM info a.nc").out, HasSubstr("not read: beamcam writes NetCDF files only"));
}

TEST(Diff, ATableWithAnEmptyTimeIsItself) {
    const Folder folder;
    folder.write("a.csv", "t,theta\n0,1\n,2\n0.1,3\n");
    folder.write("b.csv", "t,theta\n0,1\n,2.5\n0.1,3\n");
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.csv a.csv").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff a.csv b.csv").code, 7);
}

TEST(Diff, KeepsPicturesThatBeamcamDidNotMake) {
    const Folder folder;
    folder.write("s.json", "{}");
    ASSERT_EQ(
        shell(folder, "for t in 0 0.2; do $BEAMCAM render -q s.json --style flat --at $t --size 160x90 -o $t.png; done")
            .code,
        0);
    folder.write("d.png", "mine");
    EXPECT_EQ(shell(folder, "$BEAMCAM diff 0.png 0.2.png -o d.png").code, 6);
    EXPECT_EQ(testing::slurp(folder / "d.png"), "mine");
    EXPECT_EQ(shell(folder, "$BEAMCAM diff 0.png 0.2.png -o absent/d.png").code, 6);
    EXPECT_EQ(shell(folder, "$BEAMCAM diff 0.png 0.2.png -o d.txt").code, 2);
}

}  // namespace
}  // namespace beamcam::scenes
