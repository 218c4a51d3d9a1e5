// Extrema, peaks of contact and the error of the energy balance against dense sampling of the same motion.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "tests/sanitizers.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim {
namespace {

using namespace testing;

constexpr double kShare = 1e-5;    // of the channel's range
constexpr double kErrors = 1e-11;  // in SI units: less is an error of the integration, as are gaps in sustained contact

std::vector<double> instants(double from, double to, int count) {
    std::vector<double> times;
    for (int k = 0; k <= count; ++k) times.push_back(from + (to - from) * k / count);
    return times;
}

std::vector<Channel> searched_channels(const Problem& problem) {
    std::vector<Channel> channels = all_channels(problem);
    const bool cam = problem.cam.has_value();
    std::erase_if(channels, [&](Channel c) {
        if (traits(c.kind).of_mode && c.index > 2) return true;  // the others may have too little energy
        if (c.kind == ChannelKind::contact_s) return true;       // jumps at the mark on the disc
        if (c.kind == ChannelKind::stress_x || c.kind == ChannelKind::pivot_angle) return true;  // jump as well
        return c.kind == ChannelKind::energy_residual || (!cam && traits(c.kind).needs_cam);
    });
    return channels;
}

Table sampled(const Problem& problem, const std::vector<Channel>& channels, std::vector<double> times) {
    Request request;
    request.tables.push_back({std::move(times), channels});
    return simulate(problem, request).tables.front();
}

// A magnitude has a corner where it is nearly zero, which no parabola finds.
bool is_magnitude(Channel c) {
    return c.kind == ChannelKind::stress_max || c.kind == ChannelKind::pivot_force ||
           c.kind == ChannelKind::tip_acceleration;
}

// Samples never exceed an extremum, and at its instant they reach it.
void expect_true_extrema(const Problem& problem, double end, int count, const std::vector<Channel>& channels) {
    Request request;
    request.end_time = end;
    request.extrema = channels;
    request.tables.push_back({instants(0, end, count), channels});
    const Result found = simulate(problem, request);
    const Table& dense = found.tables.front();
    std::vector<double> own;  // where the extrema are said to be
    for (const Extremum& e : found.extrema)
        for (const double t : {e.t_min, e.t_max}) own.push_back(t);
    const Table there = sampled(problem, channels, own);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Extremum& e = found.extrema[c];
        const auto [low, high] = std::ranges::minmax(dense.values[c]);
        const double share = std::max(kShare * (e.max - e.min), kErrors);
        if (!is_magnitude(channels[c])) {
            EXPECT_GE(low, e.min - share) << name(channels[c]) << " at " << e.t_min << " of " << e.min;
        }
        EXPECT_LE(high, e.max + share) << name(channels[c]) << " at " << e.t_max << " of " << e.max;
        const double at_min = there.values[c][2 * c], at_max = there.values[c][2 * c + 1];
        if (problem.contact.model == ContactModel::restitution) continue;  // jumps at an impact
        EXPECT_NEAR(at_min, e.min, share) << name(channels[c]) << " at " << e.t_min;
        EXPECT_NEAR(at_max, e.max, share) << name(channels[c]) << " at " << e.t_max;
    }
}

void expect_true_extrema(const Problem& problem, double end, int count) {
    expect_true_extrema(problem, end, count, searched_channels(problem));
}

Problem turning_cam(ModelKind model, int modes, double speed = 10) {
    Problem p;
    p.beam.model = model;
    p.beam.modes = modes;
    p.cam->speed = speed;
    return p;
}

TEST(Extrema, OfTwoModesExceedEverySample) { expect_true_extrema(turning_cam(ModelKind::first_order, 2), 0.5, 12'000); }

TEST(Extrema, OfEightModesExceedEverySample) {
    expect_true_extrema(turning_cam(ModelKind::first_order, 8), 0.4, 8'000);
}

TEST(Extrema, OfFortyModesExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    const Problem p = turning_cam(ModelKind::first_order, 40);
    std::vector<Channel> channels = searched_channels(p);
    std::erase_if(channels, [](Channel c) { return traits(c.kind).accelerated; });  // half a millisecond each
    expect_true_extrema(p, 0.28, 4'000, channels);
}

TEST(Extrema, OfAlmostElasticContactExceedEverySample) {
    Problem p = turning_cam(ModelKind::first_order, 6);
    p.contact.restitution = 0.98;
    expect_true_extrema(p, 0.5, 8'000);
}

TEST(Extrema, OfARigidBeamExceedEverySample) { expect_true_extrema(turning_cam(ModelKind::rigid, 2), 0.5, 8'000); }

TEST(Extrema, OfADampedBeamExceedEverySample) {
    Problem p = turning_cam(ModelKind::first_order, 6);
    p.beam.damping_ratio = {0.01};
    expect_true_extrema(p, 0.5, 12'000);
}

TEST(Extrema, OfThePapersModelExceedEverySample) { expect_true_extrema(turning_cam(ModelKind::paper, 3), 0.5, 12'000); }

TEST(Extrema, OfTheSecondOrderModelExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    expect_true_extrema(turning_cam(ModelKind::second_order, 2), 0.35, 6'000);
}

TEST(Extrema, OfTheExactModelExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    expect_true_extrema(turning_cam(ModelKind::exact, 2), 0.35, 5'000);
}

TEST(Extrema, OfClampedShapesExceedEverySample) {
    Problem p = turning_cam(ModelKind::first_order, 3);
    p.beam.basis = Basis::cantilever;
    expect_true_extrema(p, 0.4, 8'000);
}

TEST(Extrema, OfEightClampedShapesExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    Problem p = turning_cam(ModelKind::first_order, 8);
    p.beam.basis = Basis::cantilever;
    p.hub.inertia = 0.02;
    expect_true_extrema(p, 0.33, 5'000);
}

TEST(Extrema, OfManyShapesOfTheNonlinearModelsExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    for (const ModelKind kind : {ModelKind::second_order, ModelKind::exact}) {
        SCOPED_TRACE(name(kind));
        expect_true_extrema(turning_cam(kind, 5), 0.33, 4'000);
    }
}

// A soft beam bends so far that the terms which the modal models leave out are seen.
TEST(Extrema, OfASoftBeamExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    for (const ModelKind kind : {ModelKind::second_order, ModelKind::exact}) {
        SCOPED_TRACE(name(kind));
        Problem p = turning_cam(kind, 3);
        p.beam.youngs_modulus /= 40;
        expect_true_extrema(p, 0.45, 4'000);
    }
}

// ζ up to about one, and far beyond: some modes only decay.
TEST(Extrema, OfStronglyDampedBeamsExceedEverySample) {
    for (const double time : {1e-4, 1e-2}) {
        SCOPED_TRACE(time);
        for (const ModelKind kind : {ModelKind::first_order, ModelKind::exact}) {
            Problem p = turning_cam(kind, kind == ModelKind::exact ? 3 : 6);
            p.beam.kelvin_voigt = time;
            expect_true_extrema(p, 0.4, 4'000);
        }
    }
}

TEST(Extrema, OfAPrescribedHubExceedEverySample) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        SCOPED_TRACE(name(kind));
        Problem p = turning_cam(kind, 2);
        p.cam.reset();
        p.hub.drive = SpinUp{6, 0.3};
        expect_true_extrema(p, 0.5, 6'000);
    }
}

// Behind the axis the beam's shortening adds to the inertia what it takes from it in front: no definite form.
TEST(Extrema, OfABeamThatReachesBehindTheAxisExceedEverySample) {
    for (const auto& [modes, rtol] : {std::pair{2, 1e-6}, std::pair{4, 1e-4}}) {
        SCOPED_TRACE(modes);
        Problem p = turning_cam(ModelKind::first_order, modes);
        p.hub.radius = -0.3;
        set_tolerance(p, rtol);
        expect_true_extrema(p, 0.5, 8'000);
    }
}

// The place on the disc that is nearest to the beam turns back where the foot reaches an end of the beam.
TEST(Extrema, OfAFootThatReachesAnEndExceedEverySample) {
    Problem p = turning_cam(ModelKind::first_order, 2, -0.5);
    p.cam->centre.x = 0.6;
    p.initial.angular_velocity = 4;
    set_tolerance(p, 1e-3);
    expect_true_extrema(p, 0.4, 8'000);
}

TEST(Extrema, OfImpulsiveContactAndRestExceedEverySample) {
    Problem p = turning_cam(ModelKind::first_order, 2, 3);
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0.2;
    expect_true_extrema(p, 1.2, 8'000);
}

TEST(Extrema, OfImpactsOfManyModesExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    Problem p = turning_cam(ModelKind::first_order, 8);
    p.contact.model = ContactModel::restitution;
    p.contact.friction = CoulombFriction{0.3, 1e-2};
    expect_true_extrema(p, 0.4, 40'000);
}

TEST(Extrema, OfStickSlipExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    Problem p = turning_cam(ModelKind::first_order, 2);
    p.contact.friction = StickSlipFriction{0.4, {}, {}};
    expect_true_extrema(p, 0.35, 8'000);
}

// The energy of the bristle is not that of the gap, and vibration fades within steps.
TEST(Extrema, OfStickSlipOfAnOverdampedBeamExceedEverySample) {
    Problem p = turning_cam(ModelKind::first_order, 3, 4.7);
    p.beam.basis = Basis::cantilever;
    p.beam.damping_ratio = {15};
    p.hub.inertia = 0.5;
    p.cam->phase = 4.2;
    p.hub.drive = ConstantTorque{0.03};
    p.contact.damping = DampingLaw::none;
    p.contact.stiffness = 1.36e5;
    p.contact.offset.reset();
    p.contact.friction = StickSlipFriction{0.8, {}, {}};
    p.initial.angle = 0.526;
    p.initial.q = {0.005, -1e-5, 3e-4};
    expect_true_extrema(p, 0.45, 18'000);
}

// A run that fails still has the extrema up to there.
TEST(Extrema, OfARunThatFailsEndBeforeIt) {
    Problem p = turning_cam(ModelKind::first_order, 8);
    p.beam.basis = Basis::cantilever;
    Request request;
    request.end_time = 0.33;
    request.extrema = {channel("theta"), channel("contact_force")};
    try {
        simulate(p, request);
        FAIL() << "the inertia of these shapes is lost";
    } catch (const SolverError& error) {
        ASSERT_EQ(error.partials.size(), 1u);
        EXPECT_GE(error.partials[0].extrema[0].max, extremum(p, "theta", 0.26).max);
    }
}

TEST(Extrema, OfAFootAtEitherEndOfABentBeamExceedEverySample) {
    for (const double behind : {0.3, -0.3}) {
        SCOPED_TRACE(behind);
        Problem p = turning_cam(ModelKind::first_order, 4, -5);
        p.hub.radius = 0.05;
        p.hub.inertia = 0.02;
        p.cam->centre = {behind > 0 ? -behind : p.beam.length - behind, -0.2};
        p.initial.angle = 0.3;
        p.initial.q = {0.02, 0.01, 0.004};
        expect_true_extrema(p, 0.1, 8'000);
    }
}

// All modes in vibration.
Problem in_free_vibration() {
    Problem p = turning_cam(ModelKind::first_order, 8, 0);
    p.cam.reset();
    p.initial.q = {0.01, 0.002, 0.0005, 0.0002, 0.0001, 0.00005, 0.00003, 0.00002};
    return p;
}

TEST(Extrema, OfADistantCamExceedEverySample) {
    for (const double radius : {0.0, 0.1, -0.05}) {
        SCOPED_TRACE(radius);
        Problem p = in_free_vibration();
        p.cam.emplace();
        p.cam->centre = {1.6, 0.4};
        p.cam->speed = 4;
        p.hub.radius = radius;
        expect_true_extrema(p, 0.2, 8'000);
        p.hub.drive = ConstantSpeed{5};
        expect_true_extrema(p, 0.2, 8'000);
    }
}

// Steps that are short for the first mode, since the seventh vibrates 100 times as fast.
TEST(Extrema, OfASlowModeInShortStepsExceedEverySample) {
    Problem p;
    p.beam.model = ModelKind::zeroth_order;
    p.beam.modes = 7;
    p.cam.reset();
    p.hub.inertia = 0.5;
    p.hub.drive = ConstantSpeed{4.808593094110538};
    p.initial.q = {0.007743934249292256,   -0.0008039743069694741, 0.00011674824031824195, 2.647342872103063e-05,
                   -6.686612206856651e-07, 2.422253802766727e-05,  1.1389944818373878e-05};
    expect_true_extrema(p, 0.6, 60'000);
}

TEST(Extrema, OfFreeVibrationExceedEverySample) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order}) {
        SCOPED_TRACE(name(kind));
        Problem p = turning_cam(kind, 6);
        p.cam.reset();
        p.initial.q = {0.02, 0.01, 0.004, 0.002, 0.001, 0.0005};
        expect_true_extrema(p, 0.2, 10'000);
    }
}

// A beam that follows the cam without leaving it.
Problem held_on_cam(ModelKind model, int modes, double speed) {
    Problem p = turning_cam(model, modes, speed);
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0;
    p.initial.shape = InitialShape::resting;
    return p;
}

TEST(Extrema, OfSustainedImpulsiveContactExceedEverySample) {
    Problem p = held_on_cam(ModelKind::first_order, 4, 2);
    expect_true_extrema(p, 0.4, 8'000);
    p.contact.friction = CoulombFriction{0.3, 1e-2};
    expect_true_extrema(p, 0.4, 8'000);
}

// So stiff and damped that its rates are below the tolerance while the force follows the torque.
TEST(Extrema, OfABeamAtRestUnderATorqueExceedEverySample) {
    Problem p = turning_cam(ModelKind::first_order, 1, 0);
    p.beam.youngs_modulus = 7e14;
    p.beam.damping_ratio = {1};
    p.contact.stiffness = 1e10;
    p.initial.shape = InitialShape::resting;
    p.hub.drive = HarmonicTorque{0.1, 3, 0};
    p.solver.rtol = 1e-4;
    p.solver.atol = 1e-6;
    Request request;
    request.end_time = 2;
    request.extrema = {{ChannelKind::contact_force}, {ChannelKind::gap}};
    const Result found = simulate(p, request);
    const Table dense = sampled(p, request.extrema, instants(0, 2, 20'000));
    for (std::size_t c = 0; c < request.extrema.size(); ++c) {
        const auto [low, high] = std::ranges::minmax(dense.values[c]);
        const double share = 1e-3 * (high - low);
        EXPECT_GE(low, found.extrema[c].min - share) << name(request.extrema[c]);
        EXPECT_LE(high, found.extrema[c].max + share) << name(request.extrema[c]);
    }
    ASSERT_FALSE(found.impacts.empty());
    EXPECT_NEAR(-found.extrema[1].min, found.impacts.front().penetration_peak, 1e-12);
}

TEST(Extrema, OfOtherMethodsExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    for (const Method method : {Method::rk8, Method::cvode_adams, Method::cvode_bdf}) {
        Problem p = turning_cam(ModelKind::first_order, 2);
        p.solver.method = method;
        SCOPED_TRACE(name(method));
        expect_true_extrema(p, 0.4, 5'000);
    }
}

// A beam shortly before it falls onto the cam: one to forty shapes, no damping or by Kelvin and Voigt up to 1 s,
// compliant or impulsive contact; or one that vibrates freely, without a cam.
Problem random_scene(Dice& dice) {
    constexpr int kModes[] = {1, 2, 3, 5, 8, 12, 20, 40};
    for (;;) {
        Problem p;
        p.beam.modes = kModes[dice.one_of(8)];
        p.beam.model = dice.one_of(5) == 0 ? ModelKind::zeroth_order : ModelKind::first_order;
        if (dice.one_of(3) == 0) p.beam.kelvin_voigt = std::pow(10, dice.between(-6, 0));
        if (dice.one_of(3) == 0) p.beam.youngs_modulus *= std::pow(10, dice.between(-1.5, 0));
        p.hub.inertia = dice.one_of(2) ? 0.02 : 0;
        p.initial.angular_velocity = dice.between(-3, -0.3);
        if (dice.one_of(4) == 0) {
            p.cam.reset();
            for (int i = 1; i <= std::min(p.beam.modes, 8); ++i) p.initial.q.push_back(dice.about_zero(0.02 / (i * i)));
            if (dice.one_of(3) == 0) p.hub.drive = ConstantSpeed{dice.about_zero(6)};
            return p;
        }
        Cam& cam = *p.cam;
        cam.centre = {dice.between(0.2, 0.7), dice.about_zero(0.1)};
        cam.speed = dice.about_zero(30);
        cam.phase = dice.about_zero(3);
        const Vec2 disc = cam.centre + cam.eccentricity * unit(cam.phase);
        p.initial.angle = std::atan2(disc.y, disc.x) + std::asin(cam.radius / norm(disc)) + dice.between(0.0005, 0.01);
        if (dice.one_of(2)) p.contact.model = ContactModel::restitution;
        p.contact.stiffness = std::pow(10, dice.between(6, 9));
        p.contact.restitution = dice.between(0.1, 0.95);
        if (is_plain(p)) return p;
    }
}

// No value of the motion at 100 kHz exceeds an extremum by more than 1e-5 of the channel's range, and the extremum is a
// value of the motion.
TEST(Extrema, OfRandomScenesExceedEverySample) {
    SKIP_UNDER_SANITIZERS();
    constexpr double kRate = 1e5;
    Dice dice(1);
    for (int scene = 0; scene < 200; ++scene) {
        SCOPED_TRACE(scene);
        const Problem p = random_scene(dice);
        std::vector<Channel> channels = searched_channels(p);
        const auto costly = [](Channel c) {
            return row(c.kind).unit == std::string_view("J") || traits(c.kind).accelerated;
        };
        if (scene % 5 != 0) std::erase_if(channels, costly);
        const double end = p.beam.modes > 12 ? 0.008 : 0.02;  // [s]; many modes are slow to sample
        expect_true_extrema(p, end, static_cast<int>(end * kRate), channels);
    }
}

// One mode without weight: the amplitude, and with damping what is left of it after half a period.
TEST(Extrema, OfAFreeVibrationAreItsAmplitude) {
    Problem p = in_free_vibration();
    p.gravity = 0;
    p.beam.model = ModelKind::zeroth_order;
    p.beam.modes = 1;
    p.hub.drive = ConstantSpeed{0};
    p.initial.q = {0.01};
    set_tolerance(p, 1e-10);
    const Extremum undamped = extremum(p, "q1", 0.5);
    EXPECT_NEAR(undamped.max, 0.01, 1e-9);
    EXPECT_NEAR(undamped.min, -0.01, 1e-9);
    const double ratio = 0.2;
    p.beam.damping_ratio = {ratio};
    const double overshoot = std::exp(-std::numbers::pi * ratio / std::sqrt(1 - ratio * ratio));
    EXPECT_NEAR(extremum(p, "q1", 0.5).min, -0.01 * overshoot, 1e-9);
}

TEST(Extrema, OfARigidBeamUnderAConstantTorqueAreThoseOfAParabola) {
    Problem p = turning_cam(ModelKind::rigid, 1);
    p.cam.reset();
    p.gravity = 0;
    p.hub.drive = ConstantTorque{-0.5};
    p.initial.angle = 0.3;
    p.initial.angular_velocity = 2;
    const double inertia = p.beam.line_density() * std::pow(p.beam.length, 3) / 3, pull = 0.5 / inertia;
    const Extremum angle = extremum(p, "theta", 1);
    EXPECT_NEAR(angle.max, 0.3 + 2 * 2 / (2 * pull), 1e-9);
    EXPECT_NEAR(angle.t_max, 2 / pull, 1e-6);
}

// Each touch of this flexible beam has several peaks of force; those of the sixth impact differ by 1e-5.
Problem six_impacts() {
    Problem p;
    p.hub.radius = 0.1;
    p.beam.modes = 6;
    p.cam->centre = {0.36030778472619396, -0.05185487813803117};
    p.cam->radius = 0.09852167861119288;
    p.cam->eccentricity = 0.01944668691081597;
    p.cam->speed = 10.651245072893802;
    p.cam->phase = 2.8970932986672304;
    p.contact.stiffness = 7424492848.708854;
    p.contact.damping = DampingLaw::none;
    p.initial.angle = 0.7362831534330934;
    p.initial.angular_velocity = -0.6994435681443056;
    return p;
}

void expect_peaks_of_dense_sampling(const Problem& p, const Result& r) {
    for (const Impact& impact : r.impacts) {
        const Table dense = sampled(p, {channel("contact_force"), channel("gap")},
                                    instants(impact.t_start, impact.t_end.value_or(0.29), 20'000));
        const double force = std::ranges::max(dense.values[0]), depth = -std::ranges::min(dense.values[1]);
        EXPECT_NEAR(force, *impact.force_peak, kShare * force) << impact.t_start;
        EXPECT_NEAR(depth, impact.penetration_peak, kShare * depth) << impact.t_start;
    }
}

TEST(ContactPeaks, AreThoseOfDenseSampling) {
    SKIP_UNDER_SANITIZERS();
    const Problem p = six_impacts();
    const Result r = run(p, 0.29);
    ASSERT_GE(r.impacts.size(), 6u);
    EXPECT_NEAR(*r.impacts[5].force_peak, 1237.51, 0.01);  // a neighbour is 1237.4922
    expect_peaks_of_dense_sampling(p, r);
}
// The instants of the largest force of each collision, and of the largest deflection from it to the next.
TEST(ContactPeaks, OfCollisionsAndTheBendAfterThemAreAtTheirInstants) {
    const Problem p;  // of two collisions
    Request request;
    request.end_time = 1.2, request.bends = true;
    const Result found = simulate(p, request);
    ASSERT_GE(found.collisions.size(), 2u);
    for (std::size_t i = 0; i < found.collisions.size(); ++i) {
        const Collision& each = found.collisions[i];
        const double next = i + 1 < found.collisions.size() ? found.collisions[i + 1].t_start : found.end_time;
        const Table at =
            sampled(p, {{ChannelKind::contact_force}, {ChannelKind::tip_deflection}}, {*each.t_peak, *each.t_bend});
        EXPECT_NEAR(at.values[0][0], *each.force_peak, 1e-6 * *each.force_peak);
        const Table dense = sampled(p, {{ChannelKind::tip_deflection}}, instants(each.t_start, next, 20'000));
        double most = 0;
        for (const double v : dense.values[0]) most = std::max(most, std::fabs(v));
        EXPECT_GE(std::fabs(at.values[1][1]), most * (1 - 1e-9));
        EXPECT_GE(*each.t_bend, each.t_start);
        EXPECT_LE(*each.t_bend, next);
    }
    EXPECT_FALSE(simulate(turning_cam(ModelKind::rigid, 1), request).collisions.front().t_bend);
}

TEST(ContactPeaks, CostNothingUnlessRequested) {
    const Problem p = six_impacts();
    Request all, none;
    all.end_time = none.end_time = 0.29;
    none.impact_peaks = false;
    const Request both[] = {none, all};
    const std::vector<Result> r = simulate(p, both);
    const Result alone = simulate(p, none);
    ASSERT_EQ(r[0].impacts.size(), r[1].impacts.size());
    EXPECT_NEAR(*r[1].impacts[5].force_peak, 1237.51, 0.01);
    for (const Impact& impact : r[0].impacts) {
        EXPECT_FALSE(impact.force_peak);
        EXPECT_TRUE(std::isnan(impact.penetration_peak));
    }
    EXPECT_EQ(*r[0].impacts[5].t_end, *r[1].impacts[5].t_end);
    EXPECT_EQ(*alone.impacts[5].t_end, *r[1].impacts[5].t_end);
    EXPECT_FALSE(alone.collisions[0].force_peak);
}

TEST(ContactPeaks, OfOtherModelsAreThoseOfDenseSampling) {
    SKIP_UNDER_SANITIZERS();
    for (const ModelKind kind : {ModelKind::second_order, ModelKind::exact}) {
        Problem p = six_impacts();
        p.beam.model = kind;
        const Result r = run(p, 0.29);
        ASSERT_FALSE(r.impacts.empty());
        expect_peaks_of_dense_sampling(p, r);
    }
}

TEST(EnergyBalance, IsWatchedWithinSteps) {
    for (const int modes : {2, 6}) {
        for (const Method method : {Method::automatic, Method::rk8}) {
            Problem p = turning_cam(ModelKind::first_order, modes);
            p.solver.method = method;
            Request request;
            request.end_time = 0.5;
            request.extrema = {channel("energy_residual")};
            const Result r = simulate(p, request);
            const Table dense = sampled(p, {channel("energy_residual")}, instants(0, 0.5, 20'000));
            double largest = 0;
            for (const double value : dense.values[0]) largest = std::max(largest, std::fabs(value));
            EXPECT_GE(std::max(r.extrema[0].max, -r.extrema[0].min), 0.99 * largest) << modes << " " << name(method);
        }
    }
}

// Sustained contact ends where the force of its constraint vanishes, but for rounding.
TEST(Extrema, AContactForceIsNotNegative) {
    Problem p;
    p.beam.modes = 4;
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0;
    Request request;
    request.end_time = 1;
    request.extrema = {channel("contact_force")};
    EXPECT_EQ(simulate(p, request).extrema[0].min, 0);
}

}  // namespace
}  // namespace beamcam::sim
