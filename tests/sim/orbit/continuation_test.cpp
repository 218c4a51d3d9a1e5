// Periodic orbits and their branches against closed forms: folds and period doublings of a beam that a torque presses
// on the cam, reciprocal multipliers, the limit of stiff contact.
#include "sim/orbit/continuation.hpp"

#include "sim/base/ode.hpp"
#include "tests/sim/orbit/pressed_beam.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr int kOneImpact = 1;

const SpecialPoint* first_of(const Branch& branch, OrbitChange change) {
    for (const SpecialPoint& point : branch.special)
        if (point.change == change) return &point;
    return nullptr;
}

// Where θ̈_c(t*) takes this value while θ̇_c(t*) = (αT/2)(1 − r)/(1 + r): fold at 0, period doubling at
// −2α(1 + r²)/(1 + r)².
double closed_form(const PressedBeam& b, double acceleration, double low, double high) {
    const auto excess = [&](double speed) { return speed * speed * b.curve(b.strike_phase(speed)) - acceleration; };
    return find_root(excess, low, high);
}

std::vector<Branch> branches_of(const Family& family, double from, const ContinuationRequest& request) {
    OrbitRequest search;
    search.transient = 0;
    search.impacts = kOneImpact;
    const std::vector<PeriodicOrbit> found = find_orbits(family(from), search);
    if (found.empty()) return {};
    return continue_orbit(family, {from, found.front()}, request);
}

// Within the stated uncertainty, which is at most 1e-8 of the value.
void expect_at(const SpecialPoint& point, double parameter) {
    EXPECT_NEAR(point.at.parameter, parameter, point.uncertainty);
    EXPECT_LT(point.uncertainty, 1e-8 * std::fabs(parameter));
}

TEST(Continuation, FoldAndPeriodDoublingOfThePressedBeamAreThePublishedNumbers) {
    const PressedBeam b;
    const auto branches = branches_of([&](double w) { return b.problem(w); }, 46, {41, 53, 0.02, 500, 0});
    ASSERT_EQ(branches.size(), 1u);
    const SpecialPoint* fold = first_of(branches.front(), OrbitChange::fold);
    const SpecialPoint* doubling = first_of(branches.front(), OrbitChange::period_doubling);
    ASSERT_TRUE(fold && doubling);
    expect_at(*fold, 42.23567502238);
    expect_at(*doubling, 50.86884987331);
    // Traces 1 + r² and −(1 + r²), determinant r².
    EXPECT_NEAR(std::abs(fold->at.orbit.multipliers[0] - 1.0), 0, 1e-5);  // a double root of the trace
    EXPECT_NEAR(std::abs(doubling->at.orbit.multipliers[0] + 1.0), 0, 1e-9);
    EXPECT_NEAR(std::abs(doubling->at.orbit.multipliers[1] + 0.25), 0, 1e-9);
}

TEST(Continuation, FoldAndPeriodDoublingOfOtherBeamsAreThoseOfTheClosedForm) {
    struct Case {
        PressedBeam beam;
        double from;  // [rad/s], between fold and period doubling
    };
    for (const Case& c : {Case{{0.001, 0.7, 10, 0.3, 0.1}, 45}, Case{{0.004, 0.3, 20, 0.25, 0.08}, 47}}) {
        const PressedBeam& b = c.beam;
        const double r = b.restitution;
        const double pd = closed_form(b, -2 * b.alpha * (1 + r * r) / ((1 + r) * (1 + r)), c.from, 1.6 * c.from);
        const auto branches =
            branches_of([&](double w) { return b.problem(w); }, c.from, {0.7 * c.from, 1.05 * pd, 0.02, 500, 0});
        ASSERT_EQ(branches.size(), 1u);
        const SpecialPoint* fold = first_of(branches.front(), OrbitChange::fold);
        const SpecialPoint* doubling = first_of(branches.front(), OrbitChange::period_doubling);
        ASSERT_TRUE(fold && doubling);
        // At the fold the cam is fastest: θ̈_c = 0.
        const double strike = fold->at.orbit.impacts.front().cam_angle;
        EXPECT_NEAR(b.curve(strike), 0, 1e-6 * b.eccentricity);
        const double needed = b.alpha * std::numbers::pi * (1 - r) / (1 + r);  // ω θ̇_c
        expect_at(*fold, std::sqrt(needed / -b.slope(strike)));
        expect_at(*doubling, pd);
    }
}

// The same cam in the opposite direction; its profile is not symmetric. The values are roots of the closed form
// in 25 digits.
TEST(Continuation, ACamThatTurnsTheOtherWayHasItsOwnFoldAndPeriodDoubling) {
    const PressedBeam b;
    const auto branches = branches_of([&](double w) { return b.problem(w); }, -47, {-53, -41, 0.02, 500, 0});
    ASSERT_EQ(branches.size(), 1u);
    const SpecialPoint* fold = first_of(branches.front(), OrbitChange::fold);
    const SpecialPoint* doubling = first_of(branches.front(), OrbitChange::period_doubling);
    ASSERT_TRUE(fold && doubling);
    expect_at(*fold, -42.605964032422);
    expect_at(*doubling, -51.499496475255);
}

// A cam of vanishing eccentricity is a table that shakes harmonically: Γ = Aω²/α with the amplitude A of θ_c. With k
// turns a flight Γ_SN = kπ(1 − r)/(1 + r), Γ_PD² = Γ_SN² + [2(1 + r²)/(1 + r)²]².
TEST(Continuation, SmallEccentricityIsTheBouncingBall) {
    for (const double r : {0.3, 0.5, 0.8})
        for (const int turns : {1, 2}) {
            PressedBeam b;
            b.restitution = r;
            b.eccentricity = 2e-7;
            const double amplitude = b.eccentricity / std::sqrt(b.distance * b.distance - b.radius * b.radius);
            const auto speed = [&](double gamma) { return std::sqrt(b.alpha * gamma / amplitude); };
            const double sn = turns * std::numbers::pi * (1 - r) / (1 + r);
            const double pd = std::hypot(sn, 2 * (1 + r * r) / ((1 + r) * (1 + r)));
            const Family family = [&](double w) { return b.problem(w); };
            OrbitRequest search;
            search.transient = 0;
            search.impacts = kOneImpact;
            search.turns = turns;
            const double from = speed(0.5 * (sn + pd));
            const std::vector<PeriodicOrbit> found = find_orbits(family(from), search);
            ASSERT_FALSE(found.empty()) << r << ", " << turns;
            const auto branches =
                continue_orbit(family, {from, found.front()}, {speed(0.95 * sn), speed(1.05 * pd), 0.02, 1000, 0});
            ASSERT_EQ(branches.size(), 1u);
            const SpecialPoint* fold = first_of(branches.front(), OrbitChange::fold);
            const SpecialPoint* doubling = first_of(branches.front(), OrbitChange::period_doubling);
            ASSERT_TRUE(fold && doubling) << r << ", " << turns;
            EXPECT_NEAR(fold->at.parameter, speed(sn), 1e-6 * speed(sn)) << r << ", " << turns;  // O(e/D)
            EXPECT_NEAR(doubling->at.parameter, speed(pd), 1e-6 * speed(pd)) << r << ", " << turns;
        }
}

TEST(Continuation, DoubledBranchesDoubleAgain) {
    const PressedBeam b;
    const auto branches = branches_of([&](double w) { return b.problem(w); }, 49, {48, 54, 0.02, 500, 2});
    ASSERT_EQ(branches.size(), 3u);
    for (std::size_t i = 0; i < branches.size(); ++i) {
        const PeriodicOrbit& orbit = branches[i].points.front().orbit;
        EXPECT_EQ(orbit.turns, 1 << i);
        EXPECT_EQ(orbit.impacts.size(), std::size_t(1) << i);
    }
    const double first = first_of(branches[0], OrbitChange::period_doubling)->at.parameter;
    const double second = first_of(branches[1], OrbitChange::period_doubling)->at.parameter;
    const double third = first_of(branches[2], OrbitChange::period_doubling)->at.parameter;
    EXPECT_NEAR((second - first) / (third - second), 4.669, 0.3);  // on the way to Feigenbaum's number
}

// Backwards along the branch of two turns. At its origin it meets itself, each orbit begun a turn later: no fold.
TEST(Continuation, ABranchOfDoubledPeriodEndsAtThePeriodDoubling) {
    const PressedBeam b;
    const Family family = [&](double w) { return b.problem(w); };
    const auto both = branches_of(family, 49, {48, 52, 0.02, 500, 1});
    ASSERT_EQ(both.size(), 2u);
    const BranchPoint& start = both[1].points.back();
    ASSERT_EQ(start.orbit.turns, 2);
    const auto branches = continue_orbit(family, start, {46, 52.5, 0.01, 500, 1});
    ASSERT_EQ(branches.size(), 1u) << "the origin doubles nothing";
    const Branch& branch = branches.front();
    EXPECT_EQ(first_of(branch, OrbitChange::fold), nullptr);
    const SpecialPoint* origin = first_of(branch, OrbitChange::period_doubling);
    ASSERT_TRUE(origin);
    expect_at(*origin, 50.86884987331);
    EXPECT_EQ(origin->at.orbit.turns, 1);
    EXPECT_EQ(branch.special.size(), 1u);
    EXPECT_NE(branch.first_end.find("repeats itself after 1 turn"), std::string::npos) << branch.first_end;
    EXPECT_NEAR(branch.points.front().parameter, origin->at.parameter, 1e-6);
}

// No value beyond an end of the range has a problem. The branch begins and ends there, once.
TEST(Continuation, ABranchMayStartAtTheLastValueWithAProblem) {
    const PressedBeam b;
    constexpr double kEnd = 0.05;
    const Family family = [&](double inertia) {
        if (!(inertia >= 0 && inertia <= kEnd)) throw StepFailure("no problem");
        Problem p = b.problem(45);
        p.hub.inertia = inertia;
        return p;
    };
    for (const double start : {0.0, kEnd}) {
        const auto branches = branches_of(family, start, {0, kEnd, 0.1, 500, 0});
        ASSERT_EQ(branches.size(), 1u) << start;
        const auto& points = branches.front().points;
        ASSERT_GT(points.size(), 5u);
        EXPECT_EQ(points.front().parameter, 0);
        EXPECT_EQ(points.back().parameter, kEnd);
        for (std::size_t i = 1; i < points.size(); ++i) EXPECT_GT(points[i].parameter, points[i - 1].parameter);
        EXPECT_EQ(branches.front().first_end, "the range ends");
        EXPECT_EQ(branches.front().last_end, "the range ends");
    }
}

// From the fold on, the two orbits at the start are one branch.
TEST(Continuation, ABranchKnowsItsOrbitsAtTheParameterOfItsStart) {
    const PressedBeam b;
    const Family family = [&](double w) { return b.problem(w); };
    const auto branches = branches_of(family, 45, {41, 53, 0.02, 500, 0});
    ASSERT_EQ(branches.size(), 1u);
    const std::vector<PeriodicOrbit>& passages = branches[0].at_start;
    const auto passed = [&](const auto& condition) { return std::ranges::any_of(passages, condition); };
    EXPECT_TRUE(passed([](const PeriodicOrbit& orbit) { return orbit.stable(); }));
    EXPECT_TRUE(passed([](const PeriodicOrbit& orbit) { return !orbit.stable(); }));
    OrbitRequest search{.transient = 0};
    search.coexisting = true;
    for (const PeriodicOrbit& found : find_orbits(family(45), search))
        if (!found.chatters() && found.impacts.size() == 1) {
            EXPECT_TRUE(passed([&](const PeriodicOrbit& orbit) { return same_orbit(orbit, found); }));
        }
}

TEST(Continuation, ABranchEndsWhenItsMotionsHaveTakenTheirSteps) {
    const PressedBeam b;
    const Family family = [&](double w) {
        Problem p = b.on_orbit(w);
        p.contact.model = ContactModel::compliant;
        p.contact.stiffness = 1e7;
        p.solver.max_steps = 5000;
        return p;
    };
    const auto branches = branches_of(family, 48, {47, 49, 0.001, 5000, 0});
    ASSERT_EQ(branches.size(), 1u);
    EXPECT_LT(branches[0].points.size(), 500u);
    for (const std::string& end : {branches[0].first_end, branches[0].last_end})
        EXPECT_NE(end.find("a larger solver.max_steps allows more"), std::string::npos) << end;
    // Each direction has its own steps.
    EXPECT_LT(branches[0].points.front().parameter, 48);
    EXPECT_GT(branches[0].points.back().parameter, 48);
}

// Over the speed the impact turns with the cam by more than half a turn, past any fixed section.
TEST(Continuation, TheSectionStaysInFlight) {
    const Family family = [](double speed) {
        Problem p;
        p.beam.model = ModelKind::rigid;
        p.cam->speed = speed;
        p.cam->eccentricity = 2e-4;
        p.contact.model = ContactModel::restitution;
        p.contact.restitution = 0.6;
        p.initial.angle = 0.5;
        return p;
    };
    OrbitRequest search;
    search.transient = 0;
    search.turns = search.impacts.emplace(1);
    const auto found = find_orbits(family(126.52), search);
    ASSERT_FALSE(found.empty());
    for (const PeriodicOrbit& orbit : found)
        EXPECT_NEAR(std::fabs(orbit.impacts.front().cam_angle - orbit.section), std::numbers::pi, 1e-6);
    const auto branches = continue_orbit(family, {126.52, found.front()}, {99.14, 164.31, 0.02, 600, 0});
    ASSERT_EQ(branches.size(), 1u);
    EXPECT_EQ(branches.front().first_end, "the range ends");
    EXPECT_EQ(branches.front().last_end, "the range ends");
    for (const BranchPoint& point : branches.front().points) {
        const double after = std::fabs(point.orbit.impacts.front().cam_angle - point.orbit.section);
        EXPECT_GT(std::min(after, 2 * std::numbers::pi - after), 0.1) << point.parameter;
    }
}

// An area-preserving map has reciprocal multipliers μ and 1/μ.
TEST(Continuation, ConservativeContactHasReciprocalMultipliers) {
    PressedBeam b;
    b.restitution = 1;
    Problem p = b.on_orbit(48);
    p.contact.model = ContactModel::compliant;
    p.contact.damping = DampingLaw::none;
    p.contact.stiffness = 1e7;
    OrbitRequest search;
    search.transient = 0;
    search.turns = 1;
    const auto found = find_orbits(p, search);
    ASSERT_FALSE(found.empty());
    const auto& multipliers = found.front().multipliers;
    EXPECT_LT(std::abs(multipliers[0] * multipliers[1] - 1.0), 1e-9);
}

// The multipliers of a stable conservative orbit remain on the unit circle, which is not a crossing.
TEST(Continuation, ConservativeImpactsHaveNoNeimarkSackerPoint) {
    PressedBeam b;
    b.restitution = 1;
    const auto branches = branches_of([&](double w) { return b.on_orbit(w); }, 38, {32, 41, 0.02, 500, 0});
    ASSERT_EQ(branches.size(), 1u);
    EXPECT_GT(branches.front().points.size(), 20u);
    bool turns = false;  // a complex pair
    for (const BranchPoint& point : branches.front().points)
        for (const auto& m : point.orbit.multipliers) turns = turns || std::fabs(m.imag()) > 0.1;
    EXPECT_TRUE(turns);
    EXPECT_FALSE(first_of(branches.front(), OrbitChange::neimark_sacker));
}

// The period doubling of compliant contact converges to Newton's like K^(−2/5).
TEST(LongContinuation, StiffContactTendsToNewtonsPeriodDoubling) {
    const PressedBeam b;
    const auto doubling = [&](double stiffness) {
        const Family family = [&, stiffness](double w) {
            Problem p = b.on_orbit(w);
            p.contact.model = ContactModel::compliant;
            p.contact.stiffness = stiffness;
            p.contact.damping = DampingLaw::zhang_sharf;
            return p;
        };
        const auto branches = branches_of(family, 48, {47, 53, 0.1, 100, 0});
        const SpecialPoint* found = branches.empty() ? nullptr : first_of(branches[0], OrbitChange::period_doubling);
        return found ? found->at.parameter : std::numeric_limits<double>::quiet_NaN();
    };
    const double softer = doubling(1e9), stiffer = doubling(1e10);
    const double limit = stiffer + (stiffer - softer) / (std::pow(10, 0.4) - 1);
    EXPECT_NEAR(limit, 50.86884987331, 1e-3 * 50.87);
    EXPECT_GT(std::fabs(stiffer - 50.86884987331), 10 * std::fabs(limit - 50.86884987331));
}

TEST(Orbits, ChatteringAttractorComesWithTheOrbitsBesideIt) {
    const auto found = find_orbits(PressedBeam().problem(45), {});
    ASSERT_GE(found.size(), 2u);
    EXPECT_TRUE(found[0].chatters());
    EXPECT_EQ(std::abs(found[0].multipliers[0]), 0);
    EXPECT_FALSE(found[1].chatters());
    EXPECT_TRUE(found[1].stable());
    EXPECT_EQ(found[1].impacts.size(), 1u);
    EXPECT_LT(found[1].residual, 1e-10);
}

// At 53 rad/s the motion is chaotic. The orbit near it says nothing about those from which it has branched off.
TEST(Orbits, AnUnstableOrbitNearTheMotionComesWithTheOrbitsBesideIt) {
    const auto found = find_orbits(PressedBeam().problem(53), {});
    ASSERT_GE(found.size(), 2u);
    EXPECT_FALSE(found[0].stable());
    for (std::size_t i = 1; i < found.size(); ++i) EXPECT_FALSE(same_orbit(found[0], found[i]));
    EXPECT_TRUE(std::ranges::any_of(found, [](const auto& orbit) { return orbit.impacts.size() == 1; }));
}

TEST(Orbits, ProblemsWithoutAPeriodAreRejectedWithAMessage) {
    Problem p;
    p.cam->speed = 0;
    EXPECT_TRUE(orbit_refusal(p).has_value());
    p.cam->speed = 1;
    EXPECT_FALSE(orbit_refusal(p).has_value());
    p.hub.drive = HarmonicTorque{1, 1, 0};
    EXPECT_TRUE(orbit_refusal(p).has_value());
    EXPECT_THROW(find_orbits(p, {}), std::invalid_argument);
}

}  // namespace
}  // namespace beamcam::sim::testing
