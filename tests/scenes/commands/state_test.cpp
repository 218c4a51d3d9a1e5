// Scenes that continue a motion, and tables whose rows follow it, as scripts ask for them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not, ::testing::StartsWith;
using testing::Finished, testing::Folder, testing::shell;

// The numbers of the last row of a table.
std::vector<double> last_row(const std::string& csv) {
    std::vector<double> out;
    const std::size_t end = csv.rfind('\n', csv.size() - 2) + 1;
    std::istringstream line(csv.substr(end));
    for (std::string cell; std::getline(line, cell, ',');) out.push_back(std::stod(cell));
    return out;
}

TEST(State, ContinuesTheMotionInFlightAndInContact) {
    const Folder folder;
    folder.write("s.json", R"({"cam": {"speed": "30 rpm"}, "beam": {"modes": 3}, "time": {"end": 1},
        "contact": {"friction": {"type": "stick-slip", "coefficient": 0.3}}, "solver": {"rtol": 1e-10}})");
    const std::string table = "--trajectory - -q --channels theta,theta_dot,q1,q1_dot,cam_angle --times ";
    const nlohmann::json impacts =
        nlohmann::json::parse(shell(folder, "$BEAMCAM simulate s.json --impacts - -q").out)["impacts"];
    const double touch = impacts[0]["t_start"], release = impacts[0]["t_end"];
    for (const double at : {0.1, touch, 0.5 * (touch + release), release, release + 1e-3}) {
        const Finished state =
            shell(folder, fmt::format("$BEAMCAM simulate s.json -q --state-at {} -o n.json --force", at));
        ASSERT_EQ(state.code, 0) << state.err;
        ASSERT_EQ(shell(folder, "$BEAMCAM check n.json").code, 0) << shell(folder, "$BEAMCAM check n.json").err;
        const std::vector<double>
            whole = last_row(shell(folder, fmt::format("$BEAMCAM simulate s.json {} {}", table, at + 0.02)).out),
            next = last_row(shell(folder, "$BEAMCAM simulate n.json " + table + "0.02").out);
        ASSERT_EQ(whole.size(), 6u);
        ASSERT_EQ(next.size(), 6u);
        for (std::size_t c = 1; c < 6; ++c)
            EXPECT_NEAR(next[c], whole[c], 1e-7 * (1 + std::fabs(whole[c]))) << at << " " << c;
    }
}

TEST(State, IsAnOutputAndGoesToStandardOutput) {
    const Folder folder;
    folder.write("s.json", R"({"title": "A, B", "cam": {"speed": "60 deg/s"}, "time": {"end": 0.4},
        "outputs": [{"type": "state", "at": "100 ms"}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json -q").code, 0);
    const Finished printed = shell(folder, "$BEAMCAM simulate s.json -q --state-at 0.1");
    EXPECT_EQ(printed.out, testing::slurp(folder / "s-state.json"));
    const nlohmann::json state = nlohmann::json::parse(printed.out);
    EXPECT_NEAR(state["time"]["end"].get<double>(), 0.3, 1e-15);
    EXPECT_NEAR(state["cam"]["phase"].get<double>(), -0.1 * std::acos(-1) / 3, 1e-15);
    EXPECT_EQ(state["title"], "A, B");
    EXPECT_EQ(state["units"]["speed"], "deg/s");
    EXPECT_FALSE(state["initial"].contains("contact"));
}

TEST(State, OutputNeedsAnInstant) {
    const Folder folder;
    folder.write("s.json", "{}");
    const Finished refused = shell(folder, "$BEAMCAM simulate s.json -o n.json");
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("--state-at"));
}

TEST(AdaptiveTable, IsTheDefaultAndReachesThePeaks) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.5}, "outputs": [{"type": "trajectory", "file": "run.csv"}]})");
    const Finished made =
        shell(folder, "$BEAMCAM simulate s.json --trajectory a.csv --channels contact_force --summary s2.json");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(made.err, Not(HasSubstr("fall between the rows")));
    ASSERT_EQ(
        shell(folder, "$BEAMCAM simulate s.json --trajectory b.csv --channels contact_force --rate adaptive -q").code,
        0);
    EXPECT_EQ(testing::slurp(folder / "a.csv"), testing::slurp(folder / "b.csv"));
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json -q").code, 0);
    EXPECT_EQ(
        shell(folder,
              "/usr/bin/python3 -c \"import csv, json; peak = "
              "json.load(open('s2.json'))['extrema']['contact_force']['max']; "
              "rows = [max(float(r['contact_force']) for r in csv.DictReader(open(f))) for f in ('a.csv', 'run.csv')]; "
              "assert all(0.995 * peak < each <= peak * (1 + 1e-9) for each in rows), (rows, peak)\"")
            .code,
        0);
    EXPECT_EQ(shell(folder,
                    "$BEAMCAM simulate s.json --trajectory a.npz --channels contact_force -q && /usr/bin/python3 -c \""
                    "import numpy, csv; z = numpy.load('a.npz'); rows = list(csv.DictReader(open('a.csv'))); "
                    "assert [float(r['t']) for r in rows] == list(z['t']); assert (numpy.diff(z['t']) > 0).all()\"")
                  .code,
              0);
}

TEST(AdaptiveTable, AFixedRateThatMissesPeaksIsToldOnStderrAndInTheSummary) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 1.5}})");
    for (const char* file : {"t.csv", "t.npz"}) {
        const Finished made = shell(
            folder, fmt::format("$BEAMCAM simulate s.json --trajectory {} --rate 1000 --summary m.json --force", file));
        ASSERT_EQ(made.code, 0) << made.err;
        const auto told = AllOf(HasSubstr("fall between the rows"), HasSubstr("in truth"), HasSubstr("adaptive"));
        EXPECT_THAT(made.err, told);
        EXPECT_THAT(testing::slurp(folder / "m.json"), told);
    }
    EXPECT_THAT(shell(folder, "$BEAMCAM simulate s.json --trajectory u.csv --rate 1000 --channels theta").err,
                Not(HasSubstr("fall between")));
}

}  // namespace
}  // namespace beamcam::scenes
