// Where orbits change their pattern of contact, against closed forms: grazing, contact at the tip, release.
#include "sim/orbit/continuation.hpp"
#include "sim/orbit/flow_map.hpp"
#include "tests/sim/orbit/pressed_beam.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

std::vector<const SpecialPoint*> all_of(const Branch& branch, OrbitChange change) {
    std::vector<const SpecialPoint*> found;
    for (const SpecialPoint& point : branch.special)
        if (point.change == change) found.push_back(&point);
    return found;
}

std::vector<Branch> one_impact_branch(const Family& family, double from, const ContinuationRequest& request) {
    OrbitRequest search;
    search.transient = 0;
    search.impacts = 1;
    const std::vector<PeriodicOrbit> found = find_orbits(family(from), search);
    if (found.empty()) return {};
    return continue_orbit(family, {from, found.front()}, request);
}

// The beam starts so close to the cam that it comes to rest on it.
Family close_to_cam(const PressedBeam& b) {
    return [b](double speed) {
        Problem p = b.problem(speed);
        p.initial.angle = 0.46;
        return p;
    };
}

double least_of(const std::function<double(double)>& f, double low, double high) {
    double at = low;
    constexpr int kSamples = 2000;
    for (int i = 1; i <= kSamples; ++i) {
        const double x = low + (high - low) * i / kSamples;
        if (f(x) < f(at)) at = x;
    }
    const double h = (high - low) / kSamples;  // Newton's method on the slope, by differences
    for (int i = 0; i < 20; ++i) {
        const double d = 0.1 * h, slope = (f(at + d) - f(at - d)) / (2 * d),
                     bend = (f(at + d) - 2 * f(at) + f(at - d)) / (d * d);
        if (!(bend > 0)) break;
        at -= std::clamp(slope / bend, -h, h);
    }
    return f(at);
}

// The orbit that strikes where the cam rises ever slower, the partner of the stable one beyond the fold: its flight
// leaves the cam at αT/2, a parabola, and grazes where that touches the cam once more.
TEST(OrbitChanges, ABranchEndsWhereItsFlightGrazesTheCam) {
    const PressedBeam b;
    const auto clearance = [&](double speed) {
        const double period = 2 * std::numbers::pi / speed, wanted = b.alpha * std::numbers::pi / speed / 3;
        const double fastest = find_root([&](double psi) { return b.curve(psi); }, 3.0, 4.0);
        const double strike = find_root([&](double psi) { return -speed * b.slope(psi) - wanted; }, fastest,
                                        fastest + 0.5 * std::numbers::pi);
        const auto gap = [&](double t) {
            return b.angle(strike) + 0.5 * b.alpha * t * (period - t) - b.angle(strike - speed * t);
        };
        return least_of(gap, 0.2 * period, 0.8 * period);
    };
    const double grazing = find_root(clearance, 60.0, 70.0);
    const auto branches = one_impact_branch([&](double w) { return b.problem(w); }, 46, {40, 70, 0.02, 500, 0});
    ASSERT_EQ(branches.size(), 1u);
    const auto found = all_of(branches.front(), OrbitChange::grazing);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found.front()->at.parameter, grazing, 3 * found.front()->uncertainty);
    EXPECT_LT(found.front()->uncertainty, 1e-8 * grazing);
    EXPECT_TRUE(branches.front().first_end.starts_with("grazing") || branches.front().last_end.starts_with("grazing"));
}

// Closed form: the orbit strikes at the cam angle ψ where θ̇_c = (αT/2)(1 − r)/(1 + r), with the lever √(|B|² − R²).
TEST(OrbitChanges, ACornerIsWhereTheStrikePassesTheTip) {
    const PressedBeam b;
    constexpr double kSpeed = 47;
    const auto lever = [&](double speed) {
        const double psi = b.strike_phase(speed), d = b.distance, e = b.eccentricity;
        return std::sqrt(d * d + e * e + 2 * d * e * std::cos(psi) - b.radius * b.radius);
    };
    const double length = lever(kSpeed);
    const Family family = [&](double speed) {
        Problem p = b.problem(speed);
        p.beam.length = length;
        p.hub.drive = ConstantTorque{-b.alpha * p.beam.line_density() * std::pow(length, 3) / 3};
        return p;
    };
    ASSERT_LT(lever(45), length);
    const auto branches = one_impact_branch(family, 45, {44, 50, 0.02, 500, 0});
    ASSERT_EQ(branches.size(), 1u);
    const auto corners = all_of(branches.front(), OrbitChange::corner);
    ASSERT_EQ(corners.size(), 1u);
    EXPECT_NEAR(corners.front()->at.parameter, kSpeed, 1e-8 * kSpeed);
    // The branch continues, with contact at the tip.
    const std::vector<BranchPoint>& points = branches.front().points;
    EXPECT_LT(std::min(points.front().parameter, points.back().parameter), kSpeed - 2);
    EXPECT_GT(std::max(points.front().parameter, points.back().parameter), kSpeed + 2);
    for (const BranchPoint& point : points) {
        const OrbitImpact& impact = point.orbit.impacts.front();
        if (point.parameter > kSpeed)
            EXPECT_EQ(impact.x, length) << point.parameter;
        else
            EXPECT_NEAR(impact.x, lever(point.parameter), 1e-8) << point.parameter;
    }
}

// The contact passes the tip and returns in every turn; the force has two jumps, the state none.
TEST(OrbitChanges, ABeamThatFollowsTheCamWithItsTipIsFollowedInLongSteps) {
    SKIP_UNDER_SANITIZERS();
    const Family family = [](double speed) {
        Problem p;
        p.beam.modes = 1;
        p.beam.damping_ratio = {0.1};
        p.hub = {0, 0.05, ConstantTorque{-1.5}};
        p.cam = Cam{{1.004, 0}, 0.1, 0.002, 0.5, speed, {}, 0.3};
        p.contact.model = ContactModel::restitution;
        p.contact.restitution = 0.4;
        p.initial.angle = 0.12;
        return p;
    };
    OrbitRequest search;
    search.transient = 20;
    const std::vector<PeriodicOrbit> found = find_orbits(family(54.9), search);
    ASSERT_EQ(found.size(), 1u);
    ASSERT_TRUE(found.front().always_touching());
    ContinuationRequest request;
    request.from = 54.8;
    request.to = 55;
    request.step = 0.1;
    const std::vector<Branch> branches = continue_orbit(family, {54.9, found.front()}, request);
    ASSERT_EQ(branches.size(), 1u);
    EXPECT_LT(branches.front().points.size(), 40u);
    EXPECT_TRUE(branches.front().special.empty());
    EXPECT_EQ(branches.front().points.front().parameter, 54.8);
    EXPECT_EQ(branches.front().points.back().parameter, 55.0);
}

// The beam follows the cam until the cam falls faster than the torque accelerates the beam: θ̈_c = −α.
TEST(OrbitChanges, FollowingIsReleasedWhereTheCamFallsFasterThanThePull) {
    const PressedBeam b;
    const double expected =
        std::sqrt(-b.alpha / least_of([&](double psi) { return b.curve(psi); }, 0, 2 * std::numbers::pi));
    const Family family = close_to_cam(b);
    const auto found = find_orbits(family(30), {10, 1});
    ASSERT_FALSE(found.empty());
    ASSERT_TRUE(found.front().always_touching());
    const auto branches = continue_orbit(family, {30, found.front()}, {29, 50, 0.05, 200, 0});
    ASSERT_EQ(branches.size(), 1u);
    const auto released = all_of(branches.front(), OrbitChange::release);
    ASSERT_EQ(released.size(), 1u);
    EXPECT_NEAR(released.front()->at.parameter, expected, released.front()->uncertainty);
    EXPECT_LT(released.front()->uncertainty, 5e-9 * expected);
}

// Bounces from the lift on: parabolas between strikes on the cam, until they have died out. How far the cam is then
// from the angle at which it lets go of the beam [rad]; negative: the bounces do not die out before it.
double rest_after_bounces(const PressedBeam& b, double speed) {
    // ψ falls: the beam is let go where θ̈_c = ω²θ_c″ falls to −α, and would be pressed again where it rises.
    const auto pressed = [&](double psi) { return speed * speed * b.curve(psi) + b.alpha; };
    const double middle = find_root([&](double psi) { return b.curve(psi + 0.01) - b.curve(psi - 0.01); }, 1.0, 3.0);
    const double lift = find_root(pressed, middle, middle + 1.5);
    double psi = lift, angle = b.angle(psi), rate = -speed * b.slope(psi);
    for (int bounce = 0; bounce < 60; ++bounce) {
        const auto gap = [&](double s) { return angle + s * (rate - 0.5 * b.alpha * s) - b.angle(psi - speed * s); };
        const double leaving = rate + speed * b.slope(psi);
        // The first flight begins without speed; others with so much that nothing touches before 2v/(α + max θ̈_c).
        double before = bounce == 0 ? 0.05 / speed : 0.5 * leaving / b.alpha;
        while (gap(1.1 * before) > 0) before *= 1.1;
        const double flight = find_root(gap, before, 1.1 * before);
        angle += flight * (rate - 0.5 * b.alpha * flight);
        rate -= b.alpha * flight;
        psi -= speed * flight;
        const double cam = -speed * b.slope(psi), approach = cam - rate;
        rate = cam + b.restitution * approach;
        if (approach < 1e-8 || psi < lift - 2 * std::numbers::pi) break;
    }
    return psi - (lift - 2 * std::numbers::pi);
}

TEST(OrbitChanges, RestOnTheCamEndsWhereTheBouncesNoLongerDieOutInTime) {
    SKIP_UNDER_SANITIZERS();
    const PressedBeam b;
    const double expected = find_root([&](double w) { return rest_after_bounces(b, w); }, 46.0, 56.0);
    const Family family = close_to_cam(b);
    const auto found = find_orbits(family(42.2), {10, 1});
    ASSERT_FALSE(found.empty());
    ASSERT_TRUE(found.front().chatters());
    EXPECT_LT(std::abs(found.front().multipliers.front()), 1e-12);
    const auto branches = continue_orbit(family, {42.2, found.front()}, {42, 60, 0.1, 2000, 0});
    ASSERT_EQ(branches.size(), 1u);
    const auto released = all_of(branches.front(), OrbitChange::release);
    ASSERT_EQ(released.size(), 1u);
    // Where the pull vanishes with the bounces, it is not steady enough to sum them up: the last ones are left out.
    EXPECT_NEAR(released.front()->at.parameter, expected, released.front()->uncertainty);
}

// Over its release the branch becomes that of the beam that follows the cam; in between, flights have no duration.
TEST(OrbitChanges, TheBranchThatRestsOnACamTurningBackwardsEndsWhereTheBeamFollows) {
    const PressedBeam b;
    const double expected =
        -std::sqrt(-b.alpha / least_of([&](double psi) { return b.curve(psi); }, 0, 2 * std::numbers::pi));
    const Family family = close_to_cam(b);
    const auto found = find_orbits(family(-45), {10, 1});
    ASSERT_FALSE(found.empty());
    ASSERT_TRUE(found.front().chatters());
    const auto branches = continue_orbit(family, {-45, found.front()}, {-46, -40, 0.05, 2000, 0});
    ASSERT_EQ(branches.size(), 1u);
    const auto released = all_of(branches.front(), OrbitChange::release);
    ASSERT_EQ(released.size(), 1u);
    EXPECT_NEAR(released.front()->at.parameter, expected, released.front()->uncertainty);
}

// A bending mode that keeps in step with the bounces of a beam with a heavy hub takes energy from them and gives it
// back: the softer beam's orbit of one impact sheds a torus.
struct BendingBeam {
    PressedBeam pressed{0.001, 0.8, 15, 0.12, 0.05};
    Problem operator()(double softness) const {
        constexpr double kSpeed = 36, kHub = 3;  // I_h in inertias of the beam
        Problem p = pressed.on_orbit(kSpeed);
        const double inertia = p.beam.line_density() * std::pow(p.beam.length, 3) / 3;
        p.beam.model = ModelKind::first_order;
        p.beam.modes = 1;
        p.beam.youngs_modulus *= softness;
        p.hub.inertia = kHub * inertia;
        p.hub.drive = ConstantTorque{-pressed.alpha * (1 + kHub) * inertia};
        return p;
    }
};

// How the logarithm of a small disturbance of the orbit grows a turn, between two times some turns apart: of the motion
// itself, without any tangent.
double growth(const Problem& problem, const PeriodicOrbit& orbit) {
    Problem p = problem;
    p.cam->phase = orbit.section;
    p.solver.rtol = 1e-11;
    p.solver.atol = 1e-13;
    constexpr int kFirst = 200, kTurns = 800, kWindow = 30;  // a window shows the pair all around
    InitialState state = orbit.start;
    state.y[0] += 1e-5;
    double early = 0, late = 0;
    for (int turn = 0; turn < kTurns + kWindow; ++turn) {
        state = motion_end(p, state, orbit.period);
        std::fill(state.y.begin() + 4, state.y.end(), 0.0);  // the ledger
        const double off = std::hypot(state.y[0] - orbit.start.y[0], (state.y[2] - orbit.start.y[2]) * orbit.period);
        if (turn >= kFirst && turn < kFirst + kWindow) early = std::max(early, off);
        if (turn >= kTurns) late = std::max(late, off);
    }
    return std::log(late / early) / (kTurns - kFirst);
}

// Two orbits with one impact exist; one is a saddle.
std::optional<PeriodicOrbit> no_saddle(const Problem& problem) {
    OrbitRequest search;
    search.transient = 0;
    search.impacts = 1;
    for (const PeriodicOrbit& orbit : find_orbits(problem, search))
        if (orbit.multipliers.front().imag() != 0) return orbit;
    return std::nullopt;
}

TEST(OrbitChanges, ANeimarkSackerPointPartsConvergingFromDivergingMotions) {
    SKIP_UNDER_SANITIZERS();
    const BendingBeam family;
    const auto start = no_saddle(family(0.32));
    ASSERT_TRUE(start.has_value());
    const auto branches = continue_orbit(family, {0.32, *start}, {0.31, 0.346, 0.05, 300, 0});
    ASSERT_EQ(branches.size(), 1u);
    const auto found = all_of(branches.front(), OrbitChange::neimark_sacker);
    ASSERT_EQ(found.size(), 1u);
    const PeriodicOrbit& orbit = found.front()->at.orbit;
    EXPECT_NEAR(std::abs(orbit.multipliers[0]), 1, 1e-8);
    EXPECT_NEAR(std::abs(orbit.multipliers[0] - std::conj(orbit.multipliers[1])), 0, 1e-12);
    EXPECT_GT(std::fabs(orbit.multipliers[0].imag()), 0.1);
    EXPECT_LT(std::abs(orbit.multipliers[2]), 0.9);
    for (const double side : {0.997, 1.003}) {
        const Problem p = family(side * found.front()->at.parameter);
        const auto near = no_saddle(p);
        ASSERT_TRUE(near.has_value());
        EXPECT_EQ(near->stable(), side > 1);
        const double expected = std::log(std::abs(near->multipliers.front()));
        EXPECT_NEAR(growth(p, *near), expected, 0.05 * std::fabs(expected)) << side;
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
