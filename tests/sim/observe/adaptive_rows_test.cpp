// Tables whose rows follow the curves of all channels, and warnings of tables whose rows do not.
#include <algorithm>
#include <cmath>

#include "sim/run/simulate.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kStray = 2e-3;

Request adaptive(const Problem& p, double end) {
    Request request;
    TableRequest table{{}, all_channels(p)};
    for (int k = 0; k <= 100; ++k) table.times.push_back(end * k / 100);
    table.adaptive = true;
    table.stray = kStray;
    request.tables.push_back(table);
    return request;
}

double largest(const std::vector<double>& values) { return *std::ranges::max_element(values); }

double largest_force(const Result& result) {
    double out = 0;
    for (const Impact& impact : result.impacts) out = std::max(out, impact.force_peak.value_or(0));
    return out;
}

class AdaptiveRows : public ::testing::TestWithParam<ModelKind> {};

// Against an independent integration at instants between the rows: halfway, and at a share that no halving uses.
TEST_P(AdaptiveRows, FollowTheCurveOfEveryChannel) {
    Problem p;
    p.beam.model = GetParam();
    set_tolerance(p, 1e-10);
    const double end = 0.42;
    const Table table = simulate(p, adaptive(p, end)).tables[0];
    const std::vector<double>& t = table.values[0];
    ASSERT_TRUE(std::ranges::is_sorted(t));
    std::vector<double> between;
    for (std::size_t i = 0; i + 1 < t.size(); ++i)
        for (const double share : {0.5, 0.2137}) between.push_back(std::lerp(t[i], t[i + 1], share));
    p.solver.method = Method::rk8;
    Request request;
    request.tables.push_back({between, table.channels});
    const Table truth = simulate(p, request).tables[0];
    std::size_t above = 0;
    for (std::size_t c = 1; c < table.channels.size(); ++c) {
        const Channel channel = table.channels[c];
        // The arc jumps at the mark; the residual is an error, not a motion; of all channels, single modes and the
        // separation are not followed.
        if (channel.kind == ChannelKind::contact_s || channel.kind == ChannelKind::energy_residual) continue;
        if (traits(channel.kind).of_mode || traits(channel.kind).accelerated) continue;
        const std::vector<double>& v = table.values[c];
        const auto [low, high] = std::ranges::minmax(v);
        if (!(high - low > 1e-8)) continue;  // of a channel that is zero but for rounding
        for (std::size_t k = 0; k < between.size(); ++k) {
            const std::size_t i = k / 2;
            const double along = (t[i + 1] - t[i]) / end, rise = (v[i + 1] - v[i]) / (high - low);
            const double off = (between[k] - t[i]) / end, up = (truth.values[c][k] - v[i]) / (high - low);
            const double length = along * along + rise * rise,
                         share = length > 0 ? std::clamp((off * along + up * rise) / length, 0.0, 1.0) : 0;
            // A piece is checked at two instants; between them a crest may rise above.
            const double distance = std::hypot(off - share * along, up - share * rise);
            EXPECT_LE(distance, 3 * kStray) << name(channel) << " at " << between[k];
            above += distance > 1.5 * kStray;
        }
    }
    EXPECT_LE(above, 0.005 * static_cast<double>(between.size()));
}

INSTANTIATE_TEST_SUITE_P(Models, AdaptiveRows,
                         ::testing::Values(ModelKind::rigid, ModelKind::first_order, ModelKind::exact));

TEST(AdaptiveRows, ReachTheLargestForce) {
    const Problem p;
    const Result result = simulate(p, adaptive(p, 1.5));
    const Table& table = result.tables[0];
    const auto force = std::ranges::find(table.channels, channel("contact_force")) - table.channels.begin();
    EXPECT_GE(largest(table.values[static_cast<std::size_t>(force)]), (1 - 2 * kStray) * largest_force(result));
    EXPECT_LE(table.rows(), 10000u);
    EXPECT_TRUE(result.warnings.empty()) << result.warnings.front();
}

// A falling pendulum is nearly a parabola. Pieces with a sagitta h²θ̈/8 of 0.2 % of its range are 15; those near the
// start, where the range so far is small, are shorter.
TEST(AdaptiveRows, AreNoMoreThanNeeded) {
    Problem p = falling_beam(ModelKind::rigid);
    Request request;
    request.tables.push_back({{0, 0.3}, {channel("t"), channel("theta")}});
    request.tables[0].adaptive = true;
    request.tables[0].stray = kStray;
    const std::size_t rows = simulate(p, request).tables[0].rows();
    EXPECT_GE(rows, 8u);
    EXPECT_LE(rows, 100u);
}

// A mode that is asked for is followed: its crests are rows, to the same share.
TEST(AdaptiveRows, FollowAModeThatIsAskedFor) {
    const Problem p;
    Request request = adaptive(p, 0.5);
    request.tables[0].channels = {channel("t"), channel("q2")};
    request.extrema = {channel("q2")};
    const Result result = simulate(p, request);
    const auto [low, high] = std::ranges::minmax(result.tables[0].values[1]);
    const Extremum& truth = result.extrema[0];
    EXPECT_NEAR(low, truth.min, 2 * kStray * (truth.max - truth.min));
    EXPECT_NEAR(high, truth.max, 2 * kStray * (truth.max - truth.min));
}

TEST(AdaptiveRows, AtAJumpAreItsTwoSides) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0.5;
    const Result result = simulate(p, adaptive(p, 0.5));
    const Impact& impact = result.impacts.at(0);
    const Table& table = result.tables[0];
    const auto rate = std::ranges::find(table.channels, channel("theta_dot")) - table.channels.begin();
    const auto [first, last] = std::ranges::equal_range(table.values[0], impact.t_start);
    ASSERT_EQ(last - first, 2);
    const auto* values =
        &table.values[static_cast<std::size_t>(rate)][static_cast<std::size_t>(first - table.values[0].begin())];
    EXPECT_NEAR(values[0], impact.at_touch->theta_dot, 1e-12);
    EXPECT_NEAR(values[1], impact.at_release->theta_dot, 1e-12);
    EXPECT_LT(values[0], 0);
    EXPECT_GT(values[1], 0);
    for (std::size_t i = 2; i < table.rows(); ++i) EXPECT_GT(table.values[0][i], table.values[0][i - 2]);
}

// At rest everything is rounding, which no rows follow.
TEST(AdaptiveRows, OfABeamAtRestAreThoseOfTheTable) {
    Problem p;
    p.cam->speed = 0;
    p.initial.shape = InitialShape::resting;
    p.contact.model = ContactModel::restitution;
    EXPECT_LE(simulate(p, adaptive(p, 1)).tables[0].rows(), 400u);
}

std::vector<std::string> warnings_at(double rate, const char* which) {
    Problem p;
    Request request;
    TableRequest table{{}, {channel("t"), channel(which)}};
    for (int k = 0; k <= 1.5 * rate; ++k) table.times.push_back(k / rate);
    table.rate = rate;
    request.tables.push_back(table);
    return simulate(p, request).warnings;
}

TEST(MissedPeaks, AreWarnedOfWithTheForceInRowsAndInTruth) {
    const std::vector<std::string> warnings = warnings_at(1000, "contact_force");
    ASSERT_EQ(warnings.size(), 1u);
    for (const char* part :
         {"every 0.001 s", "fall between the rows", "the largest contact_force is", "in truth", "adaptive"})
        EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
}

TEST(MissedPeaks, AreNoneWhereTheRowsResolveTheImpacts) { EXPECT_TRUE(warnings_at(2e6, "contact_force").empty()); }

TEST(MissedPeaks, MatterToChannelsOfTheContactOnly) { EXPECT_TRUE(warnings_at(100, "theta").empty()); }

}  // namespace
}  // namespace beamcam::sim::testing
