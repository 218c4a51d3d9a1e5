// Tables whose rows follow a curve: what phase portraits are drawn by.
#include "sim/observe/refine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/run/simulate.hpp"

namespace beamcam::sim {
namespace {

const Channel kTime{ChannelKind::t, 0}, kTheta{ChannelKind::theta, 0}, kRate{ChannelKind::theta_dot, 0};

Table sampled(const Problem& p, const std::vector<double>& times, bool curve) {
    Request request;
    request.tables.push_back({times, {kTime, kTheta, kRate}});
    if (curve) request.tables[0].curve = {kTheta, kRate};
    return simulate(p, request).tables[0];
}

// Largest distance of the motion halfway between neighbouring rows from the straight piece, of the curve's range.
double stray(const Problem& p, const Table& table) {
    const auto &t = table.values[0], &x = table.values[1], &y = table.values[2];
    std::vector<double> halfway;
    for (std::size_t i = 0; i + 1 < t.size(); ++i) halfway.push_back(0.5 * (t[i] + t[i + 1]));
    const Table truth = sampled(p, halfway, false);
    const auto range = [](const std::vector<double>& v) {
        const auto [low, high] = std::ranges::minmax(v);
        return high - low;
    };
    const double rx = range(truth.values[1]), ry = range(truth.values[2]);
    double largest = 0;
    for (std::size_t i = 0; i < halfway.size(); ++i) {
        const double ax = (x[i + 1] - x[i]) / rx, ay = (y[i + 1] - y[i]) / ry;
        const double bx = (truth.values[1][i] - x[i]) / rx, by = (truth.values[2][i] - y[i]) / ry;
        const double length = ax * ax + ay * ay;
        const double share = length > 0 ? std::clamp((ax * bx + ay * by) / length, 0.0, 1.0) : 0;
        largest = std::max(largest, std::hypot(bx - share * ax, by - share * ay));
    }
    return largest;
}

std::vector<double> every(double step, double end) {
    std::vector<double> times;
    for (int i = 0; i * step <= end; ++i) times.push_back(i * step);
    return times;
}

TEST(CurveTable, FollowsTheVibrationBetweenItsTimes) {
    Problem p;
    p.beam.modes = 3;
    const std::vector<double> coarse = every(2e-3, 0.6);  // slower than the third mode's 1.1 ms
    EXPECT_GT(stray(p, sampled(p, coarse, false)), 0.2);
    const Table fine = sampled(p, coarse, true);
    EXPECT_LT(stray(p, fine), 0.03);
    EXPECT_LT(fine.rows(), 20 * coarse.size());
}

TEST(CurveTable, KeepsTheRowsThatWereAskedForAndTheOrderOfTime) {
    Problem p;
    const std::vector<double> times = every(1e-2, 0.5);
    const Table plain = sampled(p, times, false), fine = sampled(p, times, true);
    EXPECT_TRUE(std::ranges::is_sorted(fine.values[0]));
    for (std::size_t row = 0; row < times.size(); ++row) {
        const auto at = std::ranges::find(fine.values[0], times[row]) - fine.values[0].begin();
        ASSERT_LT(at, std::ssize(fine.values[0]));
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(fine.values[c][static_cast<std::size_t>(at)], plain.values[c][row]) << times[row];
    }
}

TEST(CurveTable, HasBothSidesOfAnImpulse) {
    Problem p;
    p.contact.model = ContactModel::restitution;
    p.beam.model = ModelKind::rigid;
    Request request;
    request.end_time = 0.4;
    const Impact hit = simulate(p, request).impacts.at(0);
    const Table table = sampled(p, every(0.05, 0.4), true);
    double before = 0, after = 0;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        if (std::abs(table.values[0][row] - hit.t_start) > 1e-9) continue;
        before = std::min(before, table.values[2][row]);
        after = std::max(after, table.values[2][row]);
    }
    EXPECT_LT(before, -1);
    EXPECT_GT(after, 0.5);
}

TEST(CurveTable, OfASmoothFallNeedsFewRows) {
    Problem p;
    p.cam.reset();
    p.beam.model = ModelKind::rigid;
    const std::vector<double> times = every(0.05, 0.3);
    EXPECT_LT(sampled(p, times, true).rows(), 120u);
}

}  // namespace
}  // namespace beamcam::sim
