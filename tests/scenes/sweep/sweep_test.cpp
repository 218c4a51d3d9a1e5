// `beamcam sweep` as scripts see it: tables, seeds, interruption, the same bytes however it is made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "output/data/table_reader.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/sweep/make_points.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell, testing::slurp;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSweptScene = R"({
    "beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.5},
    "cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5},
    "sweep": {"over": [{"key": "cam.speed", "from": 30, "to": 60, "count": 31}],
              "transient": {"cam_turns": 100}, "keep": {"cam_turns": 20}}})";

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        rows.emplace_back();
        std::istringstream cells(line + ",");
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
}

TEST(SweepCommand, WritesARowASampleWithTheColumnsThatScriptsRelyOn) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    const Finished done = shell(folder, "$BEAMCAM sweep s.json");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_TRUE(
        done.out.starts_with("cam.speed,seed,class,period,impacts_per_period,exponent,exponent_error,sample,t,"
                             "cam_phase,theta,theta_dot,contact_x,cam_angle,v_n_before,v_t_before,v_n_after,"
                             "v_t_after,duration\n"));
    const auto rows = rows_of(done.out);
    EXPECT_EQ(rows[1][0], "30");
    EXPECT_EQ(rows[1][2], "following");
    EXPECT_EQ(rows[1][7], "");  // no sample
    EXPECT_EQ(rows.back()[0], "60");
    EXPECT_THAT(done.err, HasSubstr("31 points"));
    for (std::size_t i = 1; i < rows.size(); ++i) ASSERT_EQ(rows[i].size(), rows[0].size());
}

TEST(SweepCommand, ComputesExponentsOnlyWhereTheyAreAskedFor) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    for (const char* asked : {"", " --exponents"}) {
        const Finished done = shell(folder, std::string("$BEAMCAM sweep s.json -q --over cam.speed=30,45,59") + asked);
        ASSERT_EQ(done.code, 0) << done.err;
        const auto rows = rows_of(done.out);
        ASSERT_GT(rows.size(), 3u);
        for (std::size_t i = 1; i < rows.size(); ++i) {
            EXPECT_EQ(rows[i][5].empty(), *asked == 0) << rows[i][0] << asked;
            EXPECT_EQ(rows[i][6].empty(), *asked == 0) << rows[i][0] << asked;
        }
    }
}

TEST(SweepCommand, OfPeaksWritesOneRowForEachMotion) {
    Folder folder;
    folder.write("s.json", R"({"beam": {"modes": 1}, "sweep": {"over": [{"key": "cam.speed", "values": [3, 5]}],
        "sample": "peaks", "transient": {"cam_turns": 0}, "keep": {"time": "0.6 s"}}})");
    const Finished done = shell(folder, "$BEAMCAM sweep s.json -q --diagram p.svg -o r.csv && cat r.csv");
    ASSERT_EQ(done.code, 0) << done.err;
    const auto rows = rows_of(done.out);
    ASSERT_EQ(rows.size(), 3u);
    const std::vector<std::string> last(rows[0].end() - 7, rows[0].end());
    EXPECT_EQ(last, (std::vector<std::string>{"force_peak", "stress_peak", "gap_peak", "rebound_peak", "impacts",
                                              "duration_peak", "lift_share"}));
    EXPECT_TRUE(std::filesystem::exists(folder / "p.svg"));
    for (const char* other : {"--figure bifurcation --value force_peak", "--figure peaks --value gap_peak"})
        EXPECT_EQ(shell(folder, std::string("$BEAMCAM sweep s.json -q --force --diagram p.svg ") + other).code, 0)
            << other;
}

TEST(SweepCommand, HasTheSameBytesWithAnyNumberOfThreads) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    for (const char* seed : {"same", "carry-up,carry-down", "random:3"}) {
        const std::string command = std::string("$BEAMCAM sweep s.json --force -q --seed ") + seed;
        ASSERT_EQ(shell(folder,
                        command + " -j1 -o one.csv && $BEAMCAM sweep s.json --force -q -j3 -o three.csv --seed " + seed)
                      .code,
                  0);
        EXPECT_EQ(slurp(folder / "one.csv"), slurp(folder / "three.csv")) << seed;
    }
}

TEST(SweepCommand, GoesOnAfterItWasKilled) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    const char* sweep = "$BEAMCAM sweep s.json -q --seed carry-up,same --transient 400 -o ";
    ASSERT_EQ(shell(folder, std::string(sweep) + "whole.csv").code, 0);
    ASSERT_EQ(shell(folder, std::string(sweep) + "part.csv & pid=$!; while [ ! -s part.csv.part ]; do :; done; "
                                                 "kill -9 $pid; wait $pid; true")
                  .code,
              0);
    ASSERT_EQ(shell(folder, std::string(sweep) + "part.csv").code, 0);
    EXPECT_EQ(slurp(folder / "part.csv"), slurp(folder / "whole.csv"));
    EXPECT_FALSE(std::filesystem::exists(folder / "part.csv.part"));
}

TEST(SweepCommand, LeavesAloneWhatIsUpToDate) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    ASSERT_EQ(shell(folder, "$BEAMCAM sweep s.json -o a.csv").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json -o a.csv").err, HasSubstr("up to date"));
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json -o a.csv --keep 21").err, HasSubstr("31 points in"));
    folder.write("mine.csv", "1,2");
    EXPECT_EQ(shell(folder, "$BEAMCAM sweep s.json -o mine.csv").code, 6);
    EXPECT_EQ(slurp(folder / "mine.csv"), "1,2");
}

TEST(SweepCommand, DiscardsThePointsOfAnotherSweepOnlyWhenForced) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    const std::string begun =
        "$BEAMCAM sweep s.json -q --transient 20000 -o a.csv & pid=$!; while [ ! -s a.csv.part ] || "
        "[ $(stat -c %s a.csv.part) -lt 8000 ]; do :; done; kill -9 $pid; wait $pid; ";
    const Finished other = shell(folder, begun + "cp a.csv.part kept; $BEAMCAM sweep s.json -o a.csv");
    EXPECT_EQ(other.code, 6);
    EXPECT_THAT(other.err, HasSubstr("a.csv.part: has points of another sweep"));
    EXPECT_EQ(slurp(folder / "a.csv.part"), slurp(folder / "kept"));
    EXPECT_EQ(shell(folder, "$BEAMCAM sweep s.json -o a.csv --force").code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.csv.part"));
}

TEST(SweepCommand, MissesTheNetCdfLibraryBeforeItComputesPoints) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    const Finished done = shell(folder, "BEAMCAM_MODULE_DIR=/nowhere $BEAMCAM sweep s.json -o a.nc");
    EXPECT_EQ(done.code, 5);
    EXPECT_THAT(done.err, Not(HasSubstr("points")));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.nc.part"));
}

TEST(SweepCommand, LeavesAloneAFileWhereItWouldKeepPoints) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    folder.write("a.csv.part", "mine");
    const Finished done = shell(folder, "$BEAMCAM sweep s.json -o a.csv");
    EXPECT_EQ(done.code, 6);
    EXPECT_THAT(done.err, HasSubstr("a.csv.part: points would be kept here, but this file is not beamcam's"));
    EXPECT_EQ(slurp(folder / "a.csv.part"), "mine");
}

TEST(SweepCommand, LeavesNothingBehindWhenItsTableOnStandardOutputIsKilled) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    shell(folder,
          "mkdir tmp; TMPDIR=$PWD/tmp $BEAMCAM sweep s.json -q --transient 200000 > out.csv & pid=$!; sleep 0.3; kill "
          "-9 $pid; wait $pid");
    EXPECT_TRUE(std::filesystem::is_empty(folder / "tmp"));
}

// The line of Python in SWEEPS.md.
TEST(SweepCommand, ItsNetcdfFileIsDrawnByXarray) {
    if (std::system("/usr/bin/python3 -c 'import xarray, matplotlib' 2>/dev/null") != 0) GTEST_SKIP() << "no xarray";
    Folder folder;
    folder.write("s.json", kSweptScene);
    std::istringstream lines(slurp(std::filesystem::path(BEAMCAM_TEST_DIR) / "../scenes/SWEEPS.md"));
    std::string line;
    while (std::getline(lines, line) && !line.starts_with("    import xarray")) continue;
    folder.write("draw.py", line.substr(4) + "\n");
    const Finished drawn =
        shell(folder, "$BEAMCAM sweep s.json -q -o r.nc && HOME=$PWD MPLBACKEND=Agg /usr/bin/python3 draw.py");
    EXPECT_EQ(drawn.code, 0) << drawn.err;
}

TEST(SweepCommand, WritesTheSameNumbersForNumpy) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    ASSERT_EQ(shell(folder, "$BEAMCAM sweep s.json -o a.csv -q && $BEAMCAM sweep s.json -o a.npz -q").code, 0);
    const output::ColumnTable table = output::read_table(folder / "a.npz");
    const auto rows = rows_of(slurp(folder / "a.csv"));
    ASSERT_EQ(table.rows(), rows.size() - 1);
    ASSERT_EQ(table.columns.size(), rows[0].size());
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        EXPECT_EQ(table.columns[c].name, rows[0][c]);
        if (table.columns[c].name == "class") continue;
        for (std::size_t row = 0; row < table.rows(); ++row) {
            const double value = table.columns[c].values[row];
            const std::string& cell = rows[row + 1][c];
            ASSERT_TRUE(cell.empty() ? std::isnan(value) : value == std::stod(cell))
                << table.columns[c].name << " " << row;
        }
    }
}

// Whatever unit the scene states, and the points are the same.
TEST(SweepCommand, DrawsInTheUnitOfItsOption) {
    render::Units units;
    adopt_unit("420rpm", dimension::kAngularSpeed, units);
    EXPECT_EQ(units, (render::Units{.speed = render::SpeedUnit::rpm}));
    adopt_unit("44", dimension::kAngularSpeed, units);
    EXPECT_EQ(units.speed, render::SpeedUnit::rpm);
    adopt_unit("30 deg/s", dimension::kAngularSpeed, units);
    EXPECT_EQ(units, (render::Units{.speed = render::SpeedUnit::degrees}));
    adopt_unit("44 rad/s", dimension::kAngularSpeed, units);
    adopt_unit("30 deg", dimension::kAngle, units);
    adopt_unit("3 mm", dimension::kLength, units);
    EXPECT_EQ(units, (render::Units{.degrees = true, .speed = render::SpeedUnit::radians}));
    EXPECT_EQ(units.unit("rad/s"), "rad/s");
    adopt_unit("0.5 rad", dimension::kAngle, units);
    EXPECT_FALSE(units.degrees);
    Folder folder;
    folder.write("s.json", kSweptScene);
    const Finished done = shell(folder,
                                "$BEAMCAM sweep s.json -q --transient 5 --keep 1 --over 'cam.speed=420 rpm:430rpm:2' "
                                "--diagram d.svg --caption d.txt -o d.csv");
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(slurp(folder / "d.txt"),
                ::testing::StartsWith("Bifurcation diagram over cam speed ω: every impact in "));
    const SweepGrid one(*testing::read(kSweptScene).scene);
    Scene other = one.scene();
    other.units.speed = render::SpeedUnit::rpm;
    EXPECT_EQ(SweepGrid(other).digest(), one.digest());
}

TEST(SweepCommand, TakesRangesListsColumnsAndUnits) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    folder.write("w.csv", "w,note\n40,first\n41.5,\n");  // texts in other columns do not matter
    const auto first_column = [&](const std::string& over) {
        const Finished done = shell(folder, "$BEAMCAM sweep s.json -q --transient 5 --keep 1 --over '" + over + "'");
        EXPECT_EQ(done.code, 0) << done.err;
        std::vector<std::string> values;
        for (const auto& row : rows_of(done.out))
            if (row[0] != "cam.speed" && (values.empty() || values.back() != row[0])) values.push_back(row[0]);
        return values;
    };
    using ::testing::ElementsAre;
    EXPECT_THAT(first_column("cam.speed=40:44:3"), ElementsAre("40", "42", "44"));
    EXPECT_THAT(first_column("cam.speed=44:40:2"), ElementsAre("44", "40"));
    EXPECT_THAT(first_column("cam.speed=40:40:1"), ElementsAre("40"));
    EXPECT_THAT(first_column("cam.speed=40 rad/s:42 rad/s:2"), ElementsAre("40", "42"));
    EXPECT_THAT(first_column("cam.speed=25:100:3:log"), ElementsAre("25", "50", "100"));
    EXPECT_THAT(first_column("cam.speed=50,40"), ElementsAre("50", "40"));
    EXPECT_THAT(first_column("cam.speed=@w.csv:w"), ElementsAre("40", "41.5"));
    EXPECT_EQ(first_column("cam.speed=300 rpm").at(0).substr(0, 6), "31.415");
    EXPECT_EQ(first_column("cam.speed=0:600rpm:3"), first_column("cam.speed=0 rpm,300rpm,600rpm"));
}

TEST(SweepCommand, RejectsWithAMessage) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    for (const auto& [arguments, code, words] :
         {std::tuple{"--over cam.spee=1:2:3", 2, "did you mean"},
          {"--over cam.speed", 2, "KEY=FIRST:LAST:COUNT"},
          {"--over cam.speed=1:2", 2, "KEY=FIRST:LAST:COUNT"},
          {"--over cam.speed=40:44:1", 2, "one value cannot have two ends"},
          {"--over cam.speed=40:44:1:log", 2, "one value cannot have two ends"},
          {"--over cam.speed=40:44:0", 2, "count = 0 is outside 1"},
          {"--over cam.speed=40:44:1e9", 2, "count = 1e9 is outside 1"},
          {"--over cam.speed=40:44:0.5", 2, "must be a whole number, not 0.5"},
          {"--over cam.speed=40:44:nan", 2, "count must be a whole number"},
          {"--over cam.speed=40:44:-3", 2, "count = -3 is outside 1"},
          {"--over cam.speed=0:44:3:log", 2, "log"},
          {"--over cam.speed=40:44:3s", 2, "3s"},
          {"--seed up", 2, "carry-up"},
          {"--sample never", 2, "impacts"},
          {"-o a.txt", 2, ".csv"},
          {"--transient -1", 2, "turns of the cam"},
          {"--keep 0", 2, "must be greater than 0"},
          {"--keep '0 s'", 2, "must be greater than 0"},
          {"--transient 1e19", 2, "up to 1e+09"},
          {"--over initial.angle=0.4:0.5:2 --seed carry-up", 2, "use \"same\""},
          {"--caption c.txt", 2, "belongs to --diagram"},
          {"--diagram d.pdf --value v_n", 2, "--value: the samples of the sweep have no column \"v_n\""},
          {"--over 'cam.speed=100:900:9 rpm'", 2, "count must be a whole number"},
          {"--over 'cam.speed=100:900 rpm:9'", 2, "some of its numbers have a unit"},
          {"--over 'cam.speed=300 rpm,400'", 2, "some of its numbers have a unit"},
          {"--over cam.speed=40:44:3 --over gravity=9:10:2 --diagram d.pdf --value exponent", 2,
           "the sweep computes no exponents"},
          {"-o - --shard 1/2", 2, "name the table of the whole sweep"},
          {"-o a.csv --shard 1/2 --diagram d.pdf", 2, "collect the parts first"},
          {"--over cam.eccentricity=0:0.2:3", 3, "sweep at cam.eccentricity = 0.1"},
          {"--over beam.modes=1:2:3", 3, "whole number"}}) {
        const Finished done = shell(folder, std::string("$BEAMCAM sweep s.json ") + arguments);
        EXPECT_EQ(done.code, code) << arguments;
        EXPECT_THAT(done.err, HasSubstr(words)) << arguments;
    }
}

TEST(SweepCommand, TurnsWithTheirUnitAreAsManyAsThePlainNumber) {
    const Folder folder;
    folder.write("s.json", kSweptScene);
    const auto rows = [&](const std::string& transient) {
        return shell(folder, "$BEAMCAM sweep s.json -q --over cam.speed=48 --keep 2 --transient " + transient).out;
    };
    EXPECT_EQ(rows("'7.2 turns'"), rows("7.2"));
    EXPECT_EQ(rows("'2592 deg'"), rows("7.2"));
    EXPECT_NE(rows("7.2"), rows("7"));
}

TEST(SweepCommand, PlansPointsAndFiles) {
    Folder folder;
    folder.write("s.json", kSweptScene);
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json -n --seed random:4").out, HasSubstr(": 124 points\n"));
    const std::string files = shell(folder, "$BEAMCAM sweep s.json -n --diagram d.pdf -o r.csv").out;
    for (const char* words : {"sweep       r.csv", "figure      d.pdf: bifurcation"})
        EXPECT_THAT(files, HasSubstr(words));
    EXPECT_FALSE(std::filesystem::exists(folder / "r.csv"));
}

TEST(SweepCommand, CarriesAStateAlongTheValues) {
    // Two attractors may live side by side: up and down need not agree, but each point of a carried row goes on from
    // the one before, so a slow row of one value repeats a long motion.
    Folder folder;
    folder.write("s.json", kSweptScene);
    const Finished row = shell(folder,
                               "$BEAMCAM sweep s.json -q --over cam.speed=48,48,48 --seed carry-up --transient 0 "
                               "--keep 10 --sample section:cam_angle=1");
    const Finished whole = shell(folder,
                                 "$BEAMCAM sweep s.json -q --over cam.speed=48 --transient 0 --keep 30 --sample "
                                 "section:cam_angle=1");
    const auto part = rows_of(row.out), all = rows_of(whole.out);
    ASSERT_EQ(part.size(), all.size());
    const std::size_t theta = 10;
    for (std::size_t i = 1; i < all.size(); ++i) EXPECT_NEAR(std::stod(part[i][theta]), std::stod(all[i][theta]), 1e-7);
}

TEST(SweepGrid, CutsIntoPartsThatAreAPartition) {
    const Scene scene =
        *testing::read(kSweptScene, {"sweep.seed=[\"same\", \"carry-up\"]",
                                     "sweep.over=[{\"key\": \"cam.speed\", \"values\": [1, 2, 3]}, {\"key\": "
                                     "\"contact.restitution\", \"values\": [0.1, 0.2]}]"})
             .scene;
    const SweepGrid grid(scene);
    EXPECT_EQ(grid.points(), 12u);
    EXPECT_EQ(grid.tasks(), 6u + 2u);
    for (const std::uint64_t parts : {1, 2, 3, 5}) {
        std::vector<int> count(grid.points(), 0);
        for (std::uint64_t number = 1; number <= parts; ++number) {
            const std::vector<bool> mine = points_of(grid, {number, parts});
            for (std::size_t p = 0; p < mine.size(); ++p) count[p] += mine[p] ? 1 : 0;
        }
        EXPECT_THAT(count, ::testing::Each(1));
    }
    EXPECT_EQ(grid.problem(2 * (3 + 2)).cam->speed, 3);
    EXPECT_EQ(grid.problem(2 * (3 + 2)).contact.restitution, 0.2);
}

}  // namespace
}  // namespace beamcam::scenes
