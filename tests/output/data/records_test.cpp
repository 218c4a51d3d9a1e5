#include "output/data/records.hpp"

#include <cmath>
#include <numbers>

#include "output/files/atomic_file.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

sim::Result one_collision() {
    sim::Result result;
    result.end_time = 1.5;
    sim::Impact closed;
    closed.t_start = 0.25, closed.t_end = 0.375, closed.duration = 0.125, closed.x = 0.1;
    closed.v_n_before = -2, closed.v_n_after = 1.4, closed.v_t_after = 0.0, closed.restitution = 0.7;
    sim::Impact open;
    open.t_start = 1.25;
    closed.collision = 1, open.collision = 2;
    result.impacts = {closed, open};
    result.collisions = {sim::Collision{0.25, 0.375, 1, 0.1, -2, 1.4, 0.7, 0, 0}, sim::Collision{}};
    result.theta_zero = {{0.369993889, -5.5}};
    result.counters.steps = 44000;
    result.counters.rhs_evaluations = 90000;
    return result;
}

TEST(ImpactsJson, HasTheNamesInTheirOrderAndNullWhereUndefined) {
    const std::string json = impacts_json(one_collision());
    EXPECT_NE(json.find(R"({
      "t_start": 1.25,
      "t_end": null,
      "x": 0.0,
      "cam_angle": 0.0,
      "v_n_before": 0.0,
      "v_t_before": 0.0,
      "v_n_after": null,
      "v_t_after": null,
      "duration": null,
      "force_peak": null,
      "penetration_peak": 0.0,
      "impulse_n": 0.0,
      "impulse_t": 0.0,
      "restitution": null,
      "energy_lost": 0.0,
      "collision": 2
    })"),
              std::string::npos)
        << json;
    EXPECT_NE(json.find(R"({
      "t_start": 0.25,
      "t_end": 0.375,
      "count": 1,
      "x": 0.1,
      "v_n_before": -2.0,
      "v_n_after": 1.4,
      "restitution": 0.7,
      "force_peak": 0.0,
      "energy_lost": 0.0
    })"),
              std::string::npos)
        << json;
}

TEST(ImpactsJson, NumbersReadBackToTheSameBits) {
    sim::Result result;
    result.impacts.resize(1);
    result.impacts[0].t_start = 0.1 + 0.2;
    EXPECT_NE(impacts_json(result).find("0.30000000000000004"), std::string::npos);
}

TEST(ImpactsJson, ARunWithoutImpactsHasEmptyLists) {
    EXPECT_EQ(impacts_json({}), "{\n  \"impacts\": [],\n  \"collisions\": []\n}\n");
}

TEST(ImpactsCsv, HasTheSameNamesAndEmptyCells) {
    Scratch scratch;
    write_impacts(scratch / "i.csv", one_collision());
    EXPECT_EQ(
        read_file(scratch / "i.csv"),
        "t_start,t_end,x,cam_angle,v_n_before,v_t_before,v_n_after,v_t_after,duration,force_peak,penetration_peak,"
        "impulse_n,impulse_t,restitution,energy_lost,collision\n"
        "0.25,0.375,0.10000000000000001,0,-2,0,1.3999999999999999,0,0.125,,0,0,0,0.69999999999999996,0,1\n"
        "1.25,,0,0,0,0,,,,,0,0,0,,0,2\n");
}

TEST(Impacts, AreWrittenByTheirEnding) {
    Scratch scratch;
    write_impacts(scratch / "i.json", one_collision());
    EXPECT_EQ(read_file(scratch / "i.json"), impacts_json(one_collision()));
    EXPECT_THROW(write_impacts(scratch / "i.txt", one_collision()), UnsupportedOption);
}

const std::vector<ChannelExtremum> kTheta = {{{sim::ChannelKind::theta}, {-1, 0.5, 2, 1}}};

TEST(Summary, HasEveryNameInItsOrder) {
    sim::Result result = one_collision();
    result.warnings = {"the cam never reaches the beam"};
    result.steps_by_method = {{sim::Method::automatic, 40000}, {sim::Method::rk8, 4000}};
    result.reproducible_until = 3.25;
    result.not_reproducible = {{3.25, 8.5}, {9, {}}};
    result.reproducible_again_from = 9.5;
    result.compared_with = "rk8 at rtol 1e-10";
    result.reproducibility = "not all along";
    const std::string printed = [&] {
        Scratch scratch;
        write_file(scratch / "s.json", summary_json({}, result, kTheta));
        return output_of(
            "/usr/bin/python3 -c 'import json, sys\n"
            "s = json.load(open(sys.argv[1]))\n"
            "print(s.pop(\"units\"))\n"
            "print(s)' " +
            (scratch / "s.json").string());
    }();
    EXPECT_EQ(printed,
              "{'t': 's', 'theta': 'rad'}\n"
              "{'model': 'first-order', 'modes': 2, 'end_time': 1.5, 'steps': 44000, "
              "'steps_by_method': {'auto': 40000, 'rk8': 4000}, 'rhs_evaluations': 90000, "
              "'wall_seconds': 0.0, 'events': {'theta_zero': [{'t': 0.369993889, 'theta_dot': -5.5}]}, 'extrema': "
              "{'theta': {'min': -1.0, 't_min': 0.5, 'max': 2.0, 't_max': 1.0}}, 'energy_residual_max': 0.0, "
              "'energy_scale': 0.0, 'impacts': 2, 'collisions': 2, 'reproducible_until': 3.25, 'not_reproducible': "
              "[[3.25, 8.5], [9.0, None]], 'reproducible_again_from': 9.5, 'compared_with': 'rk8 at rtol 1e-10', "
              "'reproducibility': 'not all along', 'warnings': "
              "['the cam never reaches the beam']}\n");
}

TEST(Summary, LeavesTheHorizonOutUnlessAsked) {
    EXPECT_EQ(summary_json({}, one_collision(), kTheta).find("reproducible_until"), std::string::npos);
}

TEST(Summary, ARigidBeamHasNoModes) {
    sim::Problem problem;
    problem.beam.model = sim::ModelKind::rigid;
    EXPECT_NE(summary_json(problem, one_collision(), kTheta).find("\"modes\": 0"), std::string::npos);
}

// The cam turns once a second.
TEST(Summary, TellsWhereOnTheCamTheBeamIsApartInTheLastTurn) {
    sim::Problem problem;
    problem.cam->profile = sim::ArcsProfile{{{{0.01, 0}, 0.08}}};
    problem.cam->speed = 2 * std::numbers::pi;
    sim::Result result;
    result.end_time = 3;
    for (const auto& [from, to] : {std::pair(0.2, 0.3), std::pair(1.9, 2.125), std::pair(2.5, 2.625)}) {
        sim::Impact& impact = result.impacts.emplace_back();
        impact.t_start = from;
        impact.t_end = to;
    }
    const std::vector<ChannelExtremum> force{{{sim::ChannelKind::contact_force}, {0, 0, 9, 1.25}}};
    const std::string json = summary_json(problem, result, force);
    const auto number_after = [&](std::size_t place, const char* key) {
        return std::stod(json.substr(json.find(':', json.find(key, place)) + 1));
    };
    const std::size_t first = json.find("apart_in_last_turn"), second = json.find('}', first);
    EXPECT_NEAR(number_after(0, "phi_of_largest_force"), std::numbers::pi / 2, 1e-12);
    EXPECT_NEAR(number_after(first, "\"from\""), 2.125, 1e-12);
    EXPECT_NEAR(number_after(first, "\"to\""), 2.5, 1e-12);
    EXPECT_NEAR(number_after(first, "phi_to"), std::numbers::pi, 1e-9);
    EXPECT_NEAR(number_after(second, "\"from\""), 2.625, 1e-12);
    EXPECT_NEAR(number_after(second, "\"to\""), 3, 1e-12);
}

TEST(Summary, UndefinedNumbersAreNull) {
    const std::vector<ChannelExtremum> undefined{{{sim::ChannelKind::theta}, {std::nan(""), 0.5, 2, 1}}};
    EXPECT_NE(summary_json({}, one_collision(), undefined).find("\"min\": null"), std::string::npos);
}

}  // namespace
}  // namespace beamcam::output
