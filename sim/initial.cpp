#include "sim/initial.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace beamcam::sim {
namespace {

// Newton with a differenced Jacobian on a handful of unknowns; scale[i] is the natural size of x[i].
template <class F>
bool newton(F&& residual, Eigen::VectorXd& x, const Eigen::VectorXd& scale) {
    const Eigen::Index n = x.size();
    Eigen::VectorXd f(n), g(n);
    Eigen::MatrixXd jacobian(n, n);
    residual(x, f);
    for (int iteration = 0; iteration < 60; ++iteration) {
        for (Eigen::Index j = 0; j < n; ++j) {
            const double step = 1e-7 * scale[j], kept = x[j];
            x[j] = kept + step;
            residual(x, g);
            jacobian.col(j) = g;
            x[j] = kept - step;
            residual(x, g);
            jacobian.col(j) = (jacobian.col(j) - g) / (2 * step);
            x[j] = kept;
        }
        const Eigen::VectorXd dx = jacobian.fullPivLu().solve(-f);
        if (!dx.allFinite()) return false;
        double factor = 1;  // damped: the residual may not grow
        const double before = f.norm();
        for (int half = 0;; ++half, factor *= 0.5) {
            const Eigen::VectorXd tried = x + factor * dx;
            residual(tried, g);
            if (g.norm() <= before || half > 20) {
                x = tried;
                f = g;
                break;
            }
        }
        if ((factor * dx).cwiseQuotient(scale).cwiseAbs().maxCoeff() < 1e-13) return true;
    }
    return f.norm() < 1e-9;
}

// Static forces of the model at ξ, without contact.
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

// Equilibrium with the hub held at the angle: f(ξ) + τ h = 0, θ(ξ) = angle.
bool hold(const Problem& problem, Model& model, double angle, Eigen::VectorXd& xi) {
    const int n = model.size();
    Eigen::VectorXd x(n + 1), scale(n + 1), force(n);
    x << xi, 0;
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
    const bool found = newton(residual, x, scale);
    xi = x.head(n);
    return found;
}

// Equilibrium on the cam at rest, at the cam's pose of time t: f(ξ) + JᵀN n = 0 with N = Kδⁿ, or with
// whatever N keeps the gap at zero (model `restitution`).
bool rest(System& system, double t, Eigen::VectorXd& xi) {
    const int n = system.coordinates();
    const Problem& problem = system.problem();
    const bool rigid_contact = problem.contact.model == ContactModel::restitution;
    Model& model = system.model();
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    const double stiffness = system.normal_law().stiffness;
    const double weight = std::fabs(problem.gravity) * model.mass();
    Eigen::VectorXd x(n + (rigid_contact ? 1 : 0)), scale(x.size()), force(n);
    x.head(n) = xi;
    scale.head(n) = scales(problem, n);
    if (rigid_contact) {
        x[n] = 0.5 * weight;
        scale[n] = std::max(weight, 1e-300);
    }
    const auto residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) {
        std::copy_n(at.data(), n, y.begin());
        static_force(model, at, force);
        const ContactState c = system.contact(t, y.data(), true);
        double jx[kMaxSize], jy[kMaxSize], jchi[kMaxSize];
        model.jacobian(c.x, jx, jy, jchi);
        // Compliant: linear for a separated beam, so that Newton finds its way back.
        const double push = rigid_contact ? at[n]
                            : c.gap < 0   ? system.normal_law().elastic(-c.gap)
                                          : -c.gap * stiffness * 1e-6;
        for (int i = 0; i < n; ++i) force[i] += push * (jx[i] * c.normal.x + jy[i] * c.normal.y);
        r.head(n) = force;
        if (rigid_contact) r[n] = c.gap * std::max(weight, 1e-300) / problem.beam.length;
    };
    const bool found = newton(residual, x, scale);
    xi = x.head(n);
    return found && (!rigid_contact || x[n] >= 0);
}

}  // namespace

InitialState initial_state(const Problem& problem) {
    System system(problem);
    const int n = system.coordinates();
    InitialState state;
    state.y.assign(static_cast<std::size_t>(system.size), 0.0);
    Eigen::VectorXd xi = Eigen::VectorXd::Zero(n);
    xi[0] = system.drive().prescribed() ? system.drive().motion(0).angle : problem.initial.angle;
    double* y = state.y.data();
    switch (problem.initial.shape) {
        case InitialShape::straight:
            break;
        case InitialShape::static_equilibrium:
            if (!hold(problem, system.model(), xi[0], xi))
                throw StepFailure("no static equilibrium was found for the beam held at the initial angle");
            break;
        case InitialShape::resting: {
            // From the rigid rod lying on the disc, pressed in by what carries its weight.
            const Vec2 disc = system.cam(0).disc;
            const double reach = problem.cam->radius + system.offset();
            const double lie = std::atan2(disc.y, disc.x) + std::asin(std::min(1.0, reach / norm(disc)));
            const double lever = problem.hub.radius + 0.5 * problem.beam.length;
            const double weight = problem.gravity * system.model().mass() * lever * std::cos(lie) / norm(disc);
            const double press =
                problem.contact.model == ContactModel::restitution
                    ? 0
                    : std::pow(std::max(weight, 0.0) / system.normal_law().stiffness, 1 / problem.contact.exponent);
            xi.setZero();
            xi[0] = lie - press / norm(disc);
            Phase phase;
            phase.touching = false;  // geometry only; the force is the static one
            system.set_phase(phase);
            if (!rest(system, 0, xi)) throw StepFailure("no equilibrium of the beam resting on the cam was found");
            if (problem.cam->speed != 0) {
                // It moves with the cam: the rate at which equilibria follow the cam's angle (S40).
                const double dt = 1e-5 / std::fabs(problem.cam->speed);
                Eigen::VectorXd later = xi, earlier = xi;
                if (!rest(system, dt, later) || !rest(system, -dt, earlier))
                    throw StepFailure("no equilibrium of the beam resting on the turning cam was found");
                const Eigen::VectorXd rate = (later - earlier) / (2 * dt);
                std::copy_n(rate.data(), n, y + n);
            }
            state.phase.touching = true;
            state.phase.held = problem.contact.model == ContactModel::restitution;
            state.phase.approach = problem.contact.approach_floor.value;
            break;
        }
    }
    std::copy_n(xi.data(), n, y);
    if (problem.initial.shape != InitialShape::resting) y[n] = problem.initial.angular_velocity;
    if (system.drive().prescribed()) {
        const HubMotion hub = system.drive().motion(0);
        y[0] = hub.angle;
        y[n] = hub.rate;
    }
    return state;
}

}  // namespace beamcam::sim
