// Sweeps cut into parts: the joined file has the bytes of the whole, and foreign parts are rejected by name.
#include "scenes/sweep/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <sstream>

#include "output/files/atomic_file.hpp"
#include "scenes/scene/exit_code.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;
using testing::Finished, testing::Folder, testing::shell, testing::slurp;

constexpr const char* kPartedScene = R"({
    "beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.5}, "cam": {"eccentricity": "2 mm"},
    "sweep": {"over": [{"key": "cam.speed", "from": 40, "to": 60, "count": 23}],
              "transient": {"cam_turns": 50}, "keep": {"cam_turns": 12}}})";

Shard by_variables(const std::string& text, std::map<std::string, std::string> variables) {
    return shard_of(text, [&](const char* name) {
        const auto found = variables.find(name);
        return found == variables.end() ? nullptr : found->second.c_str();
    });
}

TEST(SweepParts, AreNumberedByTheUserOrTheEngine) {
    EXPECT_EQ(by_variables("2/3", {}).number, 2u);
    const auto is = [](const Shard& shard, std::uint64_t number, std::uint64_t count) {
        return shard.number == number && shard.count == count;
    };
    EXPECT_TRUE(is(by_variables("auto", {{"SLURM_ARRAY_TASK_ID", "7"},
                                         {"SLURM_ARRAY_TASK_MIN", "3"},
                                         {"SLURM_ARRAY_TASK_MAX", "11"},
                                         {"SLURM_ARRAY_TASK_STEP", "2"},
                                         {"SLURM_ARRAY_TASK_COUNT", "5"}}),
                   3, 5));
    EXPECT_TRUE(is(by_variables("auto/9", {{"SLURM_ARRAY_TASK_ID", "9"}}), 9, 9));
    for (const char* text : {"auto", "0/3", "4/3", "x/3", "1", "1/0", "auto/x"})
        EXPECT_THROW(by_variables(text, {}), UsageError) << text;
    EXPECT_THROW(by_variables("auto", {{"SLURM_ARRAY_TASK_ID", "9"}}), UsageError);  // of how many
    EXPECT_THROW(
        by_variables("auto",
                     {{"SLURM_ARRAY_TASK_ID", "2"}, {"SLURM_ARRAY_TASK_MIN", "3"}, {"SLURM_ARRAY_TASK_COUNT", "3"}}),
        UsageError);
}

TEST(SweepParts, JoinToTheBytesOfTheWhole) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    for (const char* seed : {"same", "carry-up,same"}) {
        const std::string sweep = std::string("$BEAMCAM sweep s.json -q --force --seed ") + seed + " -o ";
        ASSERT_EQ(shell(folder, sweep + "whole.csv && " + sweep + "whole.npz && " + sweep + "whole.nc").code, 0);
        for (const int parts : {2, 5}) {
            const std::string all = std::to_string(parts);
            const Finished joined = shell(folder, "for i in $(seq " + all + "); do " + sweep + "r.csv --shard $i/" +
                                                      all + " -j2 || exit 1; done; " +
                                                      "for e in csv npz nc; do $BEAMCAM collect -q --force r.*of" +
                                                      all + ".points -o r.$e || exit 1; done");
            ASSERT_EQ(joined.code, 0) << joined.err;
            for (const char* ending : {"csv", "npz", "nc"})
                EXPECT_EQ(slurp(folder / (std::string("r.") + ending)),
                          slurp(folder / (std::string("whole.") + ending)))
                    << parts << " " << seed << " " << ending;
        }
    }
}

// HDF5 used to crash when the program ended after that.
TEST(SweepParts, ANetcdfFileThatFindsNoRoomIsAnError) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    const Finished done = shell(folder,
                                "for i in 1 2; do $BEAMCAM sweep s.json -q -o r.csv --shard $i/2; done; ulimit -f 8; "
                                "$BEAMCAM collect r.1of2.points r.2of2.points -o r.nc");
    EXPECT_EQ(done.code, 6);
    EXPECT_THAT(done.err, HasSubstr("cannot write r.nc: File too large; the file is larger than this disk"));
    EXPECT_FALSE(std::filesystem::exists(folder / "r.nc"));
}

TEST(SweepParts, AreRejectedByName) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    ASSERT_EQ(
        shell(
            folder,
            "for i in 1 2 3; do $BEAMCAM sweep s.json -q -o r.csv --shard $i/3; done; cp r.2of3.points "
            "copy.points; $BEAMCAM sweep s.json -q -o other.csv --keep 13 --shard 2/3; "
            "$BEAMCAM sweep s.json -q -o r.csv --shard 1/2; head -c -9 r.2of3.points > cut.points; mkfifo pipe.points")
            .code,
        0);
    for (const auto& [parts, words] :
         {std::pair{"r.1of3.points r.3of3.points", "missing: 2"},
          std::pair{"r.1of3.points r.2of3.points copy.points r.3of3.points",
                    "copy.points: the same part as r.2of3.points"},
          std::pair{"r.1of3.points other.2of3.points r.3of3.points", "other.2of3.points: part of another sweep"},
          std::pair{"r.1of3.points r.1of2.points", "r.1of2.points: one of 2 parts"},
          std::pair{"r.1of3.points cut.points r.3of3.points", "cut.points: this part is damaged or cut off"},
          std::pair{"pipe.points", "pipe.points: not a part"}, std::pair{"s.json", "s.json: not a part"},
          std::pair{"none.points", "none.points"}}) {
        const Finished done = shell(folder, std::string("$BEAMCAM collect -o x.csv ") + parts);
        EXPECT_EQ(done.code, 6) << parts;
        EXPECT_THAT(done.err, HasSubstr(words)) << parts;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.csv"));
    }
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json -o r.csv --shard 2/3").err,
                HasSubstr("kept r.2of3.points: up to date"));
    EXPECT_THAT(shell(folder, "$BEAMCAM info r.2of3.points").out, HasSubstr("part of a sweep"));
    EXPECT_EQ(shell(folder, "$BEAMCAM sweep s.json --shard 1/2").code, 2);
}

// A part that somebody else made: its points are of classes, rows and numbers that the sweep does not have.
TEST(SweepParts, WithImpossiblePointsAreRejected) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    ASSERT_EQ(shell(folder, "for i in 1 2; do $BEAMCAM sweep s.json -q -o r.csv --shard $i/2; done").code, 0);
    const output::PointFile own(folder / "r.1of2.points");
    const SweepGrid grid(*testing::read(kPartedScene).scene);
    output::PointFile points(folder / "r.1of2.points");
    points.find_points(shape_of(grid));
    const std::size_t columns = shape_of(grid).columns;
    const auto rejected = [&](const std::function<void(output::StoredPoint&)>& change) {
        output::StoredPoint point = points.read(0);
        change(point);
        std::string bytes = output::text_of(own.head()) + output::text_of(point);
        for (std::uint64_t k = 2; k < grid.points(); k += 2) bytes += output::text_of(points.read(k));
        output::write_file(folder / "bad.points", bytes);
        const Finished done = shell(folder, "$BEAMCAM collect -o x.csv --force bad.points r.2of2.points");
        return done.code == 6 && done.err.find("bad.points: this part is damaged") != std::string::npos;
    };
    EXPECT_FALSE(rejected([](output::StoredPoint&) {}));
    for (const int kind : {100, -1, 1 << 30}) EXPECT_TRUE(rejected([&](auto& point) { point.kind = kind; })) << kind;
    EXPECT_TRUE(rejected([](auto& point) { point.period = -7; }));
    EXPECT_TRUE(rejected([](auto& point) { point.point = 1'000'000'000'000; }));
    EXPECT_TRUE(rejected([&](auto& point) { point.samples.resize(columns + 1); }));
    // Another sweep than the head says.
    std::string head = output::text_of({own.head().identity, "{\"part\": \"1/2\"}"});
    output::write_file(folder / "bad.points", head);
    EXPECT_EQ(shell(folder, "$BEAMCAM collect -o x.csv --force bad.points r.2of2.points").code, 6);
}

// What an attacker leaves beside a scene is read as the store of an interrupted sweep; the same attack there only costs
// the points.
TEST(SweepParts, WithImpossiblePointsAreComputedAgain) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    ASSERT_EQ(shell(folder,
                    "$BEAMCAM sweep s.json -q --seed carry-up -o whole.csv && "
                    "$BEAMCAM sweep s.json -q --seed carry-up -o own.csv --shard 1/2")
                  .code,
              0);
    output::StoredPoint point;
    for (const std::vector<double>& state :
         {std::vector<double>{1}, {1, 0, 0, 99, 0, 0, 0}, {1, 0, 0, 0, 0, NAN, 0}, {1, 0, 0, -1e300, 0, 0.5, 0}}) {
        point.state = state;
        EXPECT_FALSE(end_of(point));
    }
    point.kind = 100;
    const output::PointFile own(folder / "own.1of2.points");  // with the identity of the whole sweep
    output::write_file(folder / "r.csv.part", output::text_of(own.head()) + output::text_of(point));
    const Finished done = shell(folder, "$BEAMCAM sweep s.json -q --seed carry-up -o r.csv");
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(slurp(folder / "r.csv"), slurp(folder / "whole.csv"));
    ASSERT_EQ(shell(folder, "rm r.csv; touch victim; ln -s victim r.csv.part").code, 0);
    EXPECT_NE(shell(folder, "$BEAMCAM sweep s.json -q --seed carry-up -o r.csv").code, 0);
    EXPECT_EQ(slurp(folder / "victim"), "");
}

TEST(SweepParts, EndWithTheSameBytesAfterTheyWereKilled) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    const std::string part = "$BEAMCAM sweep s.json -q --transient 2000 -o r.csv --shard 2/2";
    ASSERT_EQ(shell(folder, part + " && mv r.2of2.points whole.points").code, 0);
    ASSERT_EQ(shell(folder, part + " --force & pid=$!; while [ ! -s r.2of2.points.part ]; do :; done; kill -9 $pid; "
                                   "wait $pid; true")
                  .code,
              0);
    ASSERT_EQ(shell(folder, part).code, 0);
    EXPECT_EQ(slurp(folder / "r.2of2.points"), slurp(folder / "whole.points"));
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json --transient 2000 -o r.csv --shard 2/2").err,
                HasSubstr("up to date"));
}

// ---- the recipes of SWEEPS.md --------------------------------------------------------------------------

// The block of code below the line with `name`, of three parts, for the scene s.json.
std::string recipe(const std::string& name) {
    std::istringstream lines(slurp(std::filesystem::path(BEAMCAM_TEST_DIR) / "../scenes/SWEEPS.md"));
    std::string line, text;
    while (std::getline(lines, line) && line.find("**" + name + "**") == std::string::npos) continue;
    while (std::getline(lines, line) && !line.starts_with("    ")) continue;
    for (; line.starts_with("    ") || line.empty(); std::getline(lines, line)) {
        text += (line.empty() ? "" : line.substr(4)) + "\n";
        if (!lines) break;
    }
    EXPECT_THAT(text, HasSubstr("beamcam")) << name;
    for (const auto& [word, other] : {std::pair{"scenes/bifurcation.json", "s.json"}, std::pair{"16", "3"}})
        for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos;)
            text.replace(at, std::strlen(word), other);
    return text;
}
constexpr const char* kProgram = "mkdir -p bin; ln -sf \"$BEAMCAM\" bin/beamcam; PATH=\"$PWD/bin:$PATH\"; ";

TEST(SweepParts, AreAnArrayOfSlurm) {  // tests/campaign/slurm.py runs one
    const Folder folder;
    folder.write("s.json", kPartedScene);
    folder.write("run.sh", recipe("Slurm"));
    EXPECT_THAT(slurp(folder / "run.sh"), HasSubstr("#SBATCH --array=1-3\n"));
    // The tasks of the array, one after the other.
    const Finished done =
        shell(folder, std::string(kProgram) +
                          "beamcam sweep s.json --seed same -q -o whole.csv; for i in 1 2 3; do "
                          "SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_COUNT=3 sh run.sh || "
                          "exit; done; beamcam collect r.*of3.points -o r.csv");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(slurp(folder / "r.csv"), slurp(folder / "whole.csv"));
}

TEST(SweepParts, AreMadeByGnuParallel) {
    if (std::system("parallel --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no GNU parallel";
    const Folder folder;
    folder.write("s.json", kPartedScene);
    folder.write("run.sh", recipe("GNU parallel"));
    const Finished done =
        shell(folder, std::string(kProgram) + "sh run.sh && beamcam sweep s.json --seed same -q -o whole.csv");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(slurp(folder / "r.csv"), slurp(folder / "whole.csv"));
}

TEST(SweepParts, AreMadeBySnakemake) {
    SKIP_UNDER_SANITIZERS();
    if (std::system("snakemake --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no Snakemake";
    const Folder folder;
    folder.write("s.json", kPartedScene);
    folder.write("Snakefile", recipe("Snakemake"));
    const std::string snakemake = std::string(kProgram) + "export HOME=\"$PWD\"; snakemake --cores 2 --quiet";
    const Finished done = shell(folder, snakemake + " && beamcam sweep s.json --seed same -q -o whole.csv");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(slurp(folder / "r.csv"), slurp(folder / "whole.csv"));
    // A part that is lost is made again, and nothing else.
    const Finished again =
        shell(folder, "rm r.2of3.points r.csv && touch mark && " + snakemake + " && find . -name 'r.*' -newer mark");
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_THAT(again.out, AllOf(HasSubstr("r.2of3.points"), HasSubstr("r.csv"), Not(HasSubstr("r.1of3.points"))));
    EXPECT_EQ(slurp(folder / "r.csv"), slurp(folder / "whole.csv"));
}

}  // namespace
}  // namespace beamcam::scenes
