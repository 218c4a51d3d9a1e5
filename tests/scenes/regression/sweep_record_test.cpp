// Sweeps as entries of baselines: classes, periods and the samples of orbits.
#include "scenes/regression/records.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes/regression/guarded.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr;
using testing::Finished, testing::Folder, testing::shell, testing::slurp;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
enum Kind { kRest, kFollowing, kPeriodic, kChaotic, kAperiodic, kOverTheTop, kUnsettled };

// A sweep over "a" as it is written: v is the column of its samples.
struct Table : output::ColumnTable {
    Table() {
        for (const char* name :
             {"a", "seed", "class", "period", "impacts_per_period", "exponent", "exponent_error", "sample", "t", "v"})
            columns.push_back({name});
    }
    void point(double a, Kind kind, double period, double exponent, double error,
               const std::vector<std::pair<double, double>>& samples) {
        const auto row = [&](double number, double t, double v) {
            const double values[] = {a, 0, double(kind), period, 1, exponent, error, number, t, v};
            for (std::size_t c = 0; c < columns.size(); ++c) columns[c].values.push_back(values[c]);
        };
        for (std::size_t i = 0; i < samples.size(); ++i) row(double(i), samples[i].first, samples[i].second);
        if (samples.empty()) row(kNone, kNone, kNone);
    }
};

MotionVerdict judge(const Table& expected, const Table& actual) {
    return compare_sweeps(expected, actual, {0, 0.0, {}, 2e-5, 1e-4});
}
MotionVerdict judge_points(Kind was, const std::vector<std::pair<double, double>>& before, Kind is,
                           const std::vector<std::pair<double, double>>& after, double exponent = 0.69) {
    Table a, b;
    a.point(1, was, 1, 0.69, 0.01, before);
    b.point(1, is, 1, exponent, 0.01, after);
    return judge(a, b);
}

TEST(SweepRecord, AnOrbitIsTheSameWhereverInItsPeriodTheSamplesBegin) {
    const std::vector<std::pair<double, double>> orbit{{0, 1}, {1, 2}, {2, 1}, {3, 2}}, later{{1, 2}, {2, 1}, {3, 2}};
    EXPECT_EQ(judge_points(kPeriodic, orbit, kPeriodic, orbit).verdict, Verdict::identical);
    EXPECT_EQ(judge_points(kPeriodic, orbit, kPeriodic, later).verdict, Verdict::equivalent);
    for (const auto& [moved, verdict] : {std::pair(3e-5, Verdict::equivalent), {5e-5, Verdict::different}})
        EXPECT_EQ(judge_points(kPeriodic, orbit, kPeriodic, {{0, 1 + moved}, {1, 2}, {2, 1 + moved}, {3, 2}}).verdict,
                  verdict);
    const MotionVerdict lost = judge_points(kPeriodic, orbit, kPeriodic, {{0, 1}, {1, 1}, {2, 1}, {3, 1}});
    EXPECT_EQ(lost.verdict, Verdict::different);
    EXPECT_THAT(lost.lines, ElementsAre(HasSubstr("a = 1, seed 0: v moved by 0.5 of its largest value")));
}

// At rest rates vary by errors of the solver alone.
TEST(SweepRecord, AtRestTheAngleAloneIsCompared) {
    for (const auto& [column, verdict] : {std::pair("theta_dot", Verdict::equivalent), {"theta", Verdict::different}}) {
        Table a, b;
        a.point(1, kRest, 1, kNone, kNone, {{0, 1e-7}});
        b.point(1, kRest, 1, kNone, kNone, {{0, 2e-7}});
        for (Table* table : {&a, &b}) table->columns.back().name = column;
        EXPECT_EQ(judge(a, b).verdict, verdict) << column;
    }
}

TEST(SweepRecord, MotionsWithoutPeriodAreComparedByTheirClass) {
    EXPECT_EQ(judge_points(kAperiodic, {{0, 1}, {1, 2}}, kChaotic, {{0, 5}, {1, 9}}).verdict, Verdict::equivalent);
    EXPECT_THAT(judge_points(kPeriodic, {{0, 1}}, kAperiodic, {{0, 1}}).lines,
                ElementsAre("a = 1, seed 0: periodic became aperiodic"));
    EXPECT_EQ(judge_points(kAperiodic, {{0, 1}}, kOverTheTop, {}).verdict, Verdict::different);
    EXPECT_EQ(judge_points(kUnsettled, {}, kAperiodic, {{0, 1}}).verdict, Verdict::identical);  // not judged
}

TEST(SweepRecord, OtherValuesAndDamageAreReported) {
    Table a, b;
    a.point(1, kPeriodic, 1, kNone, kNone, {{0, 1}});
    b.point(2, kPeriodic, 1, kNone, kNone, {{0, 1}});
    EXPECT_THAT(judge(a, b).lines, ElementsAre("it is another sweep: a = 2, seed 0 is where a = 1, seed 0 was"));
    EXPECT_THAT(judge(a, Table()).lines, ElementsAre(HasSubstr("0 points of 1 column, expected 1 of 1")));
    for (const double kind : {-1.0, 7.0, kNone}) {
        b.columns[2].values[0] = kind;
        EXPECT_THROW(judge(a, b), output::IoError) << kind;
    }
    b.columns[7].name = "sample?";
    EXPECT_THROW(judge(a, b), output::IoError);
}

// ---- entries ------------------------------------------------------------------------------------------

// Three motions without period and some that follow a slow cam or have a period.
constexpr const char* kSweep = R"({"entries": {
  "chaos": {"scene": {"beam": {"model": "rigid"}, "cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5},
      "contact": {"model": "restitution", "law": "newton", "restitution": 0.8},
      "sweep": {"over": [{"key": "cam.speed", "from": 63, "to": 64, "count": 3}], "sample": "impacts",
                "transient": {"cam_turns": 100}, "keep": {"cam_turns": 500}}}, "output": {"type": "sweep"}},
  "orbits": {"scene": {"beam": {"model": "rigid"}, "cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5},
      "contact": {"model": "restitution", "law": "newton", "restitution": 0.5},
      "sweep": {"over": [{"key": "cam.speed", "from": 38, "to": 49, "count": 12}], "sample": "impacts",
                "transient": {"cam_turns": 100}, "keep": {"cam_turns": 30}}}, "output": {"type": "sweep"}}}})";

struct Swept : Folder {
    Swept() {
        write("b.json", kSweep);
        updated = shell(*this, "$BEAMCAM test b.json --update all");
    }
    Finished test_with(const std::string& from, const std::string& to, const std::string& options = "") const {
        return shell(
            *this, "sed 's/" + from + "/" + to +
                       "/; s/\"entries\"/\"references\": \"b\", \"entries\"/' b.json > c.json; $BEAMCAM test c.json " +
                       options);
    }
    Finished updated;
};

TEST(SweepEntries, AreKeptAsSweepWritesThemAndCompared) {
    const Swept folder;
    EXPECT_EQ(folder.updated.code, 7) << folder.updated.err;
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --strict -j1").code, 0);
    const Finished displaced = folder.test_with("\"angle\": 0.5", "\"angle\": 0.5000001");
    EXPECT_EQ(displaced.code, 0) << displaced.out;
    EXPECT_THAT(displaced.out, HasSubstr("equivalent  chaos"));
    EXPECT_EQ(folder.test_with("\"angle\": 0.5", "\"angle\": 0.5000001", "--strict --filter chaos").code, 7);
}

TEST(SweepEntries, ChangedMechanicsFail) {
    const Swept folder;
    const Finished bounces = folder.test_with("\"restitution\": 0.[58]", "\"restitution\": 0.4");
    EXPECT_EQ(bounces.code, 7);
    EXPECT_THAT(bounces.out, AllOf(HasSubstr("different   chaos"), HasSubstr("different   orbits")));
    const Finished orbit = folder.test_with("\"restitution\": 0.5", "\"restitution\": 0.501", "--only orbits");
    EXPECT_EQ(orbit.code, 7);
    const Finished other = folder.test_with("\"count\": 12", "\"count\": 11", "--only orbits");
    EXPECT_THAT(other.out, HasSubstr("it is another sweep"));
}

// A flexible beam, and a rigid one in compliant contact.
TEST(SweepEntries, AnErrorOfTheSolverIsNoMotion) {
    const Folder folder;
    const std::string text = R"({"references": "b", "entries": {
  "flexible": {"scene": {"cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5},
      "beam": {"modes": 1, "damping_ratio": 0.02}, "contact": {"model": "restitution", "law": "newton", "restitution": 0.5},
      "sweep": {"over": [{"key": "cam.speed", "values": [40, 50]}], "transient": {"cam_turns": 40}, "keep": {"cam_turns": 40}}},
    "output": {"type": "sweep"}},
  "compliant": {"scene": {"cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5}, "beam": {"model": "rigid"},
      "sweep": {"over": [{"key": "cam.speed", "values": [30, 60]}], "sample": {"section": "cam_angle", "at": 0},
                "transient": {"cam_turns": 60}, "keep": {"cam_turns": 40}}}, "output": {"type": "sweep"}}}})";
    folder.write("b.json", text);
    ASSERT_EQ(shell(folder, "$BEAMCAM test b.json --update all").code, 7);
    for (const char* solver : {R"("rtol": 1e-9)", R"("method": "rk8")"}) {
        shell(folder, std::string("sed 's/{\"cam\"/{\"solver\": {") + solver + "}, \"cam\"/' b.json > c.json");
        const Finished finished = shell(folder, "$BEAMCAM test c.json");
        EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
        EXPECT_THAT(finished.out, AllOf(HasSubstr("equivalent  flexible"), HasSubstr("equivalent  compliant")));
    }
    const Finished other = shell(
        folder, "export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable; $BEAMCAM test b.json");
    EXPECT_EQ(other.code, 0) << other.out;
}

TEST(SweepEntries, NeedASweepThatCanBeMade) {
    const Folder folder;
    folder.write("b.json", R"({"entries": {
  "none": {"scene": {}, "output": {"type": "sweep"}},
  "more": {"scene": {}, "output": {"type": "sweep", "file": "x.npz"}},
  "fine": {"scene": {"time": {"end": 0.1}}, "output": {"type": "trajectory", "rate": 10, "channels": ["theta"]}},
  "short": {"scene": {"beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.8},
      "cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5},
      "sweep": {"over": [{"key": "cam.speed", "values": [62]}], "transient": {"cam_turns": 0}, "keep": {"cam_turns": 1}}},
    "output": {"type": "sweep"}}}})");
    const Finished finished = shell(folder, "$BEAMCAM test b.json --update all");
    EXPECT_EQ(finished.code, 3) << finished.out;
    EXPECT_THAT(finished.err, AllOf(HasSubstr("entries.none.output: the scene has no \"sweep\""),
                                    HasSubstr("entries.more.output: the \"sweep\" of the scene describes")));
    EXPECT_THAT(finished.out, HasSubstr("1 of 1 points are not compared"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --filter fine --strict").code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "b/short"));
}

}  // namespace
}  // namespace beamcam::scenes
