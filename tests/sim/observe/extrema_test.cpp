// Extrema, peaks of contact and the error of the energy balance against dense sampling of the same motion.
#include <algorithm>
#include <cmath>

#include "tests/sanitizers.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim {
namespace {

using namespace testing;

constexpr double kShare = 1e-9;  // of the largest magnitude: the search leaves out ten times less

std::vector<double> instants(double from, double to, int count) {
    std::vector<double> times;
    for (int k = 0; k <= count; ++k) times.push_back(from + (to - from) * k / count);
    return times;
}

std::vector<Channel> searched_channels(const Problem& problem) {
    std::vector<Channel> channels = all_channels(problem);
    const bool cam = problem.cam.has_value();
    std::erase_if(channels, [&](Channel c) {
        if (c.kind == ChannelKind::q_dot) return true;  // no output has extrema of them, so they have no bounds
        return c.kind == ChannelKind::energy_residual || (!cam && traits(c.kind).needs_cam);
    });
    return channels;
}

Table sampled(const Problem& problem, const std::vector<Channel>& channels, std::vector<double> times) {
    Request request;
    request.tables.push_back({std::move(times), channels});
    return simulate(problem, request).tables.front();
}

// Samples never exceed an extremum, and near its instant they reach it.
void expect_true_extrema(const Problem& problem, double end, int count) {
    const std::vector<Channel> channels = searched_channels(problem);
    Request request;
    request.end_time = end;
    request.extrema = channels;
    const Result found = simulate(problem, request);
    const Table dense = sampled(problem, channels, instants(0, end, count));
    std::vector<double> own;  // where the extrema are said to be
    for (const Extremum& e : found.extrema)
        for (const double t : {e.t_min, e.t_max}) own.push_back(t);
    const Table there = sampled(problem, channels, own);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Extremum& e = found.extrema[c];
        const auto [low, high] = std::ranges::minmax(dense.values[c]);
        // What should be zero is rounding, in sustained contact that of the gap.
        const double zero = problem.contact.model == ContactModel::restitution ? 2e-13 : kShare * 1e-6;
        const double share = std::max({kShare * std::fabs(e.min), kShare * std::fabs(e.max), zero});
        EXPECT_GE(low, e.min - share) << name(channels[c]) << " at " << e.t_min << " of " << e.min;
        EXPECT_LE(high, e.max + share) << name(channels[c]) << " at " << e.t_max << " of " << e.max;
        const double at_min = there.values[c][2 * c], at_max = there.values[c][2 * c + 1];
        if (channels[c].kind == ChannelKind::contact_s) continue;          // jumps at the mark on the disc
        if (problem.contact.model == ContactModel::restitution) continue;  // jumps at an impact
        EXPECT_NEAR(at_min, e.min, share) << name(channels[c]) << " at " << e.t_min;
        EXPECT_NEAR(at_max, e.max, share) << name(channels[c]) << " at " << e.t_max;
    }
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
    expect_true_extrema(turning_cam(ModelKind::first_order, 40), 0.28, 4'000);
}

// Fast vibration goes on, so that the bounds of most steps in flight exceed the extrema.
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

// The energy of the bristle is not that of the gap; parts of a step in which vibration fades are bounded again.
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
    request.extrema = all_channels(p);
    try {
        simulate(p, request);
        FAIL() << "the inertia of these shapes is lost";
    } catch (const SolverError& error) {
        ASSERT_EQ(error.partials.size(), 1u);
        EXPECT_GE(error.partials[0].extrema[1].max, extremum(p, "theta", 0.26).max);
    }
}

// The search after the last step asks whether to go on, too.
TEST(Extrema, AreSearchedUntilInterrupted) {
    const Problem p = turning_cam(ModelKind::first_order, 20);
    Request request;
    request.end_time = 0.5;
    request.extrema = all_channels(p);
    long at_end = 0;
    const Progress stop_at_end = [&](double t) { return t < 0.5 || ++at_end < 2; };
    EXPECT_THROW(simulate(p, request, stop_at_end), Interrupted);
}

// How often the searches of the channels may be interrupted: once for each 256 evaluations.
long searches_times_256(const Problem& problem, double end, std::vector<Channel> channels) {
    Request request;
    request.end_time = end;
    request.extrema = std::move(channels);
    Request motion;
    motion.end_time = end;
    motion.impact_peaks = false;
    const auto polls = [&](const Request& of) {
        long count = 0;
        simulate(problem, of, [&](double) { return ++count > 0; });
        return count;
    };
    return polls(request) - polls(motion);
}

// A beam that hangs away from the cam is nearest to it at its root all along.
TEST(Extrema, OfAFootThatStaysAtAnEndNeedNoSearch) {
    Problem p = turning_cam(ModelKind::first_order, 8);
    p.cam->centre = {0.25, 0.3};
    p.initial.angle = -1.4;
    p.initial.q = {0.01};
    EXPECT_LE(searches_times_256(p, 0.5, {{ChannelKind::contact_x}, {ChannelKind::separation}}), 2);
}

// The same of a beam that bends much, and of the gap, in which bending matters no more than at the root.
TEST(Extrema, OfAFootThatBendingCannotMoveFromAnEndNeedNoSearch) {
    Problem p = turning_cam(ModelKind::first_order, 8, 0);
    p.cam->centre = {0.25, 2};
    p.initial.angle = -1;
    p.initial.q = {0.02, 0.01, 0.004, 0.002, 0.001, 0.0005, 0.0003, 0.0002};
    EXPECT_LE(searches_times_256(p, 0.1, {{ChannelKind::contact_x}, {ChannelKind::gap}, {ChannelKind::separation}}), 4);
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

// A polynomial through the nodes of a step is steeper than vibration that they do not resolve.
TEST(Extrema, OfAnEstimateAreBoundedByItsModes) {
    Problem p = turning_cam(ModelKind::first_order, 8);
    p.cam.reset();
    p.initial.q = {0.02, 0.01, 0.004, 0.002, 0.001, 0.0005, 0.0003, 0.0002};
    EXPECT_LE(searches_times_256(p, 0.5, {{ChannelKind::tip_deflection}}), 250);
}

// The nodes of a step are known beside a prescribed hub, too, and the energies of the modes there.
TEST(Extrema, OnAHubAtConstantSpeedAreBoundedByNodes) {
    Problem p = turning_cam(ModelKind::first_order, 8);
    p.cam.reset();
    p.hub.drive = ConstantSpeed{3};
    p.initial.q = {0.02, 0.01, 0.004, 0.002, 0.001, 0.0005, 0.0003, 0.0002};
    EXPECT_LE(searches_times_256(p, 0.5, {{ChannelKind::theta_dot}, {ChannelKind::tip_rate}}), 4);
    EXPECT_LE(searches_times_256(p, 0.5, {{ChannelKind::energy_elastic}, {ChannelKind::energy_kinetic}}), 60);
    p.hub.drive = FreeDrive{};
    EXPECT_LE(searches_times_256(p, 0.5, {{ChannelKind::energy_elastic}}), 10);
}

// A beam that hangs almost straight down is hardly turned by its weight.
TEST(Extrema, OfTheSeparationAreBoundedByTheAngleOfTheWeight) {
    Problem p = turning_cam(ModelKind::first_order, 8, 1);
    p.cam->centre = {0.1, -2.5};
    p.initial.angle = -1.5;
    EXPECT_LE(searches_times_256(p, 1, {{ChannelKind::separation}}), 60);
}

// In sustained impulsive contact the gap is zero but for rounding.
TEST(Extrema, OfRoundingAreNotSearched) {
    Problem p = turning_cam(ModelKind::first_order, 8, -4);
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0.2;
    EXPECT_LE(searches_times_256(p, 1.2, {{ChannelKind::gap}}), 20);
}

// In free fall from rest the two terms of the separation cancel but for the vibration of the beam.
TEST(Extrema, OfTermsThatCancelAreSearchedToTheirRounding) {
    Problem p = turning_cam(ModelKind::second_order, 12, 0);
    p.beam.length = 0.4218972468561271;
    p.hub.radius = 0.0637391231415792;
    p.hub.inertia = 0.6571014186244172;
    p.cam->centre = {0.12535745030722154, -0.0743356430720854};
    p.cam->radius = 0.050865309490653814;
    p.cam->eccentricity = 0.007699867944892149;
    p.cam->phase = 1.5902823026188275;
    p.initial.angle = 0.7016651464462649;
    p.beam.damping_ratio = {0.049104706207544487};
    p.solver.rtol = 1e-10;
    EXPECT_LE(searches_times_256(p, 0.6, {{ChannelKind::separation}, {ChannelKind::separation_paper}}), 40);
}

// Undamped vibration comes near its extrema again and again; the steps between impacts are many and short.
TEST(Extrema, OfManyUndampedModesNeedFewSearches) {
    SKIP_UNDER_SANITIZERS();
    Problem p = turning_cam(ModelKind::first_order, 20, 0);
    p.contact.model = ContactModel::restitution;
    const std::vector<Channel> channels{{ChannelKind::theta_dot},
                                        {ChannelKind::tip_rate},
                                        {ChannelKind::gap},
                                        {ChannelKind::separation},
                                        {ChannelKind::friction_force}};
    EXPECT_LE(searches_times_256(p, 0.5, channels), 40);
}

// The crests of an undamped mode are enumerated.
TEST(Extrema, OfUndampedModesNeedNoEvaluationBetweenCrests) {
    SKIP_UNDER_SANITIZERS();
    std::vector<Channel> modes;
    for (int k = 1; k <= 20; ++k) modes.push_back({ChannelKind::q, k});
    Problem p = turning_cam(ModelKind::first_order, 20, 28.9);
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0.2;
    p.beam.length = 0.3445;
    p.beam.youngs_modulus = 64.7e9;
    p.cam->centre = {0.1523, 0.01285};
    p.cam->radius = 0.02334;
    p.cam->eccentricity = 0.00443;
    p.cam->phase = 5.666;
    p.initial.angle = 0.939;
    EXPECT_LE(searches_times_256(p, 0.6, modes), 1500);
}

// All modes in vibration: their amplitudes hardly change, and most steps of the run come near the extrema.
Problem in_free_vibration() {
    Problem p = turning_cam(ModelKind::first_order, 8, 0);
    p.cam.reset();
    p.initial.q = {0.01, 0.002, 0.0005, 0.0002, 0.0001, 0.00005, 0.00003, 0.00002};
    return p;
}

TEST(Extrema, OfSteadyVibrationNeedFewSearches) {
    SKIP_UNDER_SANITIZERS();
    const std::vector<Channel> modes{
        {ChannelKind::q, 5}, {ChannelKind::q, 6}, {ChannelKind::q, 7}, {ChannelKind::q, 8}};
    EXPECT_LE(searches_times_256(in_free_vibration(), 2, modes), 400);
}

// Their coordinates are sums of natural modes.
TEST(Extrema, OfCoupledCoordinatesAreBoundedByAllModes) {
    Problem p = turning_cam(ModelKind::first_order, 8, 0);
    p.cam.reset();
    p.beam.basis = Basis::cantilever;
    p.hub.inertia = 0.5;
    EXPECT_LE(searches_times_256(p, 0.5, {{ChannelKind::q, 6}, {ChannelKind::q, 8}}), 20);
}

// The weight turns the hub towards one side at each angle, and with the contact at the root not at all.
TEST(Extrema, OfTheSeparationAreBoundedByTheSignOfTheWeight) {
    Problem p = turning_cam(ModelKind::first_order, 8, 0);
    p.cam->centre = {3, 0};
    p.hub.drive = ConstantSpeed{3};
    EXPECT_LE(searches_times_256(p, 2, {{ChannelKind::separation}, {ChannelKind::separation_paper}}), 30);
}

// The gap of a beam that points away from a distant cam is bounded by its root, without an evaluation.
TEST(Extrema, OfADistantCamNeedFewSearches) {
    Problem p = in_free_vibration();
    p.cam.emplace();
    p.cam->centre = {3, 0};
    EXPECT_LE(searches_times_256(p, 3, {{ChannelKind::gap}, {ChannelKind::contact_x}}), 20);
}

TEST(Extrema, OfADistantCamExceedEverySample) {
    for (const double radius : {0.0, 0.1, -0.05}) {
        SCOPED_TRACE(radius);
        Problem p = in_free_vibration();
        p.cam.emplace();
        p.cam->centre = {1.6, 0.4};
        p.cam->speed = 4;
        p.hub.radius = radius;
        expect_true_extrema(p, 0.5, 20'000);
        p.hub.drive = ConstantSpeed{5};
        expect_true_extrema(p, 0.5, 20'000);
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
        expect_true_extrema(p, 0.4, 20'000);
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

TEST(Extrema, OfABeamAtRestNeedNoSearch) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order}) {
        SCOPED_TRACE(name(kind));
        const Problem p = held_on_cam(kind, 8, 0);
        EXPECT_LE(searches_times_256(p, 1, searched_channels(p)), 20);
    }
    Problem p = turning_cam(ModelKind::second_order, 12, 0);  // compliant contact
    p.hub.radius = 0;
    p.initial.shape = InitialShape::resting;
    p.contact.offset = 0.5 * beam_depth(p.beam);
    p.contact.friction = CoulombFriction{0.5, 1e-3};
    EXPECT_LE(searches_times_256(p, 0.05, searched_channels(p)), 20);
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
        EXPECT_LE(force, *impact.force_peak * (1 + kShare)) << impact.t_start;
        EXPECT_LE(depth, impact.penetration_peak * (1 + kShare)) << impact.t_start;
        EXPECT_NEAR(force, *impact.force_peak, 2e-6 * force) << impact.t_start;
        EXPECT_NEAR(depth, impact.penetration_peak, 2e-6 * depth) << impact.t_start;
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
            // It is flat at its largest, and searched to 1e-3.
            EXPECT_GE(std::max(r.extrema[0].max, -r.extrema[0].min), 0.998 * largest) << modes << " " << name(method);
        }
    }
}

}  // namespace
}  // namespace beamcam::sim
