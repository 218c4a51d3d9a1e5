#include "sim/dynamics/initial.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/linear_algebra.hpp"
#include "sim/dynamics/constants.hpp"

namespace beamcam::sim {
namespace {

// Newton's method with a differenced Jacobian on a handful of unknowns. scale[i] is the natural size of x[i], size[i]
// that of residual i: unknowns and residuals of different units are compared by these shares alone.
template <class F>
bool newton(F&& function, Eigen::VectorXd& x, const Eigen::VectorXd& scale, const Eigen::VectorXd& size) {
    const Eigen::Index n = x.size();
    Eigen::VectorXd f(n), g(n);
    Eigen::MatrixXd jacobian(n, n);
    const auto residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) {
        function(at, r);
        r = r.cwiseQuotient(size).eval();
    };
    residual(x, f);
    for (int iteration = 0; iteration < kMostNewtonSteps; ++iteration) {
        for (Eigen::Index j = 0; j < n; ++j) {
            const double kept = x[j];
            x[j] = kept + kNewtonDifference * scale[j];
            residual(x, g);
            jacobian.col(j) = g;
            x[j] = kept - kNewtonDifference * scale[j];
            residual(x, g);
            jacobian.col(j) = (jacobian.col(j) - g) / (2 * kNewtonDifference);
            x[j] = kept;
        }
        const Eigen::VectorXd dx = solve(jacobian, -f).cwiseProduct(scale);
        if (!dx.allFinite()) return false;
        double factor = 1;  // damped: the residual may not grow
        const double before = f.norm();
        for (int half = 0;; ++half, factor *= 0.5) {
            const Eigen::VectorXd tried = x + factor * dx;
            residual(tried, g);
            if (g.norm() <= before || half > kMostDampings) {
                x = tried;
                f = g;
                break;
            }
        }
        if ((factor * dx).cwiseQuotient(scale).cwiseAbs().maxCoeff() < kNewtonConverged) return true;
    }
    return f.norm() < kBalanced;
}

// Static forces of the model at ξ, without contact. They do not depend on the inertia that `assemble` judges.
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

// The natural sizes of the generalized forces: what carries the weight, or the torque where it is more, or bends a beam
// that has neither.
Eigen::VectorXd force_sizes(const System& system, int n) {
    const Problem& problem = system.problem();
    const double length = problem.beam.length, mass = problem.beam.line_density() * length;
    const double torque = system.drive().has_torque() ? std::fabs(system.drive().torque(0)) : 0;
    double force = std::max(mass * std::fabs(problem.gravity), torque / length);
    if (!(force > 0)) force = problem.beam.bending_stiffness() / (length * length);
    Eigen::VectorXd size =
        Eigen::VectorXd::Constant(n, problem.beam.model == ModelKind::exact ? force * length : force);
    size[0] = force * length;
    return size;
}

// The same of the accelerations that such forces give to hub and beam.
Eigen::VectorXd acceleration_sizes(const System& system, int n) {
    const Problem& problem = system.problem();
    const double length = problem.beam.length, mass = problem.beam.line_density() * length;
    Eigen::VectorXd size = force_sizes(system, n);
    size[0] /= problem.hub.inertia + mass * length * length;
    size.tail(n - 1) /= problem.beam.model == ModelKind::exact ? mass * length * length : mass;
    return size;
}

// Equilibrium with the hub held at the angle: f(ξ) + τ h = 0, θ(ξ) = angle.
bool hold(System& system, double angle, Eigen::VectorXd& xi) {
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

// A motion along which the beam lies on the cam, seen at one instant.
struct Ride {
    Eigen::VectorXd xi, rate, acceleration;
};

// Finds `ride.xi`: the beam on the cam at time t, in equilibrium with gravity, torque, friction and the inertia of
// the ride, f + τh + (J_n + r J_t)ᵀN = M ξ̈ with N = Kδⁿ, or with whatever N keeps the gap at zero (model
// `restitution`). False when there is none, or when N would have to pull.                               (S40)
bool rest(System& system, double t, Ride& ride) {
    const int n = system.coordinates();
    const Problem& problem = system.problem();
    const bool rigid_contact = problem.contact.model == ContactModel::restitution;
    const bool moves = !ride.acceleration.isZero(0) || !ride.rate.isZero(0);
    Model& model = system.model();
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    std::copy_n(ride.rate.data(), n, y.begin() + n);
    const double stiffness = system.normal_law().stiffness, approach = problem.contact.approach_floor.value;
    const double weight = std::max(std::fabs(problem.gravity) * model.mass(), 1e-300);
    Eigen::VectorXd x(n + (rigid_contact ? 1 : 0)), scale(x.size()), size(x.size()), force(n);
    x.head(n) = ride.xi;
    scale.head(n) = scales(problem, n);
    size.head(n) = moves ? acceleration_sizes(system, n) : force_sizes(system, n);
    if (rigid_contact) {
        x[n] = 0.5 * weight;
        scale[n] = weight;
        size[n] = problem.beam.length;
    }
    const auto residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) {
        std::copy_n(at.data(), n, y.begin());
        const ContactState c = system.contact(t, y.data(), true);
        // Compliant: linear for a separated beam, so that Newton finds its way back.
        const double push = rigid_contact ? at[n]
                            : c.gap < 0   ? system.normal_law().force(-c.gap, moves ? -c.gap_rate : 0, approach)
                                          : -c.gap * stiffness * kSeparatedPull;
        const bool inert = system.generalized_force(t, c, push, force.data());
        if (moves && inert) model.solve(force.data());
        if (moves && !inert) force.setConstant(std::numeric_limits<double>::quiet_NaN());  // a step too far
        r.head(n) = force - ride.acceleration;
        if (rigid_contact) r[n] = c.gap;
    };
    const bool found = newton(residual, x, scale, size);
    ride.xi = x.head(n);
    if (!found || rigid_contact) return found && x[n] >= 0;
    std::copy_n(x.data(), n, y.begin());
    return system.contact(t, y.data(), true).gap <= kEquilibriumGap * problem.beam.length;
}

// The beam lying on the cam at its start, moving with the cam if it turns. The equilibria at neighbouring angles
// of the cam give the rates, the rates give the inertia, and the inertia corrects the equilibria: twice, after
// which what is left is of the sixth order in the ratio of the cam's speed to the frequencies of beam and contact.
// (S40)
class Riding {
  public:
    Riding(System& system, const Eigen::VectorXd& guess)
        : system_(system), step_(kFollowingDifference / std::fabs(system.problem().cam->speed)) {
        const Eigen::VectorXd still = Eigen::VectorXd::Zero(guess.size());
        rides_.assign(kPoints, {guess, still, still});
    }
    bool find() {
        if (!level(4)) return false;
        motion(2);
        if (!level(2)) return false;
        motion(0);
        return level(0);
    }
    Ride start() const { return rides_[kMiddle]; }

  private:
    static constexpr int kPoints = 9, kMiddle = 4;

    // Equilibria at the instants −reach…reach.
    bool level(int reach) {
        for (int k = -reach; k <= reach; ++k)
            if (!rest(system_, k * step_, rides_[static_cast<std::size_t>(kMiddle + k)])) return false;
        return true;
    }
    // Rates and accelerations there, by differences of the fourth order.
    void motion(int reach) {
        std::vector<Ride> moved = rides_;
        for (int k = -reach; k <= reach; ++k) {
            const auto at = [&](int i) -> const Eigen::VectorXd& {
                return rides_[static_cast<std::size_t>(kMiddle + k + i)].xi;
            };
            Ride& ride = moved[static_cast<std::size_t>(kMiddle + k)];
            ride.rate = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step_);
            ride.acceleration = (16 * (at(1) + at(-1)) - (at(2) + at(-2)) - 30 * at(0)) / (12 * step_ * step_);
        }
        rides_ = std::move(moved);
    }

    System& system_;
    double step_;
    std::vector<Ride> rides_;
};

// A cam that falls away faster than the beam can follow: at rest on it, it moves along until it is left behind.
Ride left_behind(System& system, const Eigen::VectorXd& xi) {
    const double dt = kLeavingDifference / std::fabs(system.problem().cam->speed);
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(xi.size());
    Ride later{xi, still, still}, earlier = later;
    if (!rest(system, dt, later) || !rest(system, -dt, earlier))
        throw StepFailure("no equilibrium of the beam resting on the turning cam was found");
    return {xi, (later.xi - earlier.xi) / (2 * dt), still};
}

// The rigid rod on that side of the disc where weight and torque press it on, pressed in by what carries them.
Eigen::VectorXd rod_on_cam(const System& system) {
    const Problem& problem = system.problem();
    const Vec2 disc = system.cam(0).disc;
    const double away = norm(disc), lever = problem.hub.radius + 0.5 * problem.beam.length;
    const double direction = std::atan2(disc.y, disc.x);
    const double aside = std::asin(std::min(1.0, (problem.cam->radius + system.offset()) / away));
    const double torque = system.drive().has_torque() ? system.drive().torque(0) : 0;
    const double weight = problem.gravity * problem.beam.line_density() * problem.beam.length;
    const auto moment = [&](double angle) { return torque - weight * lever * std::cos(angle); };
    const double side = moment(direction + aside) > 0 && moment(direction - aside) > 0 ? -1 : 1;
    const double lie = direction + side * aside;
    const double press = problem.contact.model == ContactModel::restitution
                             ? 0
                             : std::pow(std::max(-side * moment(lie), 0.0) / (away * system.normal_law().stiffness),
                                        1 / problem.contact.exponent);
    Eigen::VectorXd xi = Eigen::VectorXd::Zero(system.coordinates());
    xi[0] = lie - side * press / away;
    return xi;
}

// Puts the coordinates of the shapes that are given into the state; how far they turn the hub.
double given(System& system, const std::vector<double>& coordinates, Eigen::VectorXd& xi) {
    const double* hub = system.model().hub_row();
    double turned = 0;
    for (std::size_t i = 0; i < coordinates.size() && static_cast<Eigen::Index>(i) + 1 < xi.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i) + 1;
        xi[row] = coordinates[i];
        turned += hub[row] * coordinates[i];
    }
    return turned / hub[0];
}

}  // namespace

InitialState initial_state(const Problem& problem) { return initial_state(System(problem)); }

InitialState initial_state(const System& of) {
    System system(of);
    const Problem& problem = of.problem();
    const int n = system.coordinates();
    InitialState state;
    state.y.assign(static_cast<std::size_t>(system.size), 0.0);
    Eigen::VectorXd xi = Eigen::VectorXd::Zero(n);
    xi[0] = system.drive().prescribed() ? system.drive().motion(0).angle : problem.initial.angle;
    double* y = state.y.data();
    switch (problem.initial.shape) {
        case InitialShape::straight:  // but for what is given
            xi[0] -= given(system, problem.initial.q, xi);
            break;
        case InitialShape::static_equilibrium:
            if (!hold(system, xi[0], xi))
                throw StepFailure("no static equilibrium was found for the beam held at the initial angle");
            break;
        case InitialShape::resting: {
            xi = rod_on_cam(system);
            Phase phase;
            phase.touching = false;  // geometry only; the force is the static one
            system.set_phase(phase);
            const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
            Ride ride{xi, still, still};
            if (!rest(system, 0, ride)) throw StepFailure("no equilibrium of the beam resting on the cam was found");
            if (problem.cam->speed != 0) {
                Riding riding(system, ride.xi);
                state.left_behind = !riding.find();
                ride = state.left_behind ? left_behind(system, ride.xi) : riding.start();
            }
            xi = ride.xi;
            std::copy_n(ride.rate.data(), n, y + n);
            state.phase.touching = true;
            state.phase.held = problem.contact.model == ContactModel::restitution;
            state.phase.approach = problem.contact.approach_floor.value;
            break;
        }
    }
    std::copy_n(xi.data(), n, y);
    if (problem.initial.shape != InitialShape::resting) {
        Eigen::VectorXd rate = Eigen::VectorXd::Zero(n);
        rate[0] = problem.initial.angular_velocity - given(system, problem.initial.q_dot, rate);
        std::copy_n(rate.data(), n, y + n);
    }
    if (system.drive().prescribed()) {
        const HubMotion hub = system.drive().motion(0);
        y[0] = hub.angle;
        y[n] = hub.rate;
    }
    return state;
}

Initial initial_of(const System& of, const std::vector<double>& y) {
    System system(of);
    system.place(0, y.data());
    const auto rates = y.begin() + system.coordinates();
    Initial initial;
    initial.angle = system.model().hub_angle();
    initial.angular_velocity = system.model().hub_rate();
    initial.q.assign(y.begin() + 1, rates);
    initial.q_dot.assign(rates + 1, rates + system.coordinates());
    return initial;
}

}  // namespace beamcam::sim
