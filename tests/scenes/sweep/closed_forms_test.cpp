// Sweeps of the program whose answers are known beforehand: folds and period doublings within a step of the sweep,
// motions with and without a period.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "sim/problem/problem.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;

struct PointClass {
    std::string name, period, impacts;
    double exponent = 0;
    bool is_one_to_one() const { return name == "periodic" && period == "1" && impacts == "1"; }
    bool is_doubled() const { return name == "periodic" && period == "2" && impacts == "2"; }
};

// The class at each value of the swept key.
std::map<double, PointClass> classes(const std::string& scene, const std::string& options = "") {
    const Folder folder;
    folder.write("s.json", scene);
    const Finished done = shell(folder, "$BEAMCAM sweep s.json -q --sample section:cam_angle=0 " + options);
    EXPECT_EQ(done.code, 0) << done.err;
    std::map<double, PointClass> found;
    std::istringstream lines(done.out);
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);) {
        std::vector<std::string> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
        found[std::stod(cells.at(0))] = {cells[2], cells[3], cells[4], cells[5].empty() ? NAN : std::stod(cells[5])};
    }
    return found;
}

// A rigid beam under a steady pull α that starts on its orbit with one impact a turn: between impacts it flies as a
// parabola, so it leaves with the rate αT/2 and meets the cam where θ̇_c = (αT/2)(1 − r)/(1 + r) and θ̈_c < 0.
struct OnOrbit {
    double angle, rate, phase;
};
OnOrbit on_orbit(double speed, double alpha, double r, double distance, double radius, double eccentricity) {
    const double turn = 2 * std::numbers::pi / speed, half = 0.5 * alpha * turn;
    const auto surface = [&](double t) {
        const double x = distance + eccentricity * std::cos(speed * t), y = -eccentricity * std::sin(speed * t);
        return std::atan2(y, x) + std::asin(radius / std::hypot(x, y));
    };
    const double h = 1e-5 * turn;
    const auto above = [&](double t) { return (surface(t + h) - surface(t - h)) / (2 * h) - half * (1 - r) / (1 + r); };
    constexpr int kSteps = 100'000;
    for (int i = 0; i < kSteps; ++i) {
        const double t = turn * i / kSteps;
        if (above(t) > 0 && above(t + turn / kSteps) <= 0) return {surface(t) + 1e-8, half, -speed * t};
    }
    throw std::logic_error("no such orbit");
}

std::string pressed(double from, double to, int count, const char* seed) {
    constexpr double kAlpha = 15;
    const double inertia = sim::Problem().beam.line_density() / 3;
    const OnOrbit start = on_orbit(46, kAlpha, 0.5, 0.25, 0.1, 0.002);
    return fmt::format(
        R"({{"beam": {{"model": "rigid"}}, "gravity": 0, "hub": {{"drive": {{"type": "torque", "value": {:.17g}}}}},
            "contact": {{"model": "restitution", "restitution": 0.5}},
            "cam": {{"eccentricity": "2 mm", "phase": {:.17g}, "speed": 46}},
            "initial": {{"angle": {:.17g}, "angular_velocity": {:.17g}}},
            "sweep": {{"over": [{{"key": "cam.speed", "from": {}, "to": {}, "count": {}}}], "seed": "{}",
                       "transient": {{"cam_turns": 6000}}, "keep": {{"cam_turns": 60}}}}}})",
        -kAlpha * inertia, start.phase, start.angle, start.rate, from, to, count, seed);
}

TEST(SweepClosedForms, PressedBeamFoldsWithinAStepOfTheClosedForm) {
    constexpr double kFold = 42.23567502238, kStep = 0.04;
    const auto found = classes(pressed(42, 46, 101, "carry-down"));
    ASSERT_EQ(found.size(), 101u);
    for (const auto& [speed, point] : found)
        EXPECT_EQ(point.is_one_to_one(), speed > kFold) << speed << " " << point.name << " " << point.period;
    EXPECT_FALSE(found.lower_bound(kFold - kStep)->second.is_one_to_one());
    EXPECT_TRUE(found.lower_bound(kFold)->second.is_one_to_one());
}

TEST(SweepClosedForms, PressedBeamDoublesWithinAStepOfTheClosedForm) {
    constexpr double kDoubling = 50.86884987331;
    const auto found = classes(pressed(46, 51.2, 131, "carry-up"));
    ASSERT_EQ(found.size(), 131u);
    for (const auto& [speed, point] : found) {
        EXPECT_EQ(point.is_one_to_one(), speed < kDoubling) << speed << " " << point.name << " " << point.period;
        EXPECT_EQ(point.is_doubled(), speed > kDoubling) << speed << " " << point.name << " " << point.period;
    }
}

// Far from a small cam the beam is a ball on a table of amplitude e under a = kℓ cos θ, k = 3g/2L; Γ = eω²/a. The end
// is that of one turn a flight, r = 0.5.
std::string ball(double from, double to, int count, const char* seed) {
    constexpr double kEccentricity = 1e-6, kRadius = 1e-3, kDistance = 0.25;
    const double fall = 1.5 * 9.81 * std::cos(std::asin(kRadius / kDistance));
    const double lever = std::sqrt(kDistance * kDistance - kRadius * kRadius);
    const auto speed = [&](double gamma) { return std::sqrt(gamma * fall * lever / kEccentricity); };
    const OnOrbit start = on_orbit(speed(1.3), fall, 0.5, kDistance, kRadius, kEccentricity);
    return fmt::format(
        R"({{"beam": {{"model": "rigid"}}, "contact": {{"model": "restitution", "restitution": 0.5}},
            "cam": {{"centre": [{}, 0], "radius": {}, "eccentricity": {}, "phase": {:.17g}, "speed": 1}},
            "initial": {{"angle": {:.17g}, "angular_velocity": {:.17g}}},
            "sweep": {{"over": [{{"key": "cam.speed", "from": {:.17g}, "to": {:.17g}, "count": {}}}], "seed": "{}",
                       "transient": {{"cam_turns": 6000}}, "keep": {{"cam_turns": 60}}}}}})",
        kDistance, kRadius, kEccentricity, start.phase, start.angle, start.rate, speed(from), speed(to), count, seed);
}

TEST(SweepClosedForms, SmallCamIsABouncingBall) {
    // Γ_SN = π(1 − r)/(1 + r), Γ_PD² = Γ_SN² + [2(1 + r²)/(1 + r)²]²; 64 steps of 0.4 % in ω.
    const double r = 0.5, fold = std::numbers::pi * (1 - r) / (1 + r);
    const double doubling = std::hypot(fold, 2 * (1 + r * r) / ((1 + r) * (1 + r)));
    EXPECT_NEAR(fold, 1.0471975512, 1e-10);
    EXPECT_NEAR(doubling, 1.5268237005, 1e-10);
    // From Γ = 1 on the disc lifts the beam, which first lands with 8/3 s³eω, s² = 2(Γ − 1), to the lowest order of s.
    // Up to here its rebound is slower than a thousandth of the approach floor, which ends the chatter: one impact a
    // turn.
    const double slow = std::cbrt(1e-6 / (r * 8 / 3 * std::sqrt(1.5 * 9.81 * 0.25 * 1e-6))),
                 lifted = 1 + slow * slow / 2;
    EXPECT_NEAR(lifted, 1.0026, 1e-4);
    const auto down = classes(ball(1.3, 1.001, 65, "carry-up")), up = classes(ball(1.3, 1.56, 65, "carry-up"));
    const auto gamma = [](double speed) {
        const double fall = 1.5 * 9.81 * std::cos(std::asin(0.004)), lever = std::sqrt(0.0625 - 1e-6);
        return 1e-6 * speed * speed / (fall * lever);
    };
    for (const auto& [speed, point] : down)
        EXPECT_EQ(point.is_one_to_one(), gamma(speed) > fold || gamma(speed) < lifted)
            << gamma(speed) << " " << point.name << point.period;
    for (const auto& [speed, point] : up) {
        EXPECT_EQ(point.is_one_to_one(), gamma(speed) < doubling) << gamma(speed) << " " << point.name << point.period;
        EXPECT_EQ(point.is_doubled(), gamma(speed) > doubling) << gamma(speed) << " " << point.name << point.period;
    }
}

// A beam that loses nothing on a disc that turns about its own centre bounces with a period T_b of its own: n turns of
// the cam are m impacts where n T = m T_b, and no turns are where T/T_b is irrational.
std::string elastic(const std::string& speeds) {
    return R"({"beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 1},
               "cam": {"eccentricity": 0, "speed": 10}, "initial": {"angle": 0.55},
               "sweep": {"over": [{"key": "cam.speed", "values": [)" +
           speeds + R"(]}], "transient": {"cam_turns": 200}, "keep": {"cam_turns": 120}}})";
}

TEST(SweepClosedForms, ElasticBeamOnARoundDiscIsPeriodicOrOnATorus) {
    const Folder folder;
    folder.write("s.json", elastic("10"));
    const Finished impacts =
        shell(folder, "$BEAMCAM sweep s.json -q --transient 0 --keep 30 | cut -d, -f9 | tail -n +2");
    std::vector<double> times;
    std::istringstream lines(impacts.out);
    for (double t; lines >> t;) times.push_back(t);
    ASSERT_GT(times.size(), 50u);
    const double bounce = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    std::string speeds;
    const std::pair<int, int> locked[] = {{1, 1}, {3, 2}, {5, 3}, {7, 4}, {2, 5}};
    for (const auto& [turns, hits] : locked)
        speeds += fmt::format("{:.17g},", 2 * std::numbers::pi * turns / (hits * bounce));
    const double free[] = {(std::sqrt(5) - 1) / 2, std::sqrt(2), std::numbers::pi / 2, std::numbers::e};
    for (const double ratio : free) speeds += fmt::format("{:.17g},", 2 * std::numbers::pi * ratio / bounce);
    speeds.pop_back();
    const auto found = classes(elastic(speeds));
    for (const auto& [turns, hits] : locked) {
        const PointClass& point = found.lower_bound(2 * std::numbers::pi * turns / (hits * bounce) - 1e-9)->second;
        EXPECT_EQ(point.name, "periodic") << turns << " " << hits;
        EXPECT_EQ(point.period, std::to_string(turns));
        EXPECT_EQ(point.impacts, std::to_string(hits));
    }
    for (const double ratio : free)
        EXPECT_EQ(found.lower_bound(2 * std::numbers::pi * ratio / bounce - 1e-9)->second.name, "aperiodic") << ratio;
}

// θ once a turn at each value of the swept key.
std::map<double, std::vector<double>> sections(const std::string& scene, const std::string& options) {
    const Folder folder;
    folder.write("s.json", scene);
    const Finished done =
        shell(folder, "$BEAMCAM sweep s.json -q --sample section:cam_angle=0 " + options + " | cut -d, -f1,11");
    std::map<double, std::vector<double>> found;
    std::istringstream lines(done.out);
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);) {
        const std::size_t comma = line.find(',');
        found[std::stod(line.substr(0, comma))].push_back(std::stod(line.substr(comma + 1)));
    }
    return found;
}

bool repeats(const std::vector<double>& theta, std::size_t turns) {
    for (std::size_t i = 0; i + turns < theta.size(); ++i)
        if (!(std::fabs(theta[i] - theta[i + turns]) < 1e-7)) return false;
    return true;
}

// Above 50.5 rad/s this beam chatters to rest now and then, after hundreds of turns without a period; lasting contact
// brings it back to the same state, at 49.84, 50.52 or 51.68 rad/s only because of rounding. A period that is found in
// 120 turns must hold for the next thousand.
TEST(LongSweepClosedForms, PeriodsThatAreFoundLast) {
    const std::string scene = R"({
        "beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.5},
        "cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5},
        "sweep": {"over": [{"key": "cam.speed", "from": 48, "to": 56, "count": 201}], "keep": {"cam_turns": 120}}})";
    const auto late = sections(scene, "--transient 3000 --keep 1000");
    ASSERT_EQ(late.size(), 201u);
    for (const char* transient : {"20", "100", "500"}) {
        int periodic = 0, aperiodic = 0;
        for (const auto& [speed, point] : classes(scene, std::string("--transient ") + transient)) {
            const std::vector<double>& theta = late.at(speed);
            if (point.name == "periodic") {
                const auto turns = static_cast<std::size_t>(std::stoi(point.period));
                ++periodic;
                EXPECT_TRUE(repeats(theta, turns)) << transient << " " << speed << " " << turns;
            }
            if (point.name == "aperiodic") ++aperiodic;
        }
        EXPECT_GT(periodic, 135) << transient;  // longer periods than forty turns are not seen
        EXPECT_GT(aperiodic, 10) << transient;
    }
}

}  // namespace
}  // namespace beamcam::scenes
