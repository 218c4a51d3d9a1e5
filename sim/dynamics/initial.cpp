#include "sim/dynamics/initial.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "sim/dynamics/equilibrium.hpp"

namespace beamcam::sim {
namespace {

// Copies the given coordinates of shapes into ξ. Returns Σ h_i q_i, their contribution to the hub angle.
double set_shape_coordinates(System& system, const std::vector<double>& coordinates, Eigen::VectorXd& xi) {
    const double* hub = system.model().hub_row();
    double alpha = 0;
    for (std::size_t i = 0; i < coordinates.size() && static_cast<Eigen::Index>(i) + 1 < xi.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i) + 1;
        xi[row] = coordinates[i];
        alpha += hub[row] * coordinates[i];
    }
    return alpha / hub[0];
}

void continue_contact(const System& system, const InitialContact& contact, InitialState& state) {
    state.continued = contact;
    state.phase.gap_offset = contact.gap_offset;
    if (!contact.touching) return;
    state.phase.touching = true;
    state.phase.held = system.problem().contact.model == ContactModel::restitution;
    state.phase.approach = contact.approach_speed;
    state.phase.friction = contact.friction;
    if (system.has_bristle()) state.y[static_cast<std::size_t>(2 * system.coordinates())] = contact.bristle;
}

}  // namespace

InitialState initial_state(const Problem& problem) { return initial_state(System(problem)); }

InitialState initial_state(const System& original) {
    System system(original);
    const Problem& problem = original.problem();
    const int n = system.coordinates();
    InitialState state;
    state.y.assign(static_cast<std::size_t>(system.size), 0.0);
    Eigen::VectorXd xi = Eigen::VectorXd::Zero(n);
    xi[0] = system.drive().prescribed() ? system.drive().motion(0).angle : problem.initial.angle;
    double* y = state.y.data();
    switch (problem.initial.shape) {
        case InitialShape::straight:
            xi[0] -= set_shape_coordinates(system, problem.initial.q, xi);
            if (problem.initial.contact) continue_contact(system, *problem.initial.contact, state);
            break;
        case InitialShape::static_equilibrium: {
            const HeldBeam held = held_beam(original, xi[0]);
            xi = held.xi;
            state.unstable = held.unstable;
            break;
        }
        case InitialShape::resting: {
            const RestingBeam resting = resting_beam(original);
            xi = resting.start.xi;
            std::copy_n(resting.start.rate.data(), n, y + n);
            state.left_behind = resting.left_behind;
            state.phase.touching = true;
            state.phase.held = problem.contact.model == ContactModel::restitution;
            state.phase.approach = problem.contact.approach_floor.value;
            break;
        }
    }
    std::copy_n(xi.data(), n, y);
    if (problem.initial.shape != InitialShape::resting) {
        Eigen::VectorXd rate = Eigen::VectorXd::Zero(n);
        rate[0] = problem.initial.angular_velocity - set_shape_coordinates(system, problem.initial.q_dot, rate);
        std::copy_n(rate.data(), n, y + n);
    }
    if (system.drive().prescribed()) {
        const HubMotion hub = system.drive().motion(0);
        y[0] = hub.angle;
        y[n] = hub.rate;
    }
    return state;
}

Initial initial_of(const System& original, const std::vector<double>& y, double t) {
    System system(original);
    system.set_state(t, y.data());
    const auto rates = y.begin() + system.coordinates();
    Initial initial;
    initial.angle = system.model().hub_angle();
    initial.angular_velocity = system.model().hub_rate();
    initial.q.assign(y.begin() + 1, rates);
    initial.q_dot.assign(rates + 1, rates + system.coordinates());
    return initial;
}

Problem continued(const System& system, double t, const std::vector<double>& y) {
    Problem next = system.problem();
    next.initial = initial_of(system, y, t);
    next.hub.drive = later(next.hub.drive, t);
    if (next.cam) next.cam->phase = system.cam().angle(t);
    const Phase& phase = system.phase();
    if (phase.touching || phase.gap_offset != 0)
        next.initial.contact = {.touching = phase.touching,
                                .approach_speed = phase.approach,
                                .friction = phase.friction,
                                .bristle = system.bristle(y.data()),
                                .gap_offset = phase.gap_offset};
    return next;
}

}  // namespace beamcam::sim
