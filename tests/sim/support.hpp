// What the tests of the mechanics share: named problems, seeded random ones, differences, and the
// contents of a model that its interface only implies.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "sim/beam/model.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/problem/keys.hpp"
#include "sim/run/simulate.hpp"
#include "tests/sanitizers.hpp"

namespace beamcam::sim::testing {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

inline constexpr double kQuarterTurn = 0.78539816339744830962;  // π/4

// No issues but that the dissipation law has another restitution than the pre-set one.
inline bool is_plain(const Problem& problem) {
    return std::ranges::all_of(validate(problem),
                               [](const Issue& issue) { return !issue.fatal && issue.path == "contact.restitution"; });
}

inline void set_tolerance(Problem& problem, double rtol) {
    problem.solver.rtol = rtol;
    problem.solver.atol = 1e-3 * rtol;
}

// The paper's beam falling from π/4 at rest, with nothing in its way.
inline Problem falling_beam(ModelKind model, Basis basis = Basis::automatic, int modes = 2) {
    Problem p;
    p.cam.reset();
    p.beam.model = model;
    p.beam.basis = basis;
    p.beam.modes = modes;
    set_tolerance(p, 1e-12);
    return p;
}

// The same over a fixed disc.
inline Problem fixed_cam(ModelKind model, int modes = 2) {
    Problem p;
    p.beam.model = model;
    p.beam.modes = modes;
    p.cam->speed = 0;
    return p;
}

inline Channel channel(const char* text) {
    const auto found = channel_named(text);
    if (!found) throw std::invalid_argument(text);
    return *found;
}

inline Result run(const Problem& problem, double end) {
    Request request;
    request.end_time = end;
    request.apexes = request.zero_crossings = true;
    return simulate(problem, request);
}

// One channel at given times.
inline std::vector<double> series(const Problem& problem, const char* name, std::vector<double> times) {
    Request request;
    request.tables.push_back({std::move(times), {channel(name)}});
    return simulate(problem, request).tables.front().values.front();
}

inline Extremum extremum(const Problem& problem, const char* name, double end) {
    Request request;
    request.end_time = end;
    request.extrema = {channel(name)};
    return simulate(problem, request).extrema.front();
}

// Seeded numbers that do not depend on the standard library's distributions.
class Dice {
  public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_()) / 4294967295.0);
    }
    double about_zero(double size) { return between(-size, size); }
    int one_of(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
    template <class T>
    T one_of(std::span<const Named<T>> all) {
        return all[static_cast<std::size_t>(one_of(static_cast<int>(all.size())))].value;
    }

  private:
    std::mt19937 engine_;
};

// A valid scene around the paper's, with compliant contact and without friction.
inline Problem random_problem(Dice& dice, ModelKind kind) {
    for (;;) {
        Problem p;
        p.beam.model = kind;
        p.beam.modes = 1 + dice.one_of(3);
        p.cam->speed = dice.about_zero(10);
        p.cam->eccentricity = dice.between(0, 0.03);
        p.cam->phase = dice.about_zero(3);
        p.cam->radius = dice.between(0.05, 0.12);
        p.cam->centre = {dice.between(0.25, 0.9), dice.about_zero(0.05)};
        p.initial.angle = dice.between(0.4, 1.2);
        p.initial.angular_velocity = dice.about_zero(1);
        p.hub.radius = dice.one_of(2) ? dice.between(-0.1, 0.2) : 0;
        p.hub.inertia = dice.one_of(2) ? dice.between(0, 0.05) : 0;
        p.contact.stiffness = std::pow(10, dice.between(6, 9));
        p.contact.exponent = dice.between(1, 2);
        p.contact.restitution = dice.between(0.2, 1);
        p.contact.damping = dice.one_of(names(DampingLaw{}));
        if (is_plain(p)) return p;
    }
}

// A valid scene with compliant contact of any kind: soft and stiff, every dissipation law, exponent and friction, one
// to eight modes, with and without offset of the face and hub radius.
inline Problem random_contact(unsigned seed) {
    Dice dice(seed);
    for (;;) {
        Problem p;
        p.beam.model = dice.one_of(5) == 0 ? ModelKind::zeroth_order : ModelKind::first_order;
        p.beam.modes = 1 + dice.one_of(8);
        if (dice.one_of(2)) p.beam.youngs_modulus *= std::pow(10, dice.between(-1.3, 0));
        if (dice.one_of(3) == 0) p.beam.damping_ratio = {std::pow(10, dice.between(-3, -1))};
        p.hub.radius = dice.one_of(2) ? 0 : dice.between(-0.2, 0.2);
        p.hub.inertia = dice.one_of(2) ? 0 : 0.01;
        p.cam->centre = {dice.between(0.25, 0.65), dice.about_zero(0.1)};
        p.cam->radius = dice.between(0.05, 0.11);
        p.cam->eccentricity = dice.between(0, 0.025);
        p.cam->speed = dice.one_of(4) ? dice.about_zero(15) : 0;
        p.cam->phase = dice.between(0, 6.28);
        p.contact.stiffness = std::pow(10, dice.between(4.5, 10.5));
        p.contact.exponent = dice.one_of(3) == 0 ? dice.between(1, 2) : dice.one_of(3) == 0 ? 1 : 1.5;
        p.contact.damping = dice.one_of(names(DampingLaw{}));
        p.contact.restitution = dice.between(0.2, 0.95);
        const int friction = dice.one_of(5);
        if (friction == 0)
            p.contact.friction = CoulombFriction{dice.between(0, 1), std::pow(10, dice.between(-2.5, -1))};
        if (friction == 1) p.contact.friction = StickSlipFriction{dice.between(0, 1), {}, {}};
        if (dice.one_of(3) == 0) p.contact.offset.reset();
        p.initial.angle = dice.between(0.5, 1.1);
        p.initial.angular_velocity = dice.between(-2.5, 0);
        if (is_plain(p)) return p;
    }
}

struct State {
    Vector xi, rate;
};

// A state with deflections of `size` metres (radians for `exact`), smaller in higher coordinates.
inline State random_state(const Model& model, Dice& dice, double size) {
    State s{Vector(model.size()), Vector(model.size())};
    s.xi[0] = dice.between(-3, 3);
    s.rate[0] = dice.about_zero(3);
    for (int i = 1; i < model.size(); ++i) {
        s.xi[i] = dice.about_zero(size / (i * i));
        s.rate[i] = dice.about_zero(20 * size / i);
    }
    return s;
}

inline Vector force(Model& model, const State& s) {
    Vector f(model.size());
    model.set(s.xi.data(), s.rate.data());
    if (!model.assemble(f.data())) throw std::runtime_error("the inertia is not positive");
    return f;
}

inline Vector acceleration(Model& model, const State& s) {
    Vector f = force(model, s);
    model.solve(f.data());
    return f;
}

// ∂²T/∂ξ̇² from the kinetic energy alone; exact, because T is a quadratic form in the rates.
inline Matrix mass_from_energy(Model& model, const Vector& xi) {
    const int n = model.size();
    const auto kinetic = [&](const Vector& rate) {
        model.set(xi.data(), rate.data());
        return model.energies().kinetic;
    };
    Vector alone(n);
    for (int i = 0; i < n; ++i) alone[i] = kinetic(Vector::Unit(n, i));
    Matrix mass(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            mass(i, j) = i == j ? 2 * alone[i] : kinetic(Vector::Unit(n, i) + Vector::Unit(n, j)) - alone[i] - alone[j];
    return mass;
}

// f′(0), error O(h⁶).
template <class F>
auto slope_at_zero(F&& f, double h) {
    return ((45.0 * (f(h) - f(-h)) - 9.0 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) * (1 / (60 * h))).eval();
}
template <class F>
double scalar_slope_at_zero(F&& f, double h) {
    return (45 * (f(h) - f(-h)) - 9 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) / (60 * h);
}

// A printable name of a case for parameterized tests: letters and digits only.
inline std::string label(const std::string& text) {
    std::string out;
    for (char c : text)
        if (std::isalnum(static_cast<unsigned char>(c))) out += c;
    return out;
}

}  // namespace beamcam::sim::testing
