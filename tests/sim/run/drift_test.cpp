// What is left of the energy after 10⁵ periods of the first bending mode, undamped and without contact, at the default
// tolerance. The ledger's residual is compared with the energies themselves, which must say the same.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kPeriod = 2 * std::numbers::pi / 816.9;  // [s] of the free default beam

struct Drift {
    double residual, energies, scale;  // [J], at the end; the second without the ledger's help
};

Drift after(const Problem& p, double from, double periods) {
    Request request;
    const double end = periods * kPeriod;
    request.tables.push_back({{from, end},
                              {channel("energy_residual"), channel("energy_kinetic"), channel("energy_potential"),
                               channel("energy_elastic")}});
    const Result r = simulate(p, request);
    const auto& v = r.tables[0].values;
    const auto total = [&](std::size_t row) { return v[1][row] + v[2][row] + v[3][row]; };
    return {v[0][1] - v[0][0], total(1) - total(0), r.energy_scale};
}

TEST(LongDrift, OfABeamThatSwingsIsRounding) {
    Problem p;
    p.cam.reset();
    const Drift d = after(p, 0, 1e5);
    EXPECT_LT(std::fabs(d.residual), 1e-11 * d.scale);
    EXPECT_NEAR(d.residual, d.energies, 1e-13 * d.scale);
}

TEST(LongDrift, OfAVibrationStaysBelowTheTolerance) {
    Problem p;
    p.cam.reset();
    p.gravity = 0;
    p.initial.angular_velocity = 1;
    p.hub.drive = TorqueTable{{0, 0.005, 0.01, 0.011}, {0, 5, 0, 0}};
    const Drift d = after(p, 0.011, 1e5);
    EXPECT_LT(std::fabs(d.residual), p.solver.rtol * d.scale);
    EXPECT_NEAR(d.residual, d.energies, 1e-13 * d.scale);
    // It grows linearly with time.
    const Drift early = after(p, 0.011, 1e4);
    EXPECT_LT(std::fabs(d.residual), 12 * std::fabs(early.residual) + 1e-13 * d.scale);
}

}  // namespace
}  // namespace beamcam::sim::testing
