// beamcam lyapunov and beamcam orbits as scripts see them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "output/data/table_reader.hpp"
#include "scenes/scene/film_times.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr, ::testing::StartsWith;

// A torque presses a rigid beam on a fast cam: closed forms in MODEL.md (S78).
constexpr const char* kPressed = R"({
  "gravity": 0, "beam": {"model": "rigid"}, "hub": {"drive": {"type": "torque", "value": -1.009406}},
  "cam": {"speed": 45, "eccentricity": "2 mm", "phase": 0.5},
  "contact": {"model": "restitution", "restitution": 0.5}, "initial": {"angle": 0.46}})";

// The orbit of one turn, gone through three times, is none of three.
TEST(OrbitsCommand, ReportsTheShortestPeriod) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished three = shell(folder, "$BEAMCAM orbits s.json --turns 3 --transient 0");
    EXPECT_EQ(three.code, 4);
    EXPECT_THAT(three.err, HasSubstr("no periodic orbit was found with a shortest period of 3 turns"));
    EXPECT_THAT(three.err, HasSubstr("neither near the motion after a transient of 0 s, nor near throws"));
    EXPECT_THAT(shell(folder, "$BEAMCAM orbits s.json --turns 1 --transient 0").out, StartsWith("period 1 turn"));
}

// Beyond r = 1 there is no scene: the branch ends there, and grazes nothing.
TEST(OrbitsCommand, ABranchEndsWithTheRangeOfItsKey) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder, "$BEAMCAM orbits s.json --over contact.restitution=0.5:1 --impacts 1 --transient 0 -q");
    EXPECT_THAT(done.out, HasSubstr("the range ends"));
    EXPECT_THAT(done.out, ::testing::Not(HasSubstr("grazing")));
    // A branch that can be followed to the ends of the range has its last points there.
    const Finished whole = shell(
        folder, "$BEAMCAM orbits s.json --over cam.speed=43:48 --at '430 rpm' --impacts 1 --transient 0 -q --json");
    const nlohmann::json branch = nlohmann::json::parse(whole.out)["branches"][0];
    for (const auto& [point, end] : {std::pair{branch["points"].front(), 43.0}, {branch["points"].back(), 48.0}})
        EXPECT_EQ(point["value"], end);
}

// Zero is the default of the hub's inertia, and no inertia is less.
TEST(OrbitsCommand, ABranchMayStartAtTheLeastValueOfItsKey) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder, "$BEAMCAM orbits s.json --over hub.inertia=0:0.005 --impacts 1 --transient 0 -q --json");
    const nlohmann::json table = nlohmann::json::parse(done.out);
    ASSERT_EQ(table["branches"].size(), 2u);  // from the stable and from the unstable orbit
    for (const auto& branch : table["branches"]) {
        EXPECT_EQ(branch["points"].front()["value"], 0);
        EXPECT_EQ(branch["points"].back()["value"], 0.005);
    }
}

TEST(OrbitsCommand, AStepIsANumber) {
    const Folder folder;
    folder.write("s.json", kPressed);
    for (const std::string step : {"nan", "-nan", "inf", "0"})
        EXPECT_EQ(shell(folder, "$BEAMCAM orbits s.json --transient 0 --over cam.speed=44:46 --step=" + step).code, 2)
            << step;
}

// The scene's own initial state would lie in a cam of the largest radius, but orbits begin where they are.
TEST(OrbitsCommand, ABranchDoesNotNeedTheInitialState) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder, "$BEAMCAM orbits s.json --over 'cam.radius=99 mm:115 mm' --impacts 1 --transient 0 -q");
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("to 0.115 m\n"));
}

TEST(OrbitsCommand, ABranchWithRestSaysHowItsImpactsVaryAndWhatEndsIt) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done = shell(
        folder, "$BEAMCAM orbits s.json --set cam.speed=42.2 --over cam.speed=38:60 --step 0.1 --transient '10 s' -q");
    EXPECT_THAT(done.out, ::testing::ContainsRegex("branch of 1 turn, [0-9]+ to [0-9]+ impacts: "));
    EXPECT_THAT(done.out, HasSubstr("ends: release: the rest on the cam vanishes"));
    EXPECT_THAT(done.out, HasSubstr("ends: release: the flight before the rest on the cam vanishes"));
    // No digit beyond the first uncertain one.
    EXPECT_THAT(done.out,
                ::testing::ContainsRegex("release          cam.speed = [0-9]+\\.[0-9][0-9][0-9] ± [0-9]e-03 rad/s"));
}

// Nobody knows before how much motion the search integrates, and how many points the branches will have.
TEST(OrbitsCommand, CountsTheSearchAndThePointsOfBranchesWithoutATotal) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder, "$BEAMCAM orbits s.json --over cam.speed=44:46 --transient 0 --progress json >/dev/null");
    for (const std::string stage : {"search", "branches"}) {
        const std::size_t at = done.err.rfind("{\"stage\":\"" + stage + "\"");
        ASSERT_NE(at, std::string::npos) << done.err;
        const std::string line = done.err.substr(at);
        const nlohmann::json last = nlohmann::json::parse(line.substr(0, line.find('\n')));
        EXPECT_GT(last["done"].get<double>(), stage == "search" ? 0.1 : 2);
        EXPECT_TRUE(last["total"].is_null());
        EXPECT_TRUE(last["left"].is_null());
    }
}

TEST(OrbitsCommand, FindsFoldAndPeriodDoublingOverTheSpeed) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder, "$BEAMCAM orbits s.json --over cam.speed=41:52 --impacts 1 --transient 0 -q -o b.pdf --json");
    ASSERT_EQ(done.code, 0) << done.err;
    const nlohmann::json table = nlohmann::json::parse(done.out);
    EXPECT_EQ(table["parameter"], "cam.speed");
    ASSERT_EQ(table["branches"].size(), 1u);
    EXPECT_EQ(table["start"], 45);
    double fold = 0, doubling = 0;
    for (const auto& event : table["events"]) {
        EXPECT_EQ(event["branch"], 0);
        if (event["kind"] == "fold") fold = event["value"];
        if (event["kind"] == "period-doubling") doubling = event["value"];
    }
    EXPECT_NEAR(fold, 42.23567502238, 1e-4);  // as far as the torque has digits
    EXPECT_NEAR(doubling, 50.86884987331, 1e-4);
    EXPECT_EQ(table["branches"][0]["period"], 1);
    EXPECT_EQ(table["branches"][0]["impacts"], 1);
    const nlohmann::json& points = table["branches"][0]["points"];
    EXPECT_GT(points[0]["state"]["theta"], 0.3);
    EXPECT_EQ(points[0]["multipliers"].size(), 2u);
    EXPECT_THAT(testing::slurp((folder / "b.pdf").string()), StartsWith("%PDF"));
}

TEST(OrbitsCommand, DrawsBranchesOverTheImpactsOfASweep) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder,
              "$BEAMCAM sweep s.json --over cam.speed=44:46:3 --transient 40 --keep 4 -q -o r.csv && "
              "$BEAMCAM orbits s.json --over cam.speed=44.5:46.5 --impacts 1 --transient 0 -q --sweep "
              "r.csv -o b.svg && $BEAMCAM info b.svg");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(testing::slurp((folder / "b.svg").string()), HasSubstr("impacts of a sweep"));
    EXPECT_EQ(done.err, "");
    const Finished other = shell(folder, "$BEAMCAM orbits s.json --over gravity=0:1 --sweep r.csv -o c.svg");
    EXPECT_EQ(other.code, 2);
    EXPECT_THAT(other.err, HasSubstr("column gravity is missing"));
    EXPECT_EQ(shell(folder, "$BEAMCAM orbits s.json --sweep r.csv").code, 2);
}

// From a height the motion comes to rest on the cam for a part of each turn.
const std::string kFallsToRest = "--set initial.angle=45deg --set cam.phase=0 ";

// The scene's own motion rests on the cam; a sweep of the orbit beside it begins the search there.
TEST(OrbitsCommand, BeginsInTheStateOfARowOfASweep) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const std::string search = "$BEAMCAM orbits s.json -q --json " + kFallsToRest;
    const auto first = [&](const std::string& options) {
        const Finished done = shell(folder, search + options);
        EXPECT_EQ(done.code, 0) << done.err;
        return nlohmann::json::parse(done.out)["orbits"][0];
    };
    EXPECT_TRUE(first("--transient '10 s'")["chatters"]);
    EXPECT_FALSE(first("--impacts 1 --transient 0 --scene loop.json")["chatters"]);
    ASSERT_EQ(shell(folder,
                    "$BEAMCAM sweep loop.json --over cam.speed=45:46:2 --transient 40 --keep 4 -q -o r.csv && "
                    "$BEAMCAM sweep loop.json --over cam.speed=45:46:2 --transient 40 --keep 4 -q -o r.npz")
                  .code,
              0);
    const nlohmann::json found = first("--transient '10 s' --sweep r.csv --row 6");  // of 46 rad/s
    EXPECT_FALSE(found["chatters"]);
    EXPECT_EQ(found["impacts"], 1);
    EXPECT_EQ(first("--transient '10 s' --sweep r.npz --row 6"), found);
    // A plain number is turns of the cam, as of sweeps.
    EXPECT_EQ(first("--transient '75 turns' --sweep r.csv --row 6"), first("--transient 75 --sweep r.csv --row 6"));
    EXPECT_NEAR(found["duration"], 2 * std::numbers::pi / 46, 1e-12);
    const output::ColumnTable rows = output::read_table(folder / "r.csv");
    EXPECT_NEAR(found["touches"][0]["approach"], -(*rows.find("v_n_before"))[5], 1e-6);
    EXPECT_EQ(shell(folder, search + "--sweep r.csv --row 1000").code, 2);
    EXPECT_EQ(shell(folder, search + "--row 1").code, 2);
}

TEST(OrbitsCommand, FollowsAMotionThatRestsOnTheCamBesideOneThatDoesNot) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder, "$BEAMCAM orbits s.json --over cam.speed=44:54 --transient '20 s' -q --json " + kFallsToRest);
    ASSERT_EQ(done.code, 0) << done.err;
    const nlohmann::json table = nlohmann::json::parse(done.out);
    ASSERT_EQ(table["branches"].size(), 3u);  // two arise at a fold below the range
    double released = 0, doubled = 0;
    for (const auto& event : table["events"]) {
        if (event["kind"] == "release") released = event["value"];
        if (event["kind"] == "period-doubling") doubled = event["value"];
        EXPECT_EQ(event["branch"], event["kind"] == "release" ? 2 : 0);
    }
    EXPECT_NEAR(released, 52.317, 2e-3);
    EXPECT_NEAR(doubled, 50.86885, 1e-4);
}

// Its multipliers grow beyond 10⁶; before, each step was shorter than the one before it.
TEST(OrbitsCommand, AVeryUnstableBranchIsFollowedInLongStepsAndSaysWhyItEnds) {
    const Folder folder;
    const Finished done =
        shell(folder,
              "$BEAMCAM init --from bifurcation -q && $BEAMCAM orbits bifurcation.json --over cam.speed=38:60 "
              "--doublings 4 -q --json");
    ASSERT_EQ(done.code, 0) << done.err;
    const nlohmann::json table = nlohmann::json::parse(done.out);
    for (const nlohmann::json& branch : table["branches"])
        if (branch["period"] == 16) {
            EXPECT_LT(branch["points"].size(), 150u);
            EXPECT_THAT(std::string(branch["ends"][1]), StartsWith("the orbit is so unstable that rounding hides it"));
            return;
        }
    FAIL() << "no branch of 16 turns";
}

// The fold lies below the range, and near the motion at its middle there is an orbit of four impacts.
TEST(OrbitsCommand, FollowsAllOrbitsAtTheStartEachBranchOnce) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder, "$BEAMCAM orbits s.json --over cam.speed=46:60 --at 53 --transient '20 s' -q --json");
    ASSERT_EQ(done.code, 0) << done.err;
    const nlohmann::json table = nlohmann::json::parse(done.out);
    int single = 0, doublings = 0;
    for (const auto& branch : table["branches"]) single += branch["impacts"] == 1;
    for (const auto& event : table["events"])
        if (event["kind"] == "period-doubling" && event["impacts"] == 1) {
            ++doublings;
            EXPECT_NEAR(event["value"], 50.86885, 1e-4);
        }
    EXPECT_EQ(single, 2);  // from the two orbits that arise at the fold
    EXPECT_EQ(doublings, 1);
    // Where the range contains the fold they are one.
    const nlohmann::json whole = nlohmann::json::parse(
        shell(folder, "$BEAMCAM orbits s.json --over cam.speed=41:60 --at 53 --transient '20 s' -q --json").out);
    single = 0;
    for (const auto& branch : whole["branches"]) single += branch["impacts"] == 1;
    EXPECT_EQ(single, 1);
}

// Below the fold there is no orbit to begin with.
TEST(OrbitsCommand, BeginsElsewhereInTheRangeWhereTheSceneHasNoOrbit) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done = shell(folder,
                                "$BEAMCAM orbits s.json --set cam.speed=41 --over cam.speed=40:48 --impacts 1 "
                                "--transient 0 --progress none");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.err, HasSubstr("at 41 rad/s no orbit was found, or only such that rest on the cam; the search "
                                    "went on at 44 rad/s"));
    EXPECT_THAT(done.out, HasSubstr("fold             cam.speed = 42.235"));
}

// The film shows one period, the second: as the motion stands at its beginning and at its end, so it stood at the
// start.
TEST(OrbitsCommand, WritesASceneThatStaysOnTheOrbitAndWhoseFilmLoops) {
    const Folder folder;
    folder.write("s.json", R"({"cam": {"speed": 12}, "beam": {"damping_ratio": 0.01}})");
    const Finished done =
        shell(folder,
              "$BEAMCAM orbits s.json --transient '100 s' -q --json --scene loop.json && $BEAMCAM check loop.json -q");
    ASSERT_EQ(done.code, 0) << done.err;
    const Reading reading = testing::read(testing::slurp((folder / "loop.json").string()));
    ASSERT_TRUE(reading.scene) << reading.report();
    const Scene& scene = *reading.scene;
    ASSERT_EQ(scene.outputs.size(), 1u);
    const auto& film = std::get<PictureOutput>(scene.outputs.front());
    const double period = 3 * 2 * std::numbers::pi / 12;
    EXPECT_DOUBLE_EQ(scene.end_time, 2 * period);
    EXPECT_DOUBLE_EQ(film.span.from, period);
    EXPECT_DOUBLE_EQ(film.span.to.value(), 2 * period);

    sim::Request request;
    std::vector<sim::Channel> channels;
    for (const char* name : {"theta", "theta_dot", "q1", "q2", "tip_rate"})
        channels.push_back(sim::channel_named(name).value());
    request.tables.push_back({{0, period, 2 * period}, channels});
    const sim::Result motion = sim::simulate(scene.problem, request);
    for (const std::vector<double>& values : motion.tables.front().values)
        for (const double later : {values[1], values[2]}) EXPECT_NEAR(later, values[0], 1e-6);
    EXPECT_EQ(motion.impacts.size(), 2 * nlohmann::json::parse(done.out)["orbits"][0]["impacts"].size());

    const FilmTimes times = film_times(film.span, scene.end_time, motion, motion.impacts);
    ASSERT_EQ(times.frames.size(), 180u);  // three seconds
    EXPECT_NEAR(times.frames.front(), period, 1e-12);
    EXPECT_NEAR(times.frames.back() + period / 180, 2 * period, 1e-12);
}

TEST(OrbitsCommand, ReportsThatABeamThatNeverLeavesTheCamHasNoFlightToBeginIn) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done = shell(folder, "$BEAMCAM orbits s.json --set cam.speed=5 --scene loop.json");
    EXPECT_EQ(done.code, 4) << done.err;  // the requested scene was not written
    EXPECT_THAT(done.err, HasSubstr("never leaves the cam"));
    EXPECT_FALSE(std::filesystem::exists(folder / "loop.json"));
}

// The branch of a beam that follows the cam has no impacts to draw, and contact removes every difference.
TEST(OrbitsCommand, APictureThatCannotBeDrawnDoesNotPreventTheOtherFiles) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const auto made = [&](const std::string& command, const std::string& data) {
        const Finished done =
            shell(folder, fmt::format("$BEAMCAM {} -o none.png -o {} -o none.pdf --set cam.speed=5 --transient '5 s'",
                                      command, data));
        EXPECT_EQ(done.code, 3) << done.err;
        for (const char* file : {"none.png", "none.pdf"})
            EXPECT_THAT(done.err, ::testing::ContainsRegex(fmt::format("{} is not written: .*nothing to draw", file)));
        EXPECT_TRUE(std::filesystem::exists(folder / data)) << done.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "none.png"));
        return done.out;
    };
    EXPECT_THAT(made("orbits s.json --over cam.speed=4:6", "b.json"), HasSubstr("always touching"));
    made("lyapunov s.json --duration '2 s'", "l.json");
}

TEST(OrbitsCommand, PrintsTheKeyInTheUnitOfItsRange) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const auto printed = [&](const std::string& over) {
        return shell(folder, "$BEAMCAM orbits s.json --impacts 1 --transient 0 -q --over " + over).out;
    };
    EXPECT_THAT(printed("'cam.speed=430 rpm:450 rpm'"), HasSubstr("cam.speed from 430 to 450 rpm\n"));
    EXPECT_THAT(printed("cam.speed=44:46"), HasSubstr("cam.speed from 44 to 46 rad/s\n"));
    EXPECT_THAT(printed("contact.restitution=0.5:0.52"), HasSubstr("contact.restitution from 0.5 to 0.52\n"));
    EXPECT_THAT(printed("cam.speed=44:52"), ::testing::ContainsRegex("period-doubling  cam.speed = .* rad/s\n"));
}

TEST(OrbitsCommand, ReportsWhatItCannotDo) {
    const Folder folder;
    folder.write("s.json", kPressed);
    EXPECT_EQ(shell(folder, "$BEAMCAM orbits s.json -o b.pdf").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM orbits s.json --over cam.speed").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM orbits s.json --scene -").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM orbits s.json --over cam.sped=1:2").code, 3);
    EXPECT_THAT(shell(folder, "$BEAMCAM orbits s.json --set beam.model=first-order --over beam.modes=1:3").err,
                HasSubstr("whole numbers"));
    EXPECT_THAT(shell(folder, "$BEAMCAM orbits s.json --over cam.speed=1e-9:1e9").err, HasSubstr("narrow it"));
    EXPECT_THAT(shell(folder, "$BEAMCAM orbits s.json --set cam.speed=0").err, HasSubstr("cam.speed"));
    for (const char* command :
         {"lyapunov s.json -o nowhere/l.svg", "orbits s.json -o nowhere/o.json"})  // before any work
        EXPECT_EQ(shell(folder, std::string("$BEAMCAM ") + command + " --set cam.speed=0").code, 6);
}

TEST(LyapunovCommand, PrintsTheSpectrumAndDrawsItsConvergence) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const std::string command = "$BEAMCAM lyapunov s.json -q --transient '1 s' --duration '5 s' ";
    const Finished json = shell(folder, command + "--set contact.restitution=0.9 --json -o l.svg");
    ASSERT_EQ(json.code, 0) << json.err;
    const nlohmann::json found = nlohmann::json::parse(json.out);
    EXPECT_EQ(found["exponents"].size(), 2u);
    EXPECT_EQ(found["exponents"][0]["history"].size(), found["history_time"].size());
    EXPECT_NEAR(found["sum"],
                found["exponents"][0]["value"].get<double>() + found["exponents"][1]["value"].get<double>(), 1e-12);
    EXPECT_EQ(found["time"], 5);
    EXPECT_TRUE(found["chaotic"].is_boolean());
    EXPECT_GE(found["doubt"], 0);
    EXPECT_THAT(testing::slurp((folder / "l.svg").string()), HasSubstr("<svg"));
    EXPECT_THAT(shell(folder, command + "--count 1").out, HasSubstr("Lyapunov exponents over 5 s after 1 s"));
    EXPECT_THAT(shell(folder, "$BEAMCAM lyapunov s.json -q --transient '7.5 turns' --duration 1").out,
                HasSubstr("after 1.0472 s"));  // at 45 rad/s
    EXPECT_THAT(shell(folder, "$BEAMCAM lyapunov s.json -q --transient 7.5 --duration 1").out,
                HasSubstr("after 1.0472 s"));
}

TEST(LyapunovCommand, NamesTheReasonWhyItShowsNoChaos) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const auto said = [&](const std::string& options) {
        return shell(folder, "$BEAMCAM lyapunov s.json -q --duration '5 s' " + options).out;
    };
    EXPECT_THAT(said("--set initial.angle=1.5 --set hub.drive='{\"type\": \"free\"}' --set gravity=0"),
                HasSubstr("no chaos is shown: there were no impacts\n"));
    EXPECT_THAT(said("--transient '20 s'"), HasSubstr("no chaos is shown: the largest exponent is not positive"));
}

// Rest on the cam removes every difference.
TEST(LyapunovCommand, AnExponentOfMinusInfinityIsNullInJson) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done =
        shell(folder, "$BEAMCAM lyapunov s.json -q --transient '10 s' --duration '2 s' --json --set cam.speed=5");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_TRUE(nlohmann::json::parse(done.out)["exponents"][0]["value"].is_null());
    EXPECT_THAT(shell(folder, "$BEAMCAM lyapunov --help").out, HasSubstr("of −∞ is null"));
}

TEST(OrbitsCommand, RejectsOptionsThatWouldDoNothing) {
    const Folder folder;
    folder.write("s.json", kPressed);
    for (const char* options : {"--at 50", "--doublings 3", "--over cam.speed=40:60:3"})
        EXPECT_EQ(shell(folder, std::string("$BEAMCAM orbits s.json ") + options).code, 2) << options;
}

TEST(OrbitsCommand, PrintsItsJsonOnce) {
    const Folder folder;
    folder.write("s.json", kPressed);
    const Finished done = shell(folder, "$BEAMCAM orbits s.json --json -o - --impacts 1 --transient 0");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_TRUE(nlohmann::json::accept(done.out));
}

}  // namespace
}  // namespace beamcam::scenes
