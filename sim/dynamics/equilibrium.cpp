#include "sim/dynamics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"
#include "sim/cam/lever.hpp"
#include "sim/dynamics/newton.hpp"

namespace beamcam::sim {
namespace {

// The load mgL²/(EI) grows by this from one equilibrium to the next; up to 7 are followed. A beam that needs more steps
// than the second number is a chain: its load is 5·10³.
constexpr double kLoadStep = 5, kMostLoadSteps = 1000;
constexpr double kRestingLoadStep = 0.5;  // the same on the cam, which a beam bent in one step would leave
constexpr double kLeastDepth = 1e-6;      // of the length: kNegligible of it is the rounding of a gap
// [rad] of the cam: step of finite differences of fourth order, at which truncation and rounding are equal.
constexpr double kFollowingDifference = 5e-3;

// Finite differences of fourth and third order over five instants, the first of them `from` steps from their place: 12
// times the first derivative by the step, and 12 times the second by its square.
struct Differences {
    int from;
    double rate[5], acceleration[5];
};
constexpr Differences kCentral{-2, {1, -8, 0, 8, -1}, {-1, 16, -30, 16, -1}};
constexpr Differences kOneSided{0, {-25, 48, -36, 16, -3}, {35, -104, 114, -56, 11}};

// Static forces of the model at ξ, without contact. They are valid even if `assemble` finds the inertia not positive.
void static_force(Model& model, const Eigen::VectorXd& xi, Eigen::VectorXd& f) {
    const double rest[kMaxSize] = {};
    model.set(xi.data(), rest);
    model.assemble(f.data());
}

Eigen::VectorXd scales(const Problem& problem, int n) {
    const double q = problem.beam.model == ModelKind::exact ? 1.0 : problem.beam.length;
    Eigen::VectorXd scale = Eigen::VectorXd::Constant(n, q);
    scale[0] = 1;
    return scale;
}

// Natural magnitude of forces: weight, torque if that is more, or bending stiffness without either.
double force_size(const System& system) {
    const Problem& problem = system.problem();
    const double length = problem.beam.length, mass = problem.beam.line_density() * length;
    double torque = system.drive().has_torque() ? std::fabs(system.drive().torque(0)) : 0;
    if (const auto& spring = system.spring())
        torque += std::fabs(spring->torque(problem.initial.angle, 0)) + spring->stiffness;
    const double force = std::max(mass * std::fabs(problem.gravity), torque / length);
    return force > 0 ? force : problem.beam.bending_stiffness() / (length * length);
}

Eigen::VectorXd force_sizes(const System& system, int n) {
    const Problem& problem = system.problem();
    const double length = problem.beam.length, force = force_size(system);
    Eigen::VectorXd size =
        Eigen::VectorXd::Constant(n, problem.beam.model == ModelKind::exact ? force * length : force);
    size[0] = force * length;
    return size;
}

// Natural magnitudes of the accelerations: those of hub and beam under such forces.
Eigen::VectorXd acceleration_sizes(const System& system, int n) {
    const Problem& problem = system.problem();
    const double length = problem.beam.length, mass = problem.beam.line_density() * length;
    Eigen::VectorXd size = force_sizes(system, n);
    size[0] /= problem.hub.inertia + mass * length * length;
    size.tail(n - 1) /= problem.beam.model == ModelKind::exact ? mass * length * length : mass;
    return size;
}

// Equilibrium with the hub clamped at the angle: f(ξ) + τ h = 0, θ(ξ) = angle. False if there is none.
bool clamped_equilibrium(System& system, double angle, Eigen::VectorXd& xi) {
    const Problem& problem = system.problem();
    Model& model = system.model();
    const int n = model.size();
    Eigen::VectorXd x(n + 1), scale(n + 1), size(n + 1), force(n);
    x << xi, 0;
    size << force_sizes(system, n), 1;
    scale << scales(problem, n),
        problem.gravity * model.mass() * model.length() + problem.beam.bending_stiffness() / model.length();
    const auto residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) {
        static_force(model, at.head(n), force);
        double theta = 0;
        for (int i = 0; i < n; ++i) {
            force[i] += at[n] * model.hub_row()[i];
            theta += model.hub_row()[i] * at[i];
        }
        r << force, theta - angle;
    };
    const bool found = newton(residual, x, scale, size);
    xi = x.head(n);
    return found;
}

// True if a small bend out of the clamped equilibrium ξ costs energy: the second variation of the potential for θ =
// const, −∂f/∂q with Θ = −h·q, is positive.
bool is_stable(Model& model, const Eigen::VectorXd& xi, const Eigen::VectorXd& scale) {
    const Eigen::Index n = model.size();
    const Eigen::Map<const Eigen::VectorXd> hub(model.hub_row(), n);
    const auto force = [&](const Eigen::VectorXd& at, Eigen::VectorXd& f) { static_force(model, at, f); };
    Eigen::MatrixXd variation(n - 1, n - 1);
    for (Eigen::Index j = 1; j < n; ++j) {
        const double step = kNewtonDifference * scale[j];
        Eigen::VectorXd bend = step * Eigen::VectorXd::Unit(n, j);
        bend[0] = -step * hub[j] / hub[0];
        const Eigen::VectorXd change = central_difference(force, xi, bend) / step;
        variation.col(j - 1) = -(change.tail(n - 1) - hub.tail(n - 1) * (change[0] / hub[0]));
    }
    return is_positive_definite(0.5 * (variation + variation.transpose()));
}

// Calls solve(system) for ever softer beams, from one that bends little to the given one, until one has no solution.
// Each starts from the solution before, so that a beam that bends far takes the equilibrium that its straight form
// leads to.                                                                                                     (S90)
template <class Solve>
bool soften(const System& given, double load_step, Solve&& solve) {
    Problem problem = given.problem();
    Beam& beam = problem.beam;
    beam = with_numbers_of_material(beam);
    const double length = beam.length, stiffness = beam.youngs_modulus;
    const double load = problem.beam.model == ModelKind::rigid
                            ? 0
                            : force_size(given) * length * length / problem.beam.bending_stiffness();
    const auto steps = static_cast<int>(std::clamp(std::ceil(load / load_step), 1.0, kMostLoadSteps));
    for (int step = 1; step < steps; ++step) {
        beam.youngs_modulus = stiffness * steps / step;
        System stiffer(problem);
        if (!solve(stiffer)) return false;
    }
    System system(given);
    return solve(system);
}

// Solves for the beam on the cam at time t, in equilibrium with gravity, torque, friction and the inertia of the given
// motion: f + τh + (J_n + r J_t)ᵀN = M ξ̈, gap = −δ(N), or 0 in impulsive contact. False if there is no solution. (S40)
bool equilibrium_on_cam(System& system, double t, FollowingState& s) {
    const int n = system.coordinates();
    const Problem& problem = system.problem();
    const bool rigid_contact = problem.contact.model == ContactModel::restitution;
    const bool moves = !s.acceleration.isZero(0) || !s.rate.isZero(0);
    Model& model = system.model();
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    std::copy_n(s.rate.data(), n, y.begin() + n);
    const double approach = problem.contact.approach_floor.value;
    Eigen::VectorXd x(n + 1), scale(n + 1), size(n + 1), force(n);
    scale << scales(problem, n), force_size(system);
    const double depth = rigid_contact ? problem.beam.length : system.normal_law().penetration(scale[n], 0, approach);
    size << (moves ? acceleration_sizes(system, n) : force_sizes(system, n)),
        std::max(depth, kLeastDepth * problem.beam.length);
    x << s.xi, 0.5 * scale[n];
    const auto residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) {
        std::copy_n(at.data(), n, y.begin());
        const ContactState c = system.contact(t, y.data());
        const double normal = at[n];
        const bool solvable = system.generalized_force(t, c, normal, force.data());
        if (moves && solvable) model.solve(force.data());
        if (moves && !solvable) force.setConstant(std::numeric_limits<double>::quiet_NaN());  // rejects the iterate
        r.head(n) = force - s.acceleration;
        const NormalLaw law = system.normal_law().at(c.disc.radius);
        r[n] = c.gap + (rigid_contact ? 0 : law.penetration(normal, moves ? -c.gap_rate : 0, approach));
    };
    const bool found = newton(residual, x, scale, size);
    s.xi = x.head(n);
    s.pressed = x[n] >= -kNegligible * scale[n];
    return found;
}

// The jump of the cam's radius of curvature that the contact is about to pass or has just passed, as the angle through
// which the cam turns before it; nothing if none is near.
std::optional<double> near_kink(System& system, const Eigen::VectorXd& xi) {
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    std::copy_n(xi.data(), xi.size(), y.begin());
    const TurningCam& cam = system.cam();
    const double alpha = cam.alpha(0, system.contact(0, y.data()).normal);
    for (const double kink : cam.shape().kinks()) {
        const double ahead = std::copysign(1.0, system.problem().cam->speed) * std::remainder(kink - alpha, kFullTurn);
        if (std::fabs(ahead) < 8 * kFollowingDifference) return ahead;
    }
    return std::nullopt;
}

// The start of a beam that follows the turning cam. Equilibria at neighbouring cam angles give the rates, the rates
// give the inertia forces, and these correct the equilibria. After two corrections the error is of sixth order in the
// ratio of the cam's speed to the frequencies of beam and contact. The angles lie on both sides of the start or, where
// ρ jumps near it, on one. On a cam that falls away faster than the beam can follow, the start is the equilibrium
// without inertia forces, with the rates of following.                                                        (S40)
RestingBeam following_beam(System& system, const Eigen::VectorXd& xi) {
    const std::optional<double> kink = near_kink(system, xi);
    const Differences& differences = kink ? kOneSided : kCentral;
    const double dt =
        (kink.value_or(0) > kNegligible ? -1 : 1) * kFollowingDifference / std::fabs(system.problem().cam->speed);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(xi.size());
    std::vector<FollowingState> states(9, {xi, zero, zero});
    const std::size_t middle = kink ? 0 : 4;
    FollowingState& start = states[middle];
    // The instants that are needed for as many more differences, the start being the first or the middle one.
    const auto over = [&](std::size_t more, auto&& act) {
        const std::size_t first = kink ? 0 : middle - 2 * more;
        for (std::size_t k = first; k <= first + 4 * more; ++k)
            if (!act(k)) return false;
        return true;
    };
    const auto solve = [&](std::size_t k) {
        return equilibrium_on_cam(system, (static_cast<double>(k) - static_cast<double>(middle)) * dt, states[k]);
    };
    const auto differentiate = [&](std::size_t k) {
        states[k].rate = states[k].acceleration = zero;
        for (std::size_t i = 0; i < 5; ++i) {
            const Eigen::VectorXd& at = states[k + i + static_cast<std::size_t>(differences.from)].xi;
            states[k].rate += differences.rate[i] / (12 * dt) * at;
            states[k].acceleration += differences.acceleration[i] / (12 * dt * dt) * at;
        }
        return true;
    };
    if (!over(2, solve)) throw StepFailure("no equilibrium of the beam resting on the turning cam was found");
    over(1, differentiate);
    const FollowingState slow{start.xi, start.rate, zero};
    if (!over(1, solve)) return {slow, true};
    differentiate(middle);
    return solve(middle) && start.pressed ? RestingBeam{start, false} : RestingBeam{slow, true};
}

// The rigid rod on that side of the cam against which weight and torque press it, with the static penetration.
Eigen::VectorXd rod_on_cam(const System& system) {
    const Problem& problem = system.problem();
    const Lever lever(problem);
    const Lever::State rest = lever.at(-problem.cam->phase);
    const double moment = std::max(lever.pressing_moment(rest.motion.theta), 0.0);
    const double penetration =
        problem.contact.model == ContactModel::restitution
            ? 0
            : std::pow(moment / (rest.foot * system.normal_law().stiffness), 1 / contact_exponent(problem));
    Eigen::VectorXd xi = Eigen::VectorXd::Zero(system.coordinates());
    xi[0] = rest.motion.theta - lever.side() * penetration / rest.foot;
    return xi;
}

}  // namespace

HeldBeam held_beam(const System& given, double angle) {
    System system(given);
    const int n = system.coordinates();
    HeldBeam held{Eigen::VectorXd::Zero(n), false};
    held.xi[0] = angle;
    if (!soften(given, kLoadStep, [&](System& softer) { return clamped_equilibrium(softer, angle, held.xi); }))
        throw StepFailure("no static equilibrium was found for the beam held at the initial angle");
    held.unstable = n > 1 && !is_stable(system.model(), held.xi, scales(system.problem(), n));
    return held;
}

RestingBeam resting_beam(const System& given) {
    System system(given);
    const Phase flight;  // the contact force is added by equilibrium_on_cam
    system.set_phase(flight);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.coordinates());
    RestingBeam beam{{rod_on_cam(system), zero, zero}, false};
    const auto rest = [&](System& softer) {
        softer.set_phase(flight);
        return equilibrium_on_cam(softer, 0, beam.start) && beam.start.pressed;
    };
    if (!soften(given, kRestingLoadStep, rest))
        throw StepFailure("no equilibrium of the beam resting on the cam was found");
    return system.problem().cam->speed == 0 ? beam : following_beam(system, beam.start.xi);
}

}  // namespace beamcam::sim
