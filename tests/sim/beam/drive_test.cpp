#include "sim/beam/drive.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

void expect_consistent(const DriveLaw& law, double t) {
    const double h = 1e-4;
    const HubMotion m = law.motion(t);
    EXPECT_NEAR(scalar_slope_at_zero([&](double e) { return law.motion(t + e).angle; }, h), m.rate, 1e-9) << t;
    EXPECT_NEAR(scalar_slope_at_zero([&](double e) { return law.motion(t + e).rate; }, h), m.acceleration, 1e-9) << t;
}

TEST(Drive, ConstantSpeedTurnsFromTheInitialAngle) {
    const DriveLaw law(ConstantSpeed{-2}, 0.3);
    EXPECT_TRUE(law.prescribed());
    EXPECT_FALSE(law.has_torque());
    EXPECT_EQ(law.motion(0).angle, 0.3);
    EXPECT_NEAR(law.motion(1.5).angle, 0.3 - 3, 1e-15);
    expect_consistent(law, 2);
}

TEST(Drive, SpinUpIsSmoothAndEndsAtItsSpeed) {
    const DriveLaw law(SpinUp{4, 15}, 0.1);
    EXPECT_EQ(law.motion(0).angle, 0.1);
    EXPECT_EQ(law.motion(0).rate, 0);
    EXPECT_NEAR(law.motion(7.5).rate, 2, 1e-14);
    EXPECT_NEAR(law.motion(15).rate, 4, 1e-14);
    for (double t : {0.5, 5.0, 12.0, 14.9, 17.0}) expect_consistent(law, t);
    const HubMotion before = law.motion(15 - 1e-9), after = law.motion(15 + 1e-9);
    EXPECT_NEAR(before.angle, after.angle, 2e-8);
    EXPECT_NEAR(before.rate, after.rate, 1e-9);
    EXPECT_NEAR(before.acceleration, after.acceleration, 1e-9);
    ASSERT_EQ(law.kinks().size(), 1u);
    EXPECT_EQ(law.kinks()[0], 15);
}

TEST(Drive, AngleTablePassesThroughItsPointsSmoothly) {
    const AngleTable table{{0, 0.5, 0.9, 2}, {0.2, 0.7, 0.1, 0.4}};
    const DriveLaw law(table, 99);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(law.motion(table.t[i]).angle, table.theta[i], 1e-15);
    for (double t : {0.1, 0.7, 1.5}) expect_consistent(law, t);
    for (double t : {0.5, 0.9}) {
        const HubMotion before = law.motion(t - 1e-12), after = law.motion(t + 1e-12);
        EXPECT_NEAR(before.rate, after.rate, 1e-9);
        EXPECT_NEAR(before.acceleration, after.acceleration, 1e-8);
    }
    // Outside the table the speed is constant: no jump of angle, speed or acceleration at the ends.
    for (double t : {0.0, 2.0}) {
        const HubMotion before = law.motion(t - 1e-12), after = law.motion(t + 1e-12);
        EXPECT_NEAR(before.rate, after.rate, 1e-9);
        EXPECT_NEAR(before.acceleration, after.acceleration, 1e-8);
    }
    EXPECT_NEAR(law.motion(5).angle, 0.4 + 3 * law.motion(2).rate, 1e-14);
    EXPECT_EQ(law.motion(5).rate, law.motion(2).rate);
    EXPECT_NEAR(law.motion(5).acceleration, 0, 1e-14);
}

TEST(Drive, AngleTableOfAStraightLineIsAConstantSpeed) {
    const DriveLaw law(AngleTable{{0, 1, 2, 5}, {0, 3, 6, 15}}, 0);
    for (double t : {0.0, 0.4, 1.7, 4.9}) {
        EXPECT_NEAR(law.motion(t).angle, 3 * t, 1e-14);
        EXPECT_NEAR(law.motion(t).rate, 3, 1e-14);
        EXPECT_NEAR(law.motion(t).acceleration, 0, 1e-13);
    }
}

TEST(Drive, TorqueLawsHaveTheirClosedForms) {
    const DriveLaw constant(ConstantTorque{-3}, 0);
    EXPECT_TRUE(constant.has_torque());
    EXPECT_FALSE(constant.prescribed());
    EXPECT_EQ(constant.torque(7), -3);
    const DriveLaw harmonic(HarmonicTorque{2, 5, 0.4}, 0);
    EXPECT_NEAR(harmonic.torque(0.03), 2 * std::sin(2 * std::numbers::pi * 5 * 0.03 + 0.4), 1e-15);
    const DriveLaw table(TorqueTable{{1, 2, 4}, {10, 20, -20}}, 0);
    EXPECT_EQ(table.torque(0), 10);
    EXPECT_NEAR(table.torque(1.5), 15, 1e-14);
    EXPECT_NEAR(table.torque(3), 0, 1e-14);
    EXPECT_EQ(table.torque(9), -20);
    EXPECT_EQ(table.kinks().size(), 3u);
    EXPECT_EQ(DriveLaw(FreeDrive{}, 0).torque(1), 0);
}

// ---- a hub that has turned for hours ---------------------------------------------------------------

// The steady vibration of one clamped mode under its weight on a hub of constant speed, q̈ + 2ζω q̇ + (ω² − Ω²(1 − D) −
// g G sin θ) q = −g W cos θ, as a Fourier series in θ; ω, D, G, W of the unit beam are published numbers.
struct WeightOnATurningHub {
    static constexpr int kHarmonics = 4;
    double w, ratio, speed, g;
    Eigen::VectorXcd coefficients() const {
        constexpr double kD = 1.1933363741083, kG = 1.5708781899943, kW = 0.7829917560396257;
        const std::complex<double> i(0, 1);
        Eigen::MatrixXcd a = Eigen::MatrixXcd::Zero(2 * kHarmonics + 1, 2 * kHarmonics + 1);
        Eigen::VectorXcd b = Eigen::VectorXcd::Zero(2 * kHarmonics + 1);
        for (int row = 0; row <= 2 * kHarmonics; ++row) {
            const double rate = (row - kHarmonics) * speed;
            a(row, row) = w * w - speed * speed * (1 - kD) - rate * rate + 2.0 * i * ratio * w * rate;
            if (row > 0) a(row, row - 1) = 0.5 * i * g * kG;
            if (row < 2 * kHarmonics) a(row, row + 1) = -0.5 * i * g * kG;
        }
        b[kHarmonics - 1] = b[kHarmonics + 1] = -0.5 * g * kW;
        return a.partialPivLu().solve(b);
    }
    double tip(double theta) const {  // φ(L) = 2
        const Eigen::VectorXcd c = coefficients();
        double q = 0;
        for (int n = -kHarmonics; n <= kHarmonics; ++n) q += (c[n + kHarmonics] * std::polar(1.0, n * theta)).real();
        return 2 * q;
    }
};

TEST(TurningHub, ForcesTheBeamAsPreciselyAfterHoursAsAtTheStart) {
    SKIP_UNDER_SANITIZERS();
    Problem p;
    p.cam.reset();
    p.beam.modes = 1;
    p.beam.damping_ratio = {0.02};
    p.hub.drive = ConstantSpeed{7.3};
    p.initial.angle = 0.3;
    const double root = 1.875104068711961;
    const WeightOnATurningHub steady{root * root * std::sqrt(p.beam.bending_stiffness() / p.beam.line_density()), 0.02,
                                     7.3, p.gravity};
    std::vector<double> times;
    for (int k = 0; k < 20; ++k) {
        times.push_back(20 + 0.1 * k);
        times.push_back(10'000 + 0.1 * k);
    }
    std::ranges::sort(times);
    const std::vector<double> tips = series(p, "tip_deflection", times);
    for (std::size_t k = 0; k < times.size(); ++k)
        EXPECT_NEAR(tips[k], steady.tip(0.3 + 7.3 * times[k]), 2e-11) << times[k];  // of 0.44 mm: 5 rtol
}

// ---- spin-up of a flexible beam: Kane, Ryan & Banerjee 1987 -----------------------------------------

Problem spin_up(double speed, int modes) {
    Problem p;
    p.cam.reset();
    p.gravity = 0;
    p.beam.length = 8;
    p.beam.density = 2766.67;
    p.beam.modes = modes;
    p.initial.angle = 0;
    p.hub.drive = SpinUp{speed, 15};
    set_tolerance(p, 1e-10);
    return p;
}

TEST(SpinUp, WorkOfTheDriveBecomesEnergy) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        Problem p = spin_up(4, 2);
        p.beam.model = kind;
        Request request;
        request.tables.push_back({{16}, {channel("work_drive"), channel("energy_kinetic"), channel("energy_elastic")}});
        const Result r = simulate(p, request);
        const auto& row = r.tables[0].values;
        EXPECT_NEAR(row[0][0], row[1][0] + row[2][0], 1e-8 * row[1][0]) << name(kind);
        EXPECT_GT(row[0][0], 100);
    }
}

TEST(TorqueDrive, AcceleratesTheRigidRodByTorqueOverInertia) {
    Problem p = falling_beam(ModelKind::rigid);
    p.gravity = 0;
    p.initial.angle = 0;
    p.hub.inertia = 0.1;
    p.hub.drive = ConstantTorque{0.5};
    const double j = 0.1 + p.beam.line_density() / 3;
    EXPECT_NEAR(series(p, "theta", {2})[0], 0.5 * 0.5 / j * 4, 1e-11);
    p.hub.drive = HarmonicTorque{1, 0.5, 0};  // ∫∫ sin πt = t/π − sin(πt)/π²
    EXPECT_NEAR(series(p, "theta", {2})[0], 2 / std::numbers::pi / j, 1e-11);
    p.hub.drive = TorqueTable{{0, 1, 1.5}, {0, 1, 0}};
    EXPECT_NEAR(series(p, "theta_dot", {2})[0], 0.75 / j, 1e-11);
}

TEST(TorqueDrive, WorksOnTheHubAngleInBothBases) {
    std::vector<double> theta;
    for (const Basis basis : {Basis::cantilever, Basis::hub_beam}) {
        Problem p = falling_beam(ModelKind::first_order, basis, 12);
        p.gravity = 0;
        p.hub.inertia = 0.2;
        p.hub.radius = 0.1;
        p.hub.drive = ConstantTorque{2};
        p.solver.rtol = 1e-9;
        Request request;
        request.end_time = 0.05;
        request.tables.push_back({{0.05}, {channel("theta"), channel("energy_residual"), channel("work_drive")}});
        const Result r = simulate(p, request);
        theta.push_back(r.tables[0].values[0][0]);
        EXPECT_LT(std::fabs(r.tables[0].values[1][0]), 1e-8 * r.tables[0].values[2][0]) << name(basis);
    }
    EXPECT_NEAR(theta[0], theta[1], 2e-6);  // twelve modes of either basis
}

}  // namespace
}  // namespace beamcam::sim::testing
