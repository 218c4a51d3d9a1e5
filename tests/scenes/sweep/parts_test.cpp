// Sweeps cut into parts: the joined file has the bytes of the whole, and foreign parts are rejected by name.
#include "scenes/sweep/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

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
    EXPECT_TRUE(
        is(by_variables(
               "auto",
               {{"SGE_TASK_ID", "4"}, {"SGE_TASK_FIRST", "1"}, {"SGE_TASK_LAST", "8"}, {"SGE_TASK_STEPSIZE", "1"}}),
           4, 8));
    EXPECT_TRUE(is(by_variables("auto/9", {{"PBS_ARRAY_INDEX", "9"}}), 9, 9));
    for (const char* text : {"auto", "0/3", "4/3", "x/3", "1", "1/0", "auto/x"})
        EXPECT_THROW(by_variables(text, {}), UsageError) << text;
    EXPECT_THROW(by_variables("auto", {{"PBS_ARRAY_INDEX", "9"}}), UsageError);
    EXPECT_THROW(
        by_variables("auto",
                     {{"SLURM_ARRAY_TASK_ID", "2"}, {"SLURM_ARRAY_TASK_MIN", "3"}, {"SLURM_ARRAY_TASK_COUNT", "3"}}),
        UsageError);
}

TEST(SweepParts, JoinToTheBytesOfTheWhole) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    for (const char* seed : {"same", "carry-up,same"}) {
        const std::string sweep = std::string("$BEAMCAM sweep s.json -q --force --seed ") + seed + " -o r.nc";
        ASSERT_EQ(shell(folder, sweep + " && mv r.nc whole.nc").code, 0);
        for (const int parts : {1, 2, 5}) {
            const Finished joined = shell(
                folder, "for i in $(seq " + std::to_string(parts) + "); do " + sweep + " --shard $i/" +
                            std::to_string(parts) + " -j2 || exit 1; done; $BEAMCAM collect --force " +
                            (parts > 1 ? "r.*of" + std::to_string(parts) + ".nc -o r.nc" : "-o r.nc r.nc || true"));
            ASSERT_EQ(joined.code, 0) << joined.err;
            EXPECT_EQ(slurp(folder / "r.nc"), slurp(folder / "whole.nc")) << parts << " " << seed;
        }
    }
}

TEST(SweepParts, AreRejectedByName) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    ASSERT_EQ(shell(folder,
                    "for i in 1 2 3; do $BEAMCAM sweep s.json -q -o r.nc --shard $i/3; done; cp r.2of3.nc copy.nc; "
                    "$BEAMCAM sweep s.json -q -o other.nc --keep 13 --shard 2/3; "
                    "$BEAMCAM sweep s.json -q -o r.nc --shard 1/2; $BEAMCAM sweep s.json -q -o whole.nc")
                  .code,
              0);
    for (const auto& [parts, words] :
         {std::pair{"r.1of3.nc r.3of3.nc", "missing: 2"},
          std::pair{"r.1of3.nc r.2of3.nc copy.nc r.3of3.nc", "copy.nc: the same part as r.2of3.nc"},
          std::pair{"r.1of3.nc other.2of3.nc r.3of3.nc", "other.2of3.nc: part of another sweep"},
          std::pair{"r.1of3.nc r.1of2.nc", "r.1of2.nc: one of 2 parts"},
          std::pair{"whole.nc", "whole.nc: a complete sweep"}, std::pair{"s.json", "s.json"},
          std::pair{"none.nc", "none.nc"}}) {
        const Finished done = shell(folder, std::string("$BEAMCAM collect -o x.nc ") + parts);
        EXPECT_EQ(done.code, 6) << parts;
        EXPECT_THAT(done.err, HasSubstr(words)) << parts;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.nc"));
    }
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json -o r.nc --shard 2/3").err,
                HasSubstr("kept r.2of3.nc: up to date"));
    EXPECT_EQ(shell(folder, "$BEAMCAM sweep s.json -o r.csv --shard 1/2").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM sweep s.json --shard 1/2").code, 2);
}

TEST(SweepParts, OfFilmsAreThoseOfAnArrayTaskToo) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.2}, "outputs": [{"type": "video", "file": "f.mp4", "fps": 60}]})");
    const Finished task = shell(folder,
                                "SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_COUNT=3 "
                                "$BEAMCAM run s.json -n --shard auto");
    EXPECT_EQ(task.code, 0) << task.err;
    EXPECT_THAT(task.out, HasSubstr("f.2of3.mp4: 4 frames"));
    EXPECT_EQ(shell(folder, "$BEAMCAM run s.json -n --shard auto").code, 2);
}

TEST(SweepParts, EndWithTheSameBytesAfterTheyWereKilled) {
    const Folder folder;
    folder.write("s.json", kPartedScene);
    const std::string part = "$BEAMCAM sweep s.json -q --transient 2000 -o r.nc --shard 2/2";
    ASSERT_EQ(shell(folder, part + " && mv r.2of2.nc whole.nc").code, 0);
    ASSERT_EQ(shell(folder, part + " --force & pid=$!; while [ ! -s r.2of2.nc.part ]; do :; done; kill -9 $pid; "
                                   "wait $pid; true")
                  .code,
              0);
    ASSERT_EQ(shell(folder, part).code, 0);
    EXPECT_EQ(slurp(folder / "r.2of2.nc"), slurp(folder / "whole.nc"));
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json --transient 2000 -o r.nc --shard 2/2").err,
                HasSubstr("up to date"));
}

// A sweep whose command needs every kind of quoting: spaces, braces, quotation marks, and a name of a scene with one.
constexpr const char* kQuoted =
    "'a scene.json' --set 'contact={\"model\": \"restitution\", \"restitution\": 0.6}' --over cam.speed=40:44:9n";

std::string made_by(const char* engine) {
    return "mkdir bin; ln -s \"$BEAMCAM\" bin/beamcam; PATH=\"$PWD/bin:$PATH\"; $BEAMCAM sweep " +
           std::string(kQuoted) + " -q -o whole.nc && $BEAMCAM sweep " + kQuoted + " -o r.nc --parts 3 --emit " +
           engine;
}

TEST(SweepParts, AreAnArrayOfSlurm) {  // tests/campaign/slurm.py runs one
    const Folder folder;
    folder.write("a scene.json", kPartedScene);
    const std::string script = shell(folder, made_by("slurm")).out;
    EXPECT_THAT(script, HasSubstr("#SBATCH --array=1-3\n"));
    EXPECT_THAT(script, HasSubstr("--shard auto"));
    // The tasks of the array, one after the other.
    const Finished done = shell(folder, made_by("slurm") +
                                            " > run.sh; for i in 1 2 3; do SLURM_ARRAY_TASK_ID=$i "
                                            "SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_COUNT=3 sh run.sh || exit; done; "
                                            "$BEAMCAM collect r.*of3.nc -o r.nc");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(slurp(folder / "r.nc"), slurp(folder / "whole.nc"));
}

TEST(SweepParts, AreMadeByGnuParallel) {
    if (std::system("parallel --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no GNU parallel";
    const Folder folder;
    folder.write("a scene.json", kPartedScene);
    const Finished done = shell(folder, made_by("parallel") + " > run.sh && sh run.sh");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(slurp(folder / "r.nc"), slurp(folder / "whole.nc"));
    // Another sweep of the same name: its parts are made again.
    folder.write("a scene.json", std::string(kPartedScene) + "\n// changed\n");
    const Finished again = shell(folder,
                                 "PATH=\"$PWD/bin:$PATH\"; sed 's/40:44/41:45/' run.sh > again.sh && sh again.sh && "
                                 "beamcam sweep 'a scene.json' -q -o other.nc --over cam.speed=41:45:9n --set "
                                 "'contact={\"model\": \"restitution\", \"restitution\": 0.6}'");
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(slurp(folder / "r.nc"), slurp(folder / "other.nc"));
    EXPECT_NE(slurp(folder / "r.nc"), slurp(folder / "whole.nc"));
}

TEST(SweepParts, AreMadeBySnakemake) {
    SKIP_UNDER_SANITIZERS();
    if (std::system("snakemake --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no Snakemake";
    const Folder folder;
    folder.write("a scene.json", kPartedScene);
    const std::string snakemake = "HOME=\"$PWD\" snakemake --cores 2 --quiet";
    const Finished done = shell(folder, made_by("snakemake") + " > Snakefile && " + snakemake);
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(slurp(folder / "r.nc"), slurp(folder / "whole.nc"));
    // A part that is lost is made again, and nothing else.
    const Finished again = shell(folder, "PATH=\"$PWD/bin:$PATH\"; rm r.2of3.nc r.nc && touch mark && " + snakemake +
                                             " && find . -name 'r.*' -newer mark");
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_THAT(again.out, AllOf(HasSubstr("r.2of3.nc"), HasSubstr("r.nc"), Not(HasSubstr("r.1of3.nc"))));
    EXPECT_EQ(slurp(folder / "r.nc"), slurp(folder / "whole.nc"));
}

}  // namespace
}  // namespace beamcam::scenes
