// Requests do not change the motion; tables, ends and interruptions of runs.
#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/run/simulate.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

void expect_same_bits(const Result& a, const Result& b) {
    ASSERT_LE(a.impacts.size(), b.impacts.size());
    for (std::size_t i = 0; i < a.impacts.size(); ++i) {
        EXPECT_EQ(a.impacts[i].t_start, b.impacts[i].t_start);
        EXPECT_EQ(a.impacts[i].v_n_before, b.impacts[i].v_n_before);
        EXPECT_EQ(a.impacts[i].x, b.impacts[i].x);
        if (!a.impacts[i].t_end) continue;
        EXPECT_EQ(a.impacts[i].t_end, b.impacts[i].t_end);
        EXPECT_EQ(a.impacts[i].force_peak, b.impacts[i].force_peak);
        EXPECT_EQ(a.impacts[i].v_n_after, b.impacts[i].v_n_after);
        EXPECT_EQ(a.impacts[i].impulse_n, b.impacts[i].impulse_n);
        EXPECT_EQ(a.impacts[i].energy_lost, b.impacts[i].energy_lost);
    }
    for (std::size_t i = 0; i < std::min(a.apexes.size(), b.apexes.size()); ++i)
        EXPECT_EQ(a.apexes[i].t, b.apexes[i].t);
}

class EveryMethod : public ::testing::TestWithParam<Method> {};

TEST_P(EveryMethod, ObservingNeverDisturbs) {
    constexpr double kTwoFlights = 0.35;  // two flights and a collision
    Problem p;
    p.solver.method = GetParam();
    for (const Friction& friction : {Friction{NoFriction{}}, Friction{StickSlipFriction{0.3, 0.4, {}}}}) {
        p.contact.friction = friction;
        const Result plain = run(p, kTwoFlights);
        Request request;
        request.end_time = kTwoFlights;
        std::vector<double> times;
        for (int k = 0; k < 400; ++k) times.push_back(std::fmod(0.37 * k, kTwoFlights));
        request.tables.push_back({times, all_channels(p)});
        request.poses.push_back({times, 17});
        request.extrema = all_channels(p);
        const Result watched = simulate(p, request);
        EXPECT_EQ(plain.impacts.size(), watched.impacts.size());
        expect_same_bits(plain, watched);
        EXPECT_EQ(plain.counters.steps, watched.counters.steps);
        EXPECT_EQ(plain.energy_residual_max, watched.energy_residual_max);
    }
}

TEST_P(EveryMethod, TablesThatShareInstantsHoldWhatEachHoldsAlone) {
    Problem p;
    p.solver.method = GetParam();
    const std::vector<Channel> channels = all_channels(p);
    // Unordered, with one instant twice and some of the other request, also within the first collision.
    const TableRequest first{{0.31, 0.1, 0.2773, 0.2774, 0.1, 0.32, 0}, {channels.begin(), channels.begin() + 3}},
        second{{0, 0.05, 0.1, 0.2773, 0.29, 0.32}, channels};
    Request request;
    for (const TableRequest& alone : {first, second}) {
        request.tables = {first, second};
        const Result both = simulate(p, request);
        request.tables = {alone};
        const Result one = simulate(p, request);
        const Table &expected = one.tables[0], &shared = both.tables[alone.times.size() == first.times.size() ? 0 : 1];
        ASSERT_EQ(shared.channels, expected.channels);
        for (std::size_t c = 0; c < expected.values.size(); ++c)
            for (std::size_t row = 0; row < alone.times.size(); ++row)
                EXPECT_EQ(std::bit_cast<std::uint64_t>(shared.values[c][row]),
                          std::bit_cast<std::uint64_t>(expected.values[c][row]))
                    << c << " at " << alone.times[row];
    }
}

TEST_P(EveryMethod, AShorterRunIsAPrefixOfALongerOne) {
    Problem p;
    p.solver.method = GetParam();
    const Result longer = run(p, 0.8);
    const std::vector<double> times{0.1, 0.2771, 0.28, 0.285};
    for (double end : {0.1, 0.277, 0.2801, 0.285, 0.5}) {
        const Result shorter = run(p, end);
        EXPECT_EQ(shorter.end_time, end);
        expect_same_bits(shorter, longer);
    }
    Request request;
    request.tables.push_back({times, {channel("theta")}});
    const std::vector<double> early = simulate(p, request).tables[0].values[0];
    request.end_time = 0.8;
    EXPECT_EQ(simulate(p, request).tables[0].values[0], early);
}

TEST_P(EveryMethod, PosesInContactAreTheSameWhereverTheRunEnds) {
    Problem p;
    p.solver.method = GetParam();
    PoseRequest wanted;
    wanted.times = {0.27, 0.281};
    wanted.stations = 5;
    wanted.contacts = 12;
    Request request;
    request.poses = {wanted};
    const std::vector<Pose> early = simulate(p, request).poses[0];
    request.end_time = 0.8;
    const std::vector<Pose> late = simulate(p, request).poses[0];
    ASSERT_GT(early.size(), 5U);
    ASSERT_LE(early.size(), 14U);
    ASSERT_EQ(early.size(), late.size());
    for (std::size_t k = 0; k < early.size(); ++k) {
        EXPECT_EQ(early[k].t, late[k].t);
        EXPECT_EQ(early[k].theta, late[k].theta);
        EXPECT_EQ(early[k].nearest->force, late[k].nearest->force);
        EXPECT_EQ(early[k].nearest->touching, k >= 2 || early[k].nearest->force > 0);
        EXPECT_TRUE(early[k].t >= 0.27 && early[k].t <= 0.281);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, EveryMethod, ::testing::Values(Method::automatic, Method::cvode_adams, Method::cvode_bdf),
                         [](const auto& method) { return label(name(method.param)); });

TEST(Tables, KeepTheOrderOfTheirTimes) {
    const Problem p = fixed_cam(ModelKind::rigid);
    const std::vector<double> times{0.4, 0, 0.1, 0.4, 0.25};
    EXPECT_EQ(series(p, "t", times), times);
    const std::vector<double> theta = series(p, "theta", times);
    EXPECT_EQ(theta[0], theta[3]);
    EXPECT_EQ(theta[1], kQuarterTurn);
    EXPECT_GT(theta[2], theta[4]);
}

TEST(Tables, ExtendTheRunToTheirLastTime) {
    const Problem p = falling_beam(ModelKind::rigid);
    Request request;
    request.end_time = 0.1;
    request.tables.push_back({{0.3}, {channel("theta")}});
    EXPECT_EQ(simulate(p, request).end_time, 0.3);
}

TEST(Runs, OfNoLengthShowTheStart) {
    const Problem p;
    const Result r = run(p, 0);
    EXPECT_EQ(r.end_time, 0);
    EXPECT_EQ(series(p, "theta", {0})[0], kQuarterTurn);
}

TEST(Runs, CanBeInterrupted) {
    Request request;
    request.end_time = 5;
    int calls = 0;
    EXPECT_THROW(simulate(Problem{}, request, [&](double) { return ++calls < 3; }), Interrupted);
    EXPECT_EQ(calls, 3);
}

// The search for a touch in one step may take far longer than the step.
TEST(Runs, CanBeInterruptedWithinAStep) {
    Problem p;
    p.cam->speed = 1e6;  // its eccentricity allows no look farther ahead than microseconds
    Request request;
    request.end_time = 0.2;
    double last = -1;
    int calls = 0;
    bool again = false;
    const auto stop_at_the_second_of_a_step = [&](double t) {
        again = t == last;
        last = t;
        return !again && ++calls < 1000;
    };
    EXPECT_THROW(simulate(p, request, stop_at_the_second_of_a_step), Interrupted);
    EXPECT_TRUE(again);
}

TEST(Runs, RejectImpossibleProblemsBeforeAnyWork) {
    Problem p;
    p.initial.angle = 0.1;
    EXPECT_THROW(run(p, 1), std::invalid_argument);
}

}  // namespace
}  // namespace beamcam::sim::testing
