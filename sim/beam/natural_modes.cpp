#include "sim/beam/natural_modes.hpp"

#include <cmath>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/ode.hpp"

namespace beamcam::sim {

// A free hub condenses to a rotation of the frame against the mean rigid one.
NaturalModes::NaturalModes(const Model& of, const Problem& problem) {
    const std::unique_ptr<Model> model = of.clone();
    const Eigen::Index n = model->size() - 1;
    const double m = model->mass();
    const Linearization linear = model->linearize();
    const Eigen::MatrixXd& mass = linear.mass;
    J = mass(0, 0);
    Eigen::VectorXd rotation = Eigen::VectorXd::Zero(n);
    if (!is_prescribed(problem.hub.drive)) rotation = mass.bottomLeftCorner(n, 1) / J;
    const Eigen::MatrixXd inertia = mass.bottomRightCorner(n, n) - rotation * mass.topRightCorner(1, n);
    const Eigenmodes modes = eigenmodes(linear.stiffness.bottomRightCorner(n, n), inertia);
    omega_squared = modes.omega_squared;
    const Eigen::MatrixXd beam = std::sqrt(m) * modes.shapes;
    shapes = inverse = Eigen::MatrixXd::Identity(n + 1, n + 1);
    shapes.bottomRightCorner(n, n) = beam;
    shapes.topRightCorner(1, n) = -rotation.transpose() * beam;
    inverse.bottomRightCorner(n, n) = beam.transpose() * inertia / m;
    inverse.topRightCorner(1, n) = rotation.transpose();
    U = beam.transpose() * (mass.bottomLeftCorner(n, 1) - J * rotation);
    damping = Eigen::VectorXd::Zero(n);
    if (model->damping()) damping = (beam.transpose() * *model->damping() * beam).diagonal() / m;
    weigh(*model, problem.gravity);
}

// Generalized forces of gravity on the straight beam along X.
void NaturalModes::weigh(Model& model, double gravity) {
    double force[kMaxSize];
    const double none[kMaxSize] = {};
    model.set(none, none);
    if (!model.assemble(force)) throw InertiaLost();
    const Eigen::VectorXd pull = shapes.transpose() * Eigen::Map<const Eigen::VectorXd>(force, shapes.rows());
    const double inverse_gravity = gravity != 0 ? -1 / gravity : 0;
    S = inverse_gravity * pull[0];
    weight = inverse_gravity * pull.tail(pull.size() - 1) / model.mass();
}

}  // namespace beamcam::sim
