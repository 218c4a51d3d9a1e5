#include <cmath>
#include <functional>
#include <limits>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

struct Refusal {
    const char* path;
    std::function<void(Problem&)> spoil;
};

const double kNan = std::numeric_limits<double>::quiet_NaN();

const Refusal kRefusals[] = {
    {"hub.radius", [](Problem& p) { p.hub.radius = -1; }},
    {"hub.radius", [](Problem& p) { p.hub.radius = kNan; }},
    {"hub.inertia", [](Problem& p) { p.hub.inertia = -1e-9; }},
    {"hub.drive.value", [](Problem& p) { p.hub.drive = ConstantTorque{kNan}; }},
    {"hub.drive.frequency",
     [](Problem& p) {
         p.hub.drive = HarmonicTorque{1, -2, 0};
     }},
    {"hub.drive.t",
     [](Problem& p) {
         p.hub.drive = TorqueTable{{}, {}};
     }},
    {"hub.drive.t",
     [](Problem& p) {
         p.hub.drive = TorqueTable{{0, 1, 1}, {0, 1, 2}};
     }},
    {"hub.drive.torque",
     [](Problem& p) {
         p.hub.drive = TorqueTable{{0, 1}, {0}};
     }},
    {"hub.drive.speed", [](Problem& p) { p.hub.drive = ConstantSpeed{INFINITY}; }},
    {"hub.drive.duration",
     [](Problem& p) {
         p.hub.drive = SpinUp{1, 0};
     }},
    {"hub.drive.t",
     [](Problem& p) {
         p.hub.drive = AngleTable{{0}, {1}};
     }},
    {"beam.length", [](Problem& p) { p.beam.length = 0; }},
    {"beam.area", [](Problem& p) { p.beam.area = -1; }},
    {"beam.second_moment", [](Problem& p) { p.beam.second_moment = kNan; }},
    {"beam.density", [](Problem& p) { p.beam.density = 0; }},
    {"beam.youngs_modulus", [](Problem& p) { p.beam.youngs_modulus = INFINITY; }},
    {"beam.poisson_ratio", [](Problem& p) { p.beam.poisson_ratio = 0.5; }},
    {"beam.depth", [](Problem& p) { p.beam.depth = 0; }},
    {"beam.modes", [](Problem& p) { p.beam.modes = 0; }},
    {"beam.modes", [](Problem& p) { p.beam.modes = 41; }},
    {"beam.damping_ratio", [](Problem& p) { p.beam.damping_ratio = {-0.1}; }},
    {"beam.damping_ratio",
     [](Problem& p) {
         p.beam.damping_ratio = {0.1, 0.1, 0.1};
     }},
    {"beam.kelvin_voigt", [](Problem& p) { p.beam.kelvin_voigt = -1; }},
    {"beam.kelvin_voigt",
     [](Problem& p) {
         p.beam.kelvin_voigt = 1e-4;
         p.beam.damping_ratio = {0.01};
     }},
    {"beam.basis",
     [](Problem& p) {
         p.beam.basis = Basis::hub_beam;
         p.hub.drive = ConstantSpeed{1};
     }},
    {"beam.basis",
     [](Problem& p) {
         p.beam.basis = Basis::hub_beam;
         p.beam.model = ModelKind::paper;
     }},
    {"cam.radius", [](Problem& p) { p.cam->radius = 0; }},
    {"cam.eccentricity", [](Problem& p) { p.cam->eccentricity = 0.1; }},
    {"cam.eccentricity", [](Problem& p) { p.cam->eccentricity = -0.01; }},
    {"cam.speed", [](Problem& p) { p.cam->speed = kNan; }},
    {"cam.phase", [](Problem& p) { p.cam->phase = INFINITY; }},
    {"cam.youngs_modulus", [](Problem& p) { p.cam->youngs_modulus = 0; }},
    {"cam.poisson_ratio", [](Problem& p) { p.cam->poisson_ratio = -1; }},
    {"cam.centre",
     [](Problem& p) {
         p.cam->centre = {0.1, 0};
     }},
    {"contact.stiffness", [](Problem& p) { p.contact.stiffness = 0; }},
    {"contact.exponent", [](Problem& p) { p.contact.exponent = 0.9; }},
    {"contact.exponent", [](Problem& p) { p.contact.exponent = 2.1; }},
    {"contact.restitution", [](Problem& p) { p.contact.restitution = 1.01; }},
    {"contact.restitution",
     [](Problem& p) {
         p.contact.restitution = 0.005;
         p.contact.damping = DampingLaw::gonthier;
     }},
    {"contact.restitution",
     [](Problem& p) {
         p.contact.restitution = 0;
         p.contact.damping = DampingLaw::flores;
     }},
    {"contact.restitution",
     [](Problem& p) {
         p.contact.restitution = 0;
         p.contact.damping = DampingLaw::hu_guo;
     }},
    {"contact.restitution",
     [](Problem& p) {
         p.contact.restitution = 0;
         p.contact.damping = DampingLaw::zhang_sharf;
     }},
    {"contact.offset", [](Problem& p) { p.contact.offset = -1; }},
    {"contact.approach_floor.value", [](Problem& p) { p.contact.approach_floor.value = 0; }},
    {"contact.collision_gap", [](Problem& p) { p.contact.collision_gap = -1; }},
    {"contact.friction.coefficient", [](Problem& p) { p.contact.friction = CoulombFriction{-0.1}; }},
    {"contact.friction.slip_speed",
     [](Problem& p) {
         p.contact.friction = CoulombFriction{0.1, 0};
     }},
    {"contact.friction.static_coefficient",
     [](Problem& p) {
         p.contact.friction = StickSlipFriction{0.3, 0.2, {}};
     }},
    {"contact.friction.stiffness",
     [](Problem& p) {
         p.contact.friction = StickSlipFriction{0.3, {}, 0};
     }},
    {"gravity", [](Problem& p) { p.gravity = kNan; }},
    {"initial.angle", [](Problem& p) { p.initial.angle = INFINITY; }},
    {"initial.angle", [](Problem& p) { p.initial.angle = 0.2; }},
    {"initial.angular_velocity", [](Problem& p) { p.initial.angular_velocity = kNan; }},
    {"initial.shape",
     [](Problem& p) {
         p.initial.shape = InitialShape::resting;
         p.cam.reset();
     }},
    {"initial.shape",
     [](Problem& p) {
         p.initial.shape = InitialShape::resting;
         p.hub.drive = ConstantSpeed{1};
     }},
    {"initial.q", [](Problem& p) { p.initial.q.assign(static_cast<std::size_t>(p.beam.modes) + 1, 0.0); }},
    {"initial.q",
     [](Problem& p) {
         p.beam.model = ModelKind::rigid;
         p.initial.q = {0.0};
     }},
    {"initial.q_dot",
     [](Problem& p) {
         p.initial.shape = InitialShape::static_equilibrium;
         p.initial.q_dot = {0.0};
     }},
    {"initial.q", [](Problem& p) { p.initial.q = {kNan}; }},
    {"initial.q_dot", [](Problem& p) { p.initial.q_dot = {INFINITY}; }},
    {"solver.rtol", [](Problem& p) { p.solver.rtol = 1e-14; }},
    {"solver.rtol", [](Problem& p) { p.solver.rtol = 0.1; }},
    {"solver.atol", [](Problem& p) { p.solver.atol = 0; }},
    {"solver.atol", [](Problem& p) { p.solver.atol = 5e-324; }},
    // Products that overflow, vanish or are lost in rounding.
    {"beam.length", [](Problem& p) { p.beam.length = 5e-324; }},
    {"beam.length", [](Problem& p) { p.beam.length = 1e-25; }},
    {"beam.length", [](Problem& p) { p.beam.length = 1e308; }},
    {"beam.area", [](Problem& p) { p.beam.area = 1e-300; }},
    {"beam.density", [](Problem& p) { p.beam.density = 1e-100; }},
    {"beam.second_moment", [](Problem& p) { p.beam.second_moment = 1e-320; }},
    {"beam.youngs_modulus", [](Problem& p) { p.beam.youngs_modulus = 1e300; }},
    {"beam.youngs_modulus", [](Problem& p) { p.beam.youngs_modulus = 1e-300; }},
    {"beam.damping_ratio", [](Problem& p) { p.beam.damping_ratio = {1e300}; }},
    {"beam.kelvin_voigt", [](Problem& p) { p.beam.kelvin_voigt = 1.7e308; }},
    {"hub.radius", [](Problem& p) { p.hub.radius = 1e30; }},
    {"hub.inertia", [](Problem& p) { p.hub.inertia = 1.7e308; }},
    {"hub.drive.speed", [](Problem& p) { p.hub.drive = ConstantSpeed{1e10}; }},
    {"cam.speed", [](Problem& p) { p.cam->speed = -1e300; }},
    {"cam.speed", [](Problem& p) { p.cam->speed = 1e12; }},
    {"contact.stiffness", [](Problem& p) { p.contact.stiffness = 1e300; }},
    {"contact.stiffness", [](Problem& p) { p.contact.stiffness = 5e-324; }},
    {"initial.angular_velocity", [](Problem& p) { p.initial.angular_velocity = 1e9; }},
    {"gravity", [](Problem& p) { p.gravity = 1e300; }},
};

bool has(const std::vector<Issue>& findings, const std::string& path, bool fatal) {
    for (const Issue& f : findings)
        if (f.path == path && f.fatal == fatal) return true;
    return false;
}

TEST(Validate, AcceptsTheDefaultsSilently) { EXPECT_TRUE(validate(Problem{}).empty()); }

TEST(Validate, RejectsEveryImpossibleValueByItsKey) {
    int row = 0;
    for (const Refusal& refusal : kRefusals) {
        Problem p;
        refusal.spoil(p);
        EXPECT_TRUE(has(validate(p), refusal.path, true)) << "row " << row << ": " << refusal.path;
        EXPECT_THROW(run(p, 0.01), std::invalid_argument) << refusal.path;
        ++row;
    }
}

TEST(Validate, ReportsEverythingAtOnce) {
    Problem p;
    p.beam.length = -1;
    p.cam->radius = 0;
    p.solver.rtol = 1;
    p.contact.exponent = 3;
    EXPECT_GE(validate(p).size(), 4u);
}

TEST(Validate, AcceptsTheEndsOfEveryRange) {
    Problem p;
    p.beam.modes = 40;
    p.contact.exponent = 2;
    p.contact.restitution = 1;
    p.solver.rtol = 1e-13;
    p.cam->eccentricity = 0;
    p.beam.damping_ratio = std::vector<double>(40, 0.01);
    EXPECT_TRUE(is_plain(p));  // a restitution of 0 is not that of the default law
    p.contact.exponent = 1;
    p.contact.restitution = 0;
    p.contact.damping = DampingLaw::hunt_crossley;
    p.solver.rtol = 1e-2;
    p.contact.collision_gap = 0;
    EXPECT_TRUE(is_plain(p));  // a restitution of 0 is not that of the default law
}

// 20 ms, the value of the scene, or for "auto" proportional to √(L/g).
TEST(Derived, ImpactsAreOfOneCollisionWithinASixteenthOfTheTimeOfAFall) {
    Problem p;
    p.beam.length = 200e-6;
    EXPECT_EQ(collision_gap(p), 0.02);
    p.contact.collision_gap.reset();
    for (const double length : {200e-6, 0.4, 20.0})
        for (const double gravity : {9.81, 1.62, -9.81}) {
            p.beam.length = length, p.gravity = gravity;
            EXPECT_NEAR(collision_gap(p) / std::sqrt(length / std::abs(gravity)), 0.02 * std::sqrt(9.81), 1e-12);
        }
    p.gravity = 0;
    EXPECT_NEAR(collision_gap(p), 0.02 * std::sqrt(20), 1e-12);
    p.contact.collision_gap = 0;
    EXPECT_EQ(collision_gap(p), 0);
}

TEST(Validate, NamesTheNumberThatMakesAScaleImpossible) {
    Problem p;
    p.beam.length = 5e-324;
    const std::vector<Issue> findings = validate(p);
    ASSERT_EQ(findings.size(), 1u);  // not what follows from it
    EXPECT_NE(findings[0].message.find("the beam's mass smaller than 1e-60 kg"), std::string::npos)
        << findings[0].message;
    p.beam.length = 1;
    p.contact.stiffness = 5e-324;
    for (const Issue& f : validate(p)) EXPECT_EQ(f.message.find("inf"), std::string::npos) << f.message;
    p.contact.stiffness = 1e25;
    const std::vector<Issue> shallow = validate(p);
    ASSERT_EQ(shallow.size(), 1u);
    EXPECT_EQ(shallow[0].path, "contact.stiffness");
    EXPECT_NE(shallow[0].message.find("lost in rounding"), std::string::npos);
}

TEST(Validate, TakesBeamsOfNanometresAndKilometres) {
    for (const double length : {1e-8, 1e-4, 1e4}) {
        Problem p;
        p.beam.length = length;
        p.beam.area *= length * length;
        p.beam.second_moment *= std::pow(length, 4);
        p.cam->centre = length * p.cam->centre;
        p.cam->radius *= length;
        p.cam->eccentricity *= length;
        EXPECT_TRUE(validate(p).empty()) << length;
    }
}

TEST(Validate, WarnsOfACamOutOfReach) {
    Problem p;
    p.cam->centre = {3, 0};
    EXPECT_TRUE(has(validate(p), "cam.centre", false));
    EXPECT_FALSE(has(validate(p), "cam.centre", true));
}

TEST(Validate, WarnsThatThePapersEquationLosesEnergy) {
    Problem p;
    p.beam.model = ModelKind::paper;
    EXPECT_TRUE(has(validate(p), "beam.model", false));
}

TEST(Validate, CountsTheOffsetFaceAsPartOfTheBeam) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.cam->eccentricity = 0;
    p.initial.angle = std::asin(0.11 / 0.25);
    EXPECT_TRUE(validate(p).empty());
    p.contact.offset = 0.02;
    EXPECT_TRUE(has(validate(p), "initial.angle", true));
}

// lankarani-nikravesh gives impacts 0.66 for 0.05 (S31); zhang-sharf is the law that gives what is set.
TEST(Validate, WarnsOfARestitutionFarFromThatOfTheLaw) {
    Problem p;
    for (const double set : {0.05, 0.3, 0.5}) {
        p.contact.restitution = set;
        p.contact.damping = DampingLaw::lankarani_nikravesh;
        EXPECT_TRUE(has(validate(p), "contact.restitution", false)) << set;
        p.contact.damping = DampingLaw::zhang_sharf;
        EXPECT_TRUE(validate(p).empty()) << set;
    }
    // At 0 that law is not possible: the one that is recommended is.
    p.contact.restitution = 0;
    p.contact.damping = DampingLaw::lankarani_nikravesh;
    const std::vector<Issue> found = validate(p);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].message.find("\"zhang-sharf\" gives 0.01 for \"restitution\": 0.01"), std::string::npos)
        << found[0].message;
    p.contact.restitution = 0.01;
    p.contact.damping = DampingLaw::zhang_sharf;
    EXPECT_TRUE(validate(p).empty());
    p.contact.restitution = 0.05;
    p.contact.damping = DampingLaw::none;  // chosen, and without a restitution
    EXPECT_TRUE(validate(p).empty());
    p.contact.damping = DampingLaw::hunt_crossley;
    p.contact.model = ContactModel::restitution;
    EXPECT_TRUE(validate(p).empty());
}

// The restitution that the law is computed to have is that of a heavy rigid beam's first impact.
TEST(Validate, TheRestitutionOfTheLawIsThatOfAnImpact) {
    for (const DampingLaw law : {DampingLaw::lankarani_nikravesh, DampingLaw::flores, DampingLaw::hunt_crossley}) {
        Problem p;
        p.beam.model = ModelKind::rigid;
        p.cam->speed = 0;
        p.contact.stiffness = 1e11;
        p.contact.damping = law;
        p.contact.restitution = 0.3;
        const Result result = run(p, 0.45);
        ASSERT_FALSE(result.impacts.empty());
        EXPECT_NEAR(result.impacts[0].restitution.value(), effective_restitution(law, 0.3), 2e-3) << name(law);
    }
}

TEST(Validate, TakesAContinuedContactThatTouchesOnly) {
    Problem p;
    p.initial.contact.emplace();
    EXPECT_TRUE(has(validate(p), "initial.contact", true));  // a beam at 45 degrees does not touch
    p.initial.contact->touching = false;
    EXPECT_TRUE(validate(p).empty());
    p.initial.shape = InitialShape::static_equilibrium;
    EXPECT_TRUE(has(validate(p), "initial.contact", true));
    p.initial.shape = InitialShape::straight;
    p.cam.reset();
    EXPECT_TRUE(has(validate(p), "initial.contact", true));
}

}  // namespace
}  // namespace beamcam::sim::testing
