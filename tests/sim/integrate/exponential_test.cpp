// The exponential collocation: its oscillators against closed forms, its flights and contacts against the Runge–Kutta
// method at tight tolerance.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "sim/base/numerics.hpp"
#include "sim/integrate/gap_probe.hpp"
#include "sim/integrate/inertia_forces.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/integrate/nodal_step.hpp"
#include "tests/sanitizers.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// ---- oscillators ---------------------------------------------------------------------------------

// ∫₀^τ s(τ−u) uʲ/j! du by quadrature of resolved pieces.
double response_by_quadrature(const Oscillator& o, double tau, int j) {
    const double square = o.omega * o.omega - o.gamma * o.gamma, turning = std::sqrt(std::fabs(square));
    const int pieces = 1 + static_cast<int>((o.omega + 2 * o.gamma) * tau);
    const auto impulse = [&](double t) {
        if (turning == 0) return t * std::exp(-o.gamma * t);
        if (square > 0) return std::exp(-o.gamma * t) * std::sin(turning * t) / turning;
        return std::exp((turning - o.gamma) * t) * -std::expm1(-2 * turning * t) / (2 * turning);
    };
    const Quadrature rule = gauss_legendre(20, tau / pieces);
    double total = 0;
    for (int p = 0; p < pieces; ++p)
        for (Eigen::Index k = 0; k < rule.x.size(); ++k) {
            const double u = p * tau / pieces + rule.x[k];
            total += rule.w[k] * impulse(tau - u) * std::pow(u, j) / std::tgamma(j + 1);
        }
    return total;
}

TEST(Oscillators, AnswerPowersOfTimeExactly) {
    for (const double ratio : {0.0, 0.01, 0.5, 0.9, 1.0, 1.01, 1.05, 3.0, 40.0})
        for (const double omega_tau : {0.0, 1e-3, 0.5, 1.9, 2.1, 7.0, 60.0}) {
            const double tau = 0.004;
            const Oscillator o{omega_tau / tau, ratio * omega_tau / tau};
            double r[kResponse];
            respond(o, tau, r);
            for (int j = 0; j < kNodes; ++j) {
                const double expected = response_by_quadrature(o, tau, j);
                // What is lost by the recursion is lost against the response to a constant.
                const double scale =
                    decays(o) ? expected : response_by_quadrature({0, 0}, tau, j) / (1 + omega_tau * omega_tau);
                EXPECT_NEAR(r[2 + j], expected, 1e-12 * scale) << ratio << " " << omega_tau << " " << j;
            }
        }
}

TEST(Oscillators, NoDampingMakesTheirAnswersOverflow) {
    for (const double gamma : {1.0, 1e12, 1e13, 1e20, 1e30, 1e33})
        for (const double omega : {1.0, 1e3, 1e6})
            for (const double tau : {0.0, 1e-300, 1e-31, 1e-20, 1e-9, 1.0}) {
                double r[kResponse];
                respond(Oscillator{omega, gamma}, tau, r);
                for (int j = 0; j < kResponse; ++j)
                    ASSERT_TRUE(std::isfinite(r[j]))
                        << "g" << j - 2 << ", γ " << gamma << ", ω " << omega << ", τ " << tau;
                if (tau == 0) {
                    EXPECT_EQ(r[0], 1);
                    for (int j = 1; j < kResponse; ++j) EXPECT_EQ(r[j], 0);
                }
            }
}

TEST(Oscillators, StepsAreExactForAPolynomialForcing) {
    // f = 5 + 3u − 2u³ in the step's own time, as eight nodal values; end and nodes.
    const double h = 0.003;
    std::vector<Oscillator> oscillators{{0, 0}, {300, 0}, {3000, 40}, {2e5, 0}, {300, 290}, {300, 400}, {3000, 3e6}};
    StepTable table;
    table.build(oscillators, h);
    const Collocation& gauss = Collocation::get();
    for (std::size_t i = 0; i < oscillators.size(); ++i) {
        const StepTable::Row& row = table.rows[i];
        const double q0 = 0.7, v0 = -20;
        double nodal[kNodes];
        for (int l = 0; l < kNodes; ++l) nodal[l] = 5 + 3 * gauss.c[l] - 2 * std::pow(gauss.c[l], 3);
        const auto exact = [&](double t) {
            double r[kResponse];
            respond(oscillators[i], t, r);
            return (r[0] + 2 * oscillators[i].gamma * r[1]) * q0 + r[1] * v0 + 5 * r[2] + 3 / h * r[3] -
                   12 / (h * h * h) * r[5];
        };
        for (int k = 0; k < kNodes; ++k) {
            double q = row.qq[k] * q0 + row.qv[k] * v0;
            for (std::size_t l = 0; l < kNodes; ++l) q += row.q[l][k] * nodal[l];
            EXPECT_NEAR(q, exact(gauss.c[k] * h), 1e-13) << i << " " << k;
        }
        double end = row.end_qq * q0 + row.end_qv * v0;
        for (int l = 0; l < kNodes; ++l) end += row.end_q[l] * nodal[l];
        EXPECT_NEAR(end, exact(h), 1e-13) << i;
    }
}

// f = 1 − 2u, u from 0 to 1 in the step: without vibration q = (f − 2γḟ/ω²)/ω², and it stays so.
TEST(Oscillators, WithoutVibrationFollowAPolynomialForcing) {
    const double h = 0.02;
    const Collocation& gauss = Collocation::get();
    const Lanes f = 1 - 2 * gauss.c;
    for (const double ratio : {0.0, 0.05, 0.1}) {
        const Oscillator o{1000, 1000 * ratio};
        StepTable table;
        table.build({o}, h);
        const StepTable::Row& row = table.rows[0];
        const double w2 = o.omega * o.omega, slope = -2 / h;
        const auto steady = [&](double force) { return (force - 2 * o.gamma * slope / w2) / w2; };
        const double q = sum(row.steady * f), v = sum(row.steady_rate * f);
        EXPECT_NEAR(q, steady(1), 1e-12 / w2);
        EXPECT_NEAR(v, slope / w2, 1e-12 * o.omega / w2);
        EXPECT_NEAR(row.end_qq * q + row.end_qv * v + sum(row.end_q * f), steady(-1), 1e-12 / w2);
    }
}

// A step whose forces are no numbers must not pass for an exact one.
TEST(NodalErrors, OfWhatIsNoNumberAreNoNumbers) {
    Lanes nodal = Lanes{} + 1;
    nodal[3] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(interpolation_error(nodal)));
    for (const double rounding : {0.0, 1.0}) EXPECT_TRUE(std::isnan(quadrature_error(nodal, rounding)));
    EXPECT_EQ(quadrature_error(Lanes{} + 1, 1e-12), 0);
}

// ---- gap -----------------------------------------------------------------------------------------

TEST(GapProbe, SeesWhatTheContactIs) {
    Dice dice(3);
    int expanded = 0;
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::zeroth_order, ModelKind::rigid, ModelKind::paper,
                                 ModelKind::second_order, ModelKind::exact})
        for (const int modes : {1, 3, 12}) {
            Problem p;
            p.beam.model = kind;
            p.beam.modes = modes;
            p.hub.radius = 0.02;
            System system(p), alone(p);
            GapProbe probe(system);
            std::vector<double> y(static_cast<std::size_t>(system.size));
            const auto n = static_cast<std::size_t>(system.coordinates());
            double angle = 0.5;
            for (int k = 0; k < 60; ++k) {
                angle += 0.02 * dice.about_zero(1);
                y[0] = angle;
                y[n] = dice.about_zero(5);
                for (std::size_t i = 1; i < n; ++i) {
                    y[i] = dice.about_zero(2e-3) / std::pow(static_cast<double>(i), 4);
                    y[n + i] = dice.about_zero(0.5);
                }
                const double t = 0.01 * k;
                const ContactState is = alone.contact(t, y.data()), seen = probe.evaluate(t, y.data());
                if (is.at_end) continue;
                ++expanded;
                EXPECT_NEAR(seen.gap, is.gap, 1e-13) << modes;
                EXPECT_NEAR(seen.gap_rate, is.gap_rate, 1e-10) << modes;
                EXPECT_NEAR(seen.x, is.x, 1e-9) << modes;
            }
        }
    EXPECT_GT(expanded, 600);
}

// ---- inertia -------------------------------------------------------------------------------------

// At the accelerations of the model itself only bending holds inertia and gravity.
TEST(InertiaForces, AreThoseOfTheModelAtEveryNode) {
    Dice dice(5);
    Problem p;
    p.beam.model = ModelKind::exact;
    p.beam.modes = 5;
    p.hub.radius = 0.1;
    p.hub.inertia = 0.3;
    const std::unique_ptr<Model> model = make_model(p);
    InertiaForces inertia(p);
    const Eigen::Index n = model->size();
    std::vector<Lanes> position(static_cast<std::size_t>(n)), rate = position, acceleration = position,
                                                              forces = position;
    Lanes sine, cosine;
    Eigen::MatrixXd bending(n, kNodes);
    const Eigen::MatrixXd stiffness = model->linearize().stiffness;
    for (int k = 0; k < kNodes; ++k) {
        Eigen::VectorXd xi(n), dxi(n), f(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const double size = i == 0 ? 1 : 0.1 / std::pow(static_cast<double>(i), 3);
            xi[i] = dice.about_zero(size);
            dxi[i] = dice.about_zero(10 * size);
        }
        model->set(xi.data(), dxi.data());
        ASSERT_TRUE(model->assemble(f.data()));
        model->solve(f.data());
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto entry = static_cast<std::size_t>(i);
            position[entry][k] = xi[i];
            rate[entry][k] = dxi[i];
            acceleration[entry][k] = f[i];
        }
        sine[k] = std::sin(xi[0]);
        cosine[k] = std::cos(xi[0]);
        bending.col(k) = stiffness * xi;
    }
    inertia.evaluate(
        {rate[0], acceleration[0], position.data() + 1, rate.data() + 1, acceleration.data() + 1, sine, cosine},
        forces.data());
    for (int k = 0; k < kNodes; ++k)
        for (Eigen::Index i = 0; i < n; ++i)
            EXPECT_NEAR(forces[static_cast<std::size_t>(i)][k], -bending(i, k), 1e-12 * bending.col(k).norm()) << i;
}

// ---- flight --------------------------------------------------------------------------------------

struct Flight {
    std::string name;
    Problem problem;
    bool spans_vibration = true;  // rather than being left to Runge and Kutta's method
};

struct Flights : std::vector<Flight> {
    void add(const std::string& name, ModelKind kind, int modes, const std::function<void(Problem&)>& change) {
        Problem p = falling_beam(kind, Basis::automatic, modes);
        p.beam.youngs_modulus = 5e9;
        change(p);
        push_back({name, p});
    }
};

Flights flights() {
    Flights all;
    const auto nothing = [](Problem&) {};
    all.add("rigid", ModelKind::rigid, 2, nothing);
    all.add("zeroth-order", ModelKind::zeroth_order, 3, nothing);
    all.add("first-order", ModelKind::first_order, 6, nothing);
    all.add("hub", ModelKind::first_order, 3, [](Problem& p) {
        p.hub.radius = 0.15;
        p.hub.inertia = 0.02;
        p.initial.angular_velocity = -3;
    });
    all.add("static start", ModelKind::first_order, 4,
            [](Problem& p) { p.initial.shape = InitialShape::static_equilibrium; });
    all.add("damped", ModelKind::first_order, 5, [](Problem& p) { p.beam.damping_ratio = {0.02, 0.1, 0.45, 0.3, 0}; });
    all.add("overdamped", ModelKind::first_order, 6,
            [](Problem& p) { p.beam.damping_ratio = {0.6, 1, 1.2, 30, 0, 3}; });
    all.add("overdamped spin-up", ModelKind::first_order, 3, [](Problem& p) {
        p.hub.drive = SpinUp{6, 0.2};
        p.beam.damping_ratio = {2, 50, 5};
    });
    all.add("overdamped torque", ModelKind::first_order, 3, [](Problem& p) {
        p.hub.drive = HarmonicTorque{1, 4, 0.3};
        p.beam.damping_ratio = {1.5, 20, 4};
    });
    all.add("creeping", ModelKind::first_order, 2, [](Problem& p) { p.beam.kelvin_voigt = 0.3; });
    all.add("Kelvin–Voigt", ModelKind::first_order, 4, [](Problem& p) { p.beam.kelvin_voigt = 1e-5; });
    all.add("torque", ModelKind::first_order, 3, [](Problem& p) { p.hub.drive = ConstantTorque{0.8}; });
    all.add("swinging torque", ModelKind::first_order, 3, [](Problem& p) { p.hub.drive = HarmonicTorque{1, 4, 0.3}; });
    all.add("torque table", ModelKind::first_order, 3, [](Problem& p) {
        p.hub.drive = TorqueTable{{0, 0.11, 0.2}, {1, -1, 2}};
    });
    all.add("spin-up", ModelKind::first_order, 3, [](Problem& p) { p.hub.drive = SpinUp{6, 0.2}; });
    all.add("damped spin-up", ModelKind::zeroth_order, 3, [](Problem& p) {
        p.hub.drive = SpinUp{3, 0.2};
        p.beam.damping_ratio = {0.05};
    });
    all.add("constant speed", ModelKind::first_order, 4, [](Problem& p) { p.hub.drive = ConstantSpeed{2}; });
    all.add("angle table", ModelKind::first_order, 2, [](Problem& p) {
        p.hub.drive = AngleTable{{0, 0.1, 0.25}, {0.5, 0.7, 0.4}};
    });
    return all;
}

// The coupling of `exact` is not given by arrays.
Flights flights_of_exact() {
    Flights all;
    const auto add = [&](const std::string& name, int modes, const std::function<void(Problem&)>& change) {
        all.add("exact" + name, ModelKind::exact, modes, [&](Problem& p) {
            p.beam.youngs_modulus = 68.952e9;
            change(p);
        });
    };
    add("", 4, [](Problem&) {});
    add(", damped", 3, [](Problem& p) { p.beam.damping_ratio = {0.02}; });
    add(", torque", 3, [](Problem& p) {
        p.hub.drive = HarmonicTorque{1, 4, 0.3};
        p.beam.kelvin_voigt = 1e-5;
    });
    add(", spin-up", 4, [](Problem& p) {
        p.hub.drive = SpinUp{3, 0.2};
        p.beam.damping_ratio = {0.01};
    });
    add(", angle table", 2, [](Problem& p) {
        p.hub.radius = 0.15;
        p.hub.drive = AngleTable{{0, 0.1, 0.25}, {0.5, 0.7, 0.4}};
    });
    add(", bending far", 2, [](Problem& p) { p.beam.youngs_modulus = 5e8; });
    all.back().spans_vibration = false;
    return all;
}

void expect_those_of_runge_and_kutta(const Flights& flights) {
    for (const Flight& flight : flights) {
        std::vector<double> times;
        for (int k = 1; k <= 60; ++k) times.push_back(0.3 * k / 60);
        Request request;
        request.tables.push_back({times,
                                  {channel("theta"), channel("theta_dot"), channel("tip_deflection"),
                                   channel("loss_structural"), channel("work_drive"), channel("energy_residual")}});
        Problem p = flight.problem;
        p.solver.rtol = 1e-10;
        p.solver.atol = 1e-13;
        p.solver.method = Method::automatic;
        const Result fast = simulate(p, request);
        p.solver.rtol = 1e-12;
        p.solver.atol = 1e-15;
        p.solver.method = Method::rk8;
        const Result slow = simulate(p, request);
        if (p.beam.model != ModelKind::rigid && flight.spans_vibration) {
            EXPECT_LT(fast.counters.steps, slow.counters.steps / 2) << flight.name;
        }
        for (std::size_t c = 0; c < 5; ++c) {
            double size = c < 3 ? 1e-6 : 1e-3 * slow.energy_scale;  // energies are parts of one sum
            for (const double value : slow.tables[0].values[c]) size = std::max(size, std::fabs(value));
            for (std::size_t row = 0; row < times.size(); ++row)
                EXPECT_NEAR(fast.tables[0].values[c][row], slow.tables[0].values[c][row], 2e-8 * size)
                    << flight.name << ", " << name(slow.tables[0].channels[c]) << " at " << times[row];
        }
        for (const double residual : fast.tables[0].values[5])
            EXPECT_LT(std::fabs(residual), 1e-8 * fast.energy_scale) << flight.name;
        EXPECT_LT(fast.energy_residual_max, 1e-9 * fast.energy_scale) << flight.name;
    }
}
TEST(ExponentialFlight, AgreesWithRungeKuttaAtEveryInstant) { expect_those_of_runge_and_kutta(flights()); }
TEST(ExponentialFlight, OfExactAgreesWithRungeKuttaAtEveryInstant) {
    SKIP_UNDER_SANITIZERS();
    expect_those_of_runge_and_kutta(flights_of_exact());
}

// Nothing but the work of the drive limits the steps of a rigid beam whose angle is given.
TEST(ExponentialFlight, BalancesTheEnergyOfAFastPrescribedHub) {
    for (const double speed : {12.0, 40.0, 300.0}) {
        Problem p = falling_beam(ModelKind::rigid, Basis::automatic, 1);
        p.hub.drive = SpinUp{speed, 0.2};
        p.solver.rtol = 1e-8;
        const Result r = run(p, 5);
        EXPECT_LT(r.energy_residual_max, p.solver.rtol * r.energy_scale) << speed;
    }
}

TEST(ExponentialFlight, SpansManyPeriodsOfVibration) {
    Problem p = falling_beam(ModelKind::first_order, Basis::hub_beam, 20);
    p.solver.rtol = 1e-5;
    p.solver.atol = 1e-8;
    const Result r = run(p, 0.36);
    System system(p);
    EXPECT_LT(static_cast<double>(r.counters.steps), 1e-2 * 0.36 * system.highest_frequency());
}

TEST(ExponentialFlight, IsNotSlowedByADamperAtTheHub) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::exact})
        for (const double damping : {0.5, 2.0}) {
            Problem p = falling_beam(kind, Basis::automatic, 3);
            p.hub.spring = HubSpring{.stiffness = 10, .damping = damping};
            p.solver.method = Method::rk8;
            const double truth = series(p, "tip_deflection", {0.7}).front();
            p.solver.method = Method::automatic;
            p.solver.rtol = 1e-8;
            p.solver.atol = 1e-11;
            EXPECT_NEAR(series(p, "tip_deflection", {0.7}).front(), truth, 1e-9) << name(kind) << damping;
            EXPECT_LT(run(p, 1).counters.steps, 600) << name(kind) << damping;
        }
}

// A soft beam: its modes turn by less than half a radian in the first step, which is short because it is the first.
TEST(ExponentialFlight, TakesSoftBeamsOfEveryModelAndHub) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::exact})
        for (const bool held : {false, true})
            for (const Basis basis : {Basis::automatic, Basis::cantilever}) {
                if (basis == Basis::cantilever && (kind == ModelKind::exact || !held)) continue;
                Problem p = falling_beam(kind, basis, 3);
                p.beam.length = 8;
                p.hub.inertia = 300;
                p.beam.damping_ratio = {0.01};
                if (held) p.hub.drive = SpinUp{4, 15};
                p.gravity = 0;
                p.initial = {0, held ? 0.0 : 0.5, InitialShape::straight};
                const Result r = run(p, 2);
                EXPECT_EQ(r.steps_by_method.size(), 1u) << name(kind) << held;
                EXPECT_EQ(r.steps_by_method.front().first, Method::automatic) << name(kind) << held;
                EXPECT_LT(r.energy_residual_max, p.solver.rtol * r.energy_scale) << name(kind) << held;
            }
}

TEST(ExponentialFlight, FindsEveryTurningPointOfASwingingHub) {
    for (const double modulus : {2e9, 68.952e9}) {  // strong ripple, and hardly any
        Problem p = falling_beam(ModelKind::first_order, Basis::automatic, 3);
        p.beam.youngs_modulus = modulus;
        p.hub.inertia = 0.01;
        const auto turns = [&](Method method, double rtol) {
            p.solver.method = method;
            p.solver.rtol = rtol;
            p.solver.atol = 1e-3 * rtol;
            Request request;
            request.end_time = 4;
            request.apexes = request.zero_crossings = true;
            return simulate(p, request);
        };
        const Result fast = turns(Method::automatic, 1e-9), slow = turns(Method::rk8, 1e-11);
        ASSERT_GE(slow.apexes.size(), 1u);
        ASSERT_GE(slow.theta_zero.size(), 3u);
        ASSERT_EQ(fast.apexes.size(), slow.apexes.size()) << modulus;
        ASSERT_EQ(fast.theta_zero.size(), slow.theta_zero.size()) << modulus;
        for (std::size_t i = 0; i < slow.apexes.size(); ++i) EXPECT_NEAR(fast.apexes[i].t, slow.apexes[i].t, 1e-6);
        for (std::size_t i = 0; i < slow.theta_zero.size(); ++i)
            EXPECT_NEAR(fast.theta_zero[i].t, slow.theta_zero[i].t, 1e-7);
    }
}

// What the search for touches relies on, sampled inside long steps of soft beams that turn fast. The bounds of the
// frame and those of the vibration together bound the motion of every point.
TEST(ExponentialFlight, KeepsTheBoundsThatItPromises) {
    constexpr int kSamples = 60, kPoints = 5;
    constexpr double kSlack = 1 + 1e-9;
    Dice dice(5);
    int steps = 0, finite = 0, fast = 0;
    for (int repeat = 0; repeat < 48; ++repeat) {
        const bool exact = repeat % 2 == 1;
        Problem p = falling_beam(exact             ? ModelKind::exact
                                 : repeat % 8 == 0 ? ModelKind::zeroth_order
                                                   : ModelKind::first_order,
                                 Basis::automatic, 1 + dice.one_of(4));
        if (!exact) p.beam.youngs_modulus *= std::pow(10, dice.between(-3, 0));
        p.hub.radius = dice.between(-0.3, 0.5);
        p.hub.inertia = std::pow(10, dice.between(-3, 1));
        p.gravity = dice.about_zero(20);
        if (dice.one_of(2)) p.hub.drive = HarmonicTorque{dice.about_zero(5), dice.between(0, 5), 1};
        if (dice.one_of(4) == 0) p.hub.drive = SpinUp{dice.about_zero(10), 0.1};
        if (dice.one_of(3) == 0) p.beam.kelvin_voigt = std::pow(10, dice.between(-7, exact ? -4 : -2));
        System system(p);
        const double rtol = std::pow(10, dice.between(-8, -3)), reach = std::fabs(p.hub.radius) + p.beam.length;
        const auto integrator = make_exponential(system, rtol, 1e-3 * rtol);
        std::vector<double> y(static_cast<std::size_t>(system.size));
        const auto n = static_cast<std::size_t>(system.coordinates());
        const double size = exact ? std::pow(10, dice.between(-3, -0.5)) : 0.05;
        y[0] = dice.about_zero(3);
        y[n] = dice.about_zero(10);
        for (std::size_t i = 1; i < n; ++i) {
            y[i] = dice.about_zero(size / static_cast<double>(i * i));
            y[n + i] = dice.about_zero(60 * size / static_cast<double>(i));
        }
        integrator->start(0, y.data());
        for (int step = 0; step < 25; ++step) {
            const Segment& segment = integrator->step();
            const auto b = segment.bounds();
            ASSERT_TRUE(b);
            ++steps;
            if (std::isfinite(b->theta_ddot)) ++finite;
            EXPECT_EQ(std::isfinite(b->theta_dot), std::isfinite(b->theta_ddot)) << repeat;
            const double h = segment.t1 - segment.t0, dt = h / kSamples;
            if (system.highest_frequency() * h > 14) ++fast;
            const double speed = b->theta_dot * reach + b->deflection_speed, rounding = 1e-12 * (speed + 1);
            const double point = b->deflection_acceleration + b->theta_ddot * reach +
                                 2 * b->theta_dot * b->deflection_speed + b->theta_dot * b->theta_dot * reach;
            std::array<BeamPoint, kPoints> before;
            double spin = 0;
            for (int k = 0; k <= kSamples; ++k) {
                const double t = segment.t0 + k * dt;
                segment.value(t, y.data());
                system.set_state(t, y.data());
                if (!exact) {  // whose bounds are those of another frame than Θ
                    EXPECT_LE(std::fabs(y[n]), kSlack * b->theta_dot) << repeat;
                    if (k > 0) {
                        EXPECT_LE(std::fabs(y[n] - spin), kSlack * b->theta_ddot * dt + rounding) << repeat;
                    }
                    spin = y[n];
                }
                for (std::size_t i = 0; i < kPoints; ++i) {
                    BeamPoint c;
                    system.model().point(p.beam.length * static_cast<double>(i) / (kPoints - 1), c);
                    EXPECT_LE(norm(c.v), kSlack * speed + rounding) << repeat;
                    if (k > 0) {
                        EXPECT_LE(norm(c.v - before[i].v), kSlack * point * dt + rounding) << repeat;
                    }
                    EXPECT_LE(norm(c.v1), kSlack * (b->theta_dot + b->slope_speed) + rounding) << repeat;
                    EXPECT_LE(norm(c.r2), kSlack * b->curvature + rounding) << repeat;
                    before[i] = c;
                }
            }
        }
    }
    EXPECT_GT(finite, steps / 2);
    EXPECT_GT(fast, 100);
}

// Between its nodes a polynomial of degree seven may exceed its nodal values 4.5 times.
TEST(ExponentialFlight, BoundsAPolynomialBetweenItsNodes) {
    constexpr int kPlaces = 1000;
    constexpr double kSlack = 1 + 1e-12;
    Dice dice(31);
    double overshoot = 0;
    for (int repeat = 0; repeat < 300; ++repeat) {
        Lanes nodal;
        for (int k = 0; k < kNodes; ++k) nodal[k] = repeat == 0 ? (k % 2 ? 1 : -1) : dice.about_zero(1);
        const LegendreRange range = legendre_range(nodal);
        double before = 0;
        for (int i = 0; i <= kPlaces; ++i) {
            double p[kNodes], value = 0;
            legendre(2.0 * i / kPlaces - 1, kNodes, p);
            for (std::size_t j = 0; j < kNodes; ++j) value += p[j] * sum(Collocation::get().legendre[j] * nodal);
            EXPECT_LE(std::fabs(value - range.mean), kSlack * range.spread) << repeat;
            const double change = i > 0 ? std::fabs(value - before) : 0;
            EXPECT_LE(change * kPlaces, kSlack * range.slope) << repeat;
            before = value;
            if (repeat == 0) overshoot = std::max(overshoot, std::fabs(value));
        }
    }
    EXPECT_GT(overshoot, 4);
}

// ---- contact -------------------------------------------------------------------------------------

TEST(ExponentialContact, StepsOverStrongDamping) {
    for (const double ratio : {0.9, 1.3, 40.0}) {
        Problem p;
        p.beam.damping_ratio = {ratio, 2 * ratio};
        p.solver.rtol = 3e-9;
        p.solver.atol = 3e-12;
        Request request;
        std::vector<double> times;
        for (int k = 1; k <= 30; ++k) times.push_back(0.02 * k);
        request.tables.push_back({times, {channel("theta"), channel("loss_structural"), channel("tip_deflection")}});
        const Result fast = simulate(p, request);
        p.solver.rtol = 1e-11;
        p.solver.atol = 1e-14;
        p.solver.method = Method::rk8;
        const Result slow = simulate(p, request);
        EXPECT_LT(fast.counters.steps, 200) << ratio;
        EXPECT_LT(fast.energy_residual_max, 1e-8 * fast.energy_scale) << ratio;
        ASSERT_EQ(fast.impacts.size(), slow.impacts.size()) << ratio;
        for (std::size_t c = 0; c < 3; ++c) {
            double size = 0;
            for (const double value : slow.tables[0].values[c]) size = std::max(size, std::fabs(value));
            for (std::size_t row = 0; row < times.size(); ++row)
                EXPECT_NEAR(fast.tables[0].values[c][row], slow.tables[0].values[c][row], 1e-6 * size)
                    << ratio << ", " << c << " at " << times[row];
        }
    }
}

TEST(ExponentialContact, WhatItDoesNotCoverStepsOverStrongDampingToo) {
    SKIP_UNDER_SANITIZERS();
    const auto lean = [](auto&& change) {
        Problem p;
        p.beam.damping_ratio = {1000};
        change(p);
        const Result r = run(p, 0.5);
        EXPECT_LT(r.counters.steps, 5000) << name(p.beam.model);
        EXPECT_GE(r.impacts.size(), 1u) << name(p.beam.model);
        EXPECT_LT(r.energy_residual_max, 10 * p.solver.rtol * r.energy_scale) << name(p.beam.model);
    };
    lean([](Problem& p) { p.beam.model = ModelKind::second_order; });
    lean([](Problem& p) { p.beam.model = ModelKind::exact; });
    lean([](Problem& p) { p.beam.basis = Basis::cantilever; });
    lean([](Problem& p) { p.contact.friction = StickSlipFriction{0.3, {}, {}}; });
}

// A valid scene of any kind that the method covers in contact too.
Problem random_covered_contact(unsigned seed) {
    Dice dice(seed);
    for (;;) {
        const int kind = dice.one_of(4);
        Problem p = random_problem(dice, kind == 0   ? ModelKind::rigid
                                         : kind == 1 ? ModelKind::zeroth_order
                                                     : ModelKind::first_order);
        if (dice.one_of(3) == 0) p.hub.drive = HarmonicTorque{0.2, dice.between(0, 5), 0};
        if (dice.one_of(3) == 0) p.beam.damping_ratio = {dice.between(0, 0.2)};
        if (dice.one_of(3) == 0) p.contact.friction = CoulombFriction{dice.between(0, 0.5), 1e-3};
        if (dice.one_of(3) == 0) p.contact.offset = dice.between(0, 0.02);
        if (is_plain(p)) return p;
    }
}

// A random contact of a beam of the model `exact`.
Problem random_contact_of_exact(unsigned seed) {
    for (;; seed += 1000) {
        Problem p = random_covered_contact(seed);
        Dice dice(seed + 17);
        p.beam.modes = 1 + dice.one_of(4);
        p.beam.damping_ratio.resize(std::min<std::size_t>(p.beam.damping_ratio.size(), 1));
        p.beam.model = ModelKind::exact;
        if (seed % 4 == 0) p.hub.drive = ConstantSpeed{-1};
        if (is_plain(p)) return p;
    }
}

Result solve(Problem p, Method method, double rtol, double end, const std::vector<double>& times = {}) {
    p.solver.method = method;
    p.solver.rtol = rtol;
    p.solver.atol = 1e-3 * rtol;
    Request request;
    request.end_time = end;
    if (!times.empty()) request.tables.push_back({times, {channel("theta"), channel("energy_residual")}});
    return simulate(p, request);
}

int seeds(int quick) { return std::getenv("BEAMCAM_LONG") ? 10 * quick : quick; }

void expect_the_impacts_of_runge_and_kutta(Problem (*random)(unsigned), int count) {
    int compared = 0;
    for (int seed = 1; seed <= count; ++seed) {
        const Problem p = random(static_cast<unsigned>(seed));
        const Result slow = solve(p, Method::rk8, 1e-11, 0.35), fast = solve(p, Method::automatic, 1e-10, 0.35);
        // Up to the third impact or 10 ms after the first: beyond, errors of 1e-11 have grown.
        for (std::size_t i = 0; i < std::min<std::size_t>(slow.impacts.size(), 3); ++i) {
            const Impact &a = slow.impacts[i], &b = fast.impacts.at(i);
            if (a.t_start > slow.impacts[0].t_start + 0.01) break;
            ++compared;
            const double rate = std::fabs(slow.impacts[0].v_n_before);
            EXPECT_NEAR(b.t_start, a.t_start, 1e-8) << seed;
            EXPECT_NEAR(b.v_n_before, a.v_n_before, 1e-5 * rate) << seed;
            EXPECT_NEAR(b.x, a.x, 1e-7) << seed;
            ASSERT_EQ(a.t_end.has_value(), b.t_end.has_value()) << seed;
            if (!a.t_end) continue;
            EXPECT_NEAR(*b.t_end, *a.t_end, 1e-6) << seed;
            EXPECT_NEAR(*b.v_n_after, *a.v_n_after, 1e-4 * rate) << seed;
            EXPECT_NEAR(*b.force_peak, *a.force_peak, 1e-4 * *a.force_peak + 1e-3) << seed;
            EXPECT_NEAR(b.penetration_peak, a.penetration_peak, 1e-4 * a.penetration_peak) << seed;
            EXPECT_NEAR(b.impulse_n, a.impulse_n, 1e-5 * a.impulse_n) << seed;
            EXPECT_NEAR(b.impulse_t, a.impulse_t, 1e-4 * a.impulse_n) << seed;
            EXPECT_NEAR(b.energy_lost, a.energy_lost, 1e-5 * slow.energy_scale) << seed;
        }
    }
    EXPECT_GT(compared, count / 2);
}
TEST(ExponentialContact, HasTheImpactsOfRungeKutta) {
    expect_the_impacts_of_runge_and_kutta(random_covered_contact, seeds(8));
}
TEST(ExponentialContact, OfExactHasTheImpactsOfRungeKutta) {
    SKIP_UNDER_SANITIZERS();
    expect_the_impacts_of_runge_and_kutta(random_contact_of_exact, seeds(8));
}
// A contact takes far fewer steps than the fastest mode has radians.
TEST(ExponentialContact, OfExactStepsOverVibration) {
    Problem p;
    p.beam.model = ModelKind::exact;
    p.beam.modes = 12;
    const Result r = solve(p, Method::automatic, 1e-5, 0.4);
    ASSERT_FALSE(r.impacts.empty());
    ASSERT_EQ(r.steps_by_method.size(), 1u);
    EXPECT_EQ(r.steps_by_method[0].first, Method::automatic);
    System system(p);
    EXPECT_LT(static_cast<double>(r.counters.steps), 0.1 * 0.4 * system.highest_frequency());
}

// `auto` is Runge and Kutta's method where the shapes are coupled through the inertia, and implicit if they are damped
// beyond the critical.
TEST(ExponentialContact, LeavesCoupledShapesToOtherMethods) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::paper, ModelKind::second_order}) {
        Problem p;
        p.beam.model = kind;
        p.beam.basis = Basis::cantilever;
        p.beam.modes = 2;
        for (const double ratio : {0.02, 1.5}) {
            p.beam.damping_ratio = {ratio};
            const Result r = solve(p, Method::automatic, 1e-6, 0.3);
            ASSERT_EQ(r.steps_by_method.size(), 1u) << name(kind);
            EXPECT_EQ(r.steps_by_method[0].first, ratio < 1 ? Method::rk8 : Method::cvode_bdf) << name(kind);
        }
    }
}

// Rounding of a penetration of ten micrometres is 1e-11 of its force. Steps that tried to resolve it would be a hundred
// times as many.
TEST(ExponentialContact, DoesNotResolveTheRoundingOfItsForce) {
    SKIP_UNDER_SANITIZERS();
    Problem p;
    p.initial.shape = InitialShape::resting;
    p.cam->speed = 1;
    const std::vector<double> times{1, 2, 3, 4};
    const Result exact = solve(p, Method::rk8, 1e-12, 4, times);
    for (const double rtol : {1e-10, 1e-11}) {
        const Result r = solve(p, Method::automatic, rtol, 4, times);
        EXPECT_LT(r.counters.steps, 10'000) << rtol;
        for (std::size_t i = 0; i < times.size(); ++i)
            EXPECT_NEAR(r.tables[0].values[0][i], exact.tables[0].values[0][i], 3 * rtol) << rtol << " " << times[i];
    }
}

// Nor that of the time: from 1024 s on its steps were twelve times as short.
TEST(ExponentialContact, DoesNotResolveTheRoundingOfTheTime) {
    Problem p;
    p.solver.method = Method::automatic;
    const long before = run(p, 1000).counters.steps, after = run(p, 1100).counters.steps;
    EXPECT_LT(after - before, before / 5);
}

// After an impact the vibration of a strongly damped beam decays before the first node of a long step. What it does to
// the hub through a damper counts all the same.
TEST(ExponentialFlight, CountsVibrationThatDecaysBeforeTheFirstNode) {
    Problem p;
    p.beam.length = 0.1;
    p.beam.section = Rectangle{0.02, 0.01};
    p.beam.material = Material::steel;
    p.beam.modes = 1;
    p.beam.damping_ratio = {0.7};
    p.hub.spring = HubSpring{.damping = 0.002};
    p.cam->centre = {0.04, 0};
    p.cam->radius = 0.015;
    p.cam->eccentricity = 0.003;
    p.cam->speed = 2 * std::numbers::pi;
    p.contact.stiffness.reset();
    p.contact.exponent.reset();
    p.initial.angle = std::numbers::pi / 3;
    const Result exact = solve(p, Method::rk8, 1e-10, 0.24);
    for (const double rtol : {1e-5, 1e-6, 1e-7, 1e-8}) {
        const Result r = solve(p, Method::automatic, rtol, 0.24);
        EXPECT_LT(r.energy_residual_max, rtol * r.energy_scale) << rtol;
        EXPECT_LT(r.counters.steps, 3000) << rtol;
        ASSERT_GE(r.impacts.size(), 3u);
        EXPECT_NEAR(*r.impacts[2].force_peak / *exact.impacts[2].force_peak, 1, 2 * rtol) << rtol;
    }
}

// Steps estimate their errors within a small factor: of 360 motions two exceed 3 rtol, by flights at 1e-6.
TEST(ExponentialContact, KeepsTheLedger) {
    for (int seed = 1; seed <= seeds(12); ++seed) {
        const Problem p = seed % 3 == 0 ? random_contact_of_exact(static_cast<unsigned>(seed))
                                        : random_covered_contact(static_cast<unsigned>(seed));
        for (const double rtol : {1e-4, 1e-6, 1e-9}) {
            const Result r = solve(p, Method::automatic, rtol, 0.5);
            EXPECT_LT(r.energy_residual_max, 5 * rtol * r.energy_scale) << seed << " " << rtol;
        }
    }
}

TEST(ExponentialContact, ServesEveryExponent) {
    // Without dissipation the ledger is the energy.
    for (const double n : {1.0, 1.1, 1.4, 1.75, 2.0}) {
        Problem p;
        p.contact.exponent = n;
        p.contact.stiffness = std::pow(10, 4 + 2.5 * n);
        p.contact.damping = DampingLaw::none;
        const std::vector<double> times{0.29, 0.3, 0.31};
        const Result exact = solve(p, Method::rk8, 1e-12, 0.32, times), slow = solve(p, Method::rk8, 1e-9, 0.32),
                     fast = solve(p, Method::automatic, 1e-9, 0.32, times);
        ASSERT_FALSE(exact.impacts.empty()) << n;
        EXPECT_EQ(fast.impacts.size(), exact.impacts.size()) << n;
        EXPECT_LT(3 * fast.counters.steps, slow.counters.steps) << n;
        EXPECT_LT(fast.energy_residual_max, 1e-9 * fast.energy_scale) << n;
        for (std::size_t i = 0; i < times.size(); ++i)
            EXPECT_NEAR(fast.tables[0].values[0][i], exact.tables[0].values[0][i], 2e-8) << n << " " << times[i];
    }
}

TEST(ExponentialContact, ADriveHoldsWhatTheContactPushes) {
    // The work of a prescribed hub includes that against the cam.
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::exact}) {
        Problem p;
        p.beam.model = kind;
        p.hub.drive = ConstantSpeed{-2};
        p.initial = {0.4, 0, InitialShape::straight};
        p.solver.method = Method::automatic;
        const Result r = run(p, 0.04);
        ASSERT_FALSE(r.impacts.empty()) << name(kind);
        EXPECT_EQ(r.steps_by_method.size(), 1u) << name(kind);
        EXPECT_GT(r.energy_scale, 1) << name(kind);
        EXPECT_LT(r.energy_residual_max, 10 * p.solver.rtol * r.energy_scale) << name(kind);
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
