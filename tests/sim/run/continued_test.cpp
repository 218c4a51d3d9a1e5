// A motion that is continued from the state at an instant is the motion itself.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "sim/run/run.hpp"
#include "sim/run/simulate.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

struct ContinuedCase {
    const char* name;
    std::function<void(Problem&)> change;
    ModelKind model = ModelKind::first_order;
    double end = 0.6;
};

void press(Problem& p) {
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0.3;
    p.cam->speed = 20;
    p.hub.drive = ConstantTorque{-2};
}
void stick(Problem& p) {
    p.contact.friction = StickSlipFriction{0.3, 0.5, {}};
    p.hub.radius = 0.1;
    p.contact.offset = 0.01;
    p.cam->speed = 10;
}

const ContinuedCase kContinuedCases[] = {
    {"Falling", [](Problem&) {}},
    {"Rigid", [](Problem& p) { p.cam->speed = 5; }, ModelKind::rigid},
    {"Exact", [](Problem& p) { p.beam.modes = 3; }, ModelKind::exact},
    {"Second", [](Problem&) {}, ModelKind::second_order},
    {"RigidPressed", press, ModelKind::rigid},
    {"Pressed", press},
    {"ExactPressed", press, ModelKind::exact, 0.45},
    {"StickSlip", stick},
    {"RigidStickSlip", stick, ModelKind::rigid},
    {"ExactStickSlip", stick, ModelKind::exact, 0.45},
    {"Coulomb",
     [](Problem& p) {
         stick(p);
         p.contact.friction = CoulombFriction{0.3, 1e-2};
     }},
    {"FirstTouch", [](Problem& p) { p.contact.approach_floor.policy = ApproachFloorPolicy::first_touch; }},
    {"Resting", [](Problem& p) { p.initial.shape = InitialShape::resting; }},
    {"HarmonicTorque",
     [](Problem& p) {
         p.hub.drive = HarmonicTorque{0.5, 7, 0.3};
     }},
    {"TorqueTable",
     [](Problem& p) {
         p.hub.drive = TorqueTable{{0, 0.2, 0.35, 0.5}, {0, 0.3, -0.4, 0}};
     }},
    {"ConstantSpeed", [](Problem& p) { p.hub.drive = ConstantSpeed{-1}; }},
    {"SpinUp",
     [](Problem& p) {
         p.hub.drive = SpinUp{-3, 0.5};
     }},
    {"AngleTable",
     [](Problem& p) {
         p.hub.drive = AngleTable{{0, 0.2, 0.4, 0.8}, {0.785, 0.6, 0.3, 0.35}};
     }},
};

class Continued : public ::testing::TestWithParam<ContinuedCase> {};

Problem problem_of(const ContinuedCase& motion) {
    Problem p;
    p.beam.model = motion.model;
    p.beam.modes = 3;
    motion.change(p);
    if (p.beam.model == ModelKind::exact) p.beam.modes = 2;
    set_tolerance(p, 1e-10);
    return p;
}

// In flight and in contact, and exactly at a touch and a release.
std::vector<double> instants(const Result& result, double end) {
    std::vector<double> out{0, 0.1 * end};
    for (std::size_t i : {std::size_t{0}, result.impacts.size() / 2}) {
        if (i >= result.impacts.size()) continue;
        const Impact& impact = result.impacts[i];
        const double until = std::min(impact.t_end.value_or(end), 0.95 * end);
        for (const double share : {0.0, 0.2, 0.7, 1.0, 1.05}) out.push_back(std::lerp(impact.t_start, until, share));
    }
    std::erase_if(out, [&](double t) { return t > 0.96 * end; });
    return out;
}

// They differ by the errors of their steps.
TEST_P(Continued, MotionIsTheUncontinuedOne) {
    const Problem p = problem_of(GetParam());
    const double end = GetParam().end;
    Request request;
    request.end_time = end;
    request.states = instants(run(p, end), end);
    const std::vector<Channel> channels{channel("theta"), channel("theta_dot"), channel("tip_deflection"),
                                        channel("cam_angle"), channel("contact_x")};
    const double scale[] = {1, 20, 0.02, 1, 1};
    for (const double from : request.states) {
        std::vector<double> times;
        for (int k = 0; k <= 40; ++k) times.push_back(from + (std::min(end, from + 0.04) - from) * k / 40);
        request.tables.push_back({times, channels});
    }
    const Result whole = simulate(p, request);
    for (std::size_t i = 0; i < request.states.size(); ++i) {
        ASSERT_TRUE(whole.states[i]);
        const Problem& next = *whole.states[i];
        ASSERT_TRUE(is_plain(next)) << request.states[i] << " " << validate(next).front().message;
        Request later;
        later.tables.push_back({request.tables[i].times, channels});
        for (double& t : later.tables[0].times) t -= request.states[i];
        later.tables[0].times.front() = 0;
        const Table table = simulate(next, later).tables[0];
        for (std::size_t c = 0; c < channels.size(); ++c)
            for (std::size_t row = 0; row < table.rows(); ++row)
                EXPECT_NEAR(table.values[c][row], whole.tables[i].values[c][row], 10 * p.solver.rtol * scale[c])
                    << name(channels[c]) << " from " << request.states[i] << " at " << later.tables[0].times[row];
    }
}

INSTANTIATE_TEST_SUITE_P(All, Continued, ::testing::ValuesIn(kContinuedCases),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(ContinuedMotion, ContactKeepsItsForceAndFriction) {
    Problem p;
    stick(p);
    set_tolerance(p, 1e-11);
    const Impact first = run(p, 0.5).impacts.at(0);
    for (const double share : {0.1, 0.5, 0.9}) {
        const double t = std::lerp(first.t_start, *first.t_end, share);
        Request request;
        request.states = {t};
        request.tables.push_back({{t}, {channel("contact_force"), channel("friction_force"), channel("q1_dot")}});
        const Result whole = simulate(p, request);
        request.states.clear();
        request.tables[0].times = {0};
        const Result next = simulate(*whole.states[0], request);
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = whole.tables[0].values[c][0];
            EXPECT_NEAR(next.tables[0].values[c][0], value, 1e-9 * std::fabs(value)) << share << " " << c;
        }
    }
}

// The dissipation of later touches divides by the approach speed of the collision's first one.
TEST(ContinuedMotion, CollisionIsRemembered) {
    Problem p;
    p.contact.approach_floor.policy = ApproachFloorPolicy::first_touch;
    set_tolerance(p, 1e-9);
    const Result result = run(p, 1.5);
    std::size_t last = 1;  // of two neighbours in one collision
    while (last < result.impacts.size() && result.impacts[last].collision != result.impacts[last - 1].collision) ++last;
    ASSERT_LT(last, result.impacts.size());
    const Impact &before = result.impacts[last - 1], &after = result.impacts[last];
    Request request;
    request.states = {0.5 * (*before.t_end + after.t_start)};
    const Problem next = *simulate(p, request).states[0];
    ASSERT_TRUE(next.initial.contact);
    EXPECT_FALSE(next.initial.contact->touching);
    const Collision& collision = result.collisions[static_cast<std::size_t>(after.collision - 1)];
    EXPECT_NEAR(*next.initial.contact->first_approach, -collision.v_n_before, 1e-9);
    EXPECT_NEAR(*next.initial.contact->last_release, *before.t_end - request.states[0], 1e-12);
    // Without the memory the next touch would divide by its own, slower approach.
    const auto force = [&](Problem problem) { return *run(problem, 0.02).impacts.at(0).force_peak; };
    Problem forgetful = next;
    forgetful.initial.contact.reset();
    EXPECT_NEAR(force(next), *after.force_peak, 1e-4 * *after.force_peak);
    EXPECT_GT(std::fabs(force(forgetful) - *after.force_peak), 1e-3 * *after.force_peak);
}

TEST(ContinuedMotion, SeveralTimesInARowIsStillTheMotion) {
    Problem p;
    set_tolerance(p, 1e-10);
    const double end = 0.45;
    const double whole = series(p, "theta", {end})[0];
    Problem next = p;
    for (int k = 0; k < 9; ++k) {
        Request request;
        request.states = {end / 9};
        next = *simulate(next, request).states[0];
    }
    EXPECT_NEAR(next.initial.angle, whole, 1e-8);
}

// A run follows a problem of its own: the caller's may be a temporary.
TEST(ContinuedMotion, RunOutlivesTheProblemItWasGiven) {
    auto p = std::make_unique<Problem>();
    sim::Run run(*p, {}, {.end = 0.1});
    p.reset();
    run.integrate();
    EXPECT_EQ(run.state().t, 0.1);
}

}  // namespace
}  // namespace beamcam::sim::testing
