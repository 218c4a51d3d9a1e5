#include "sim/beam/natural_modes.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/ode.hpp"

namespace beamcam::sim {

constexpr int kPlacesPerWave = 32;       // where natural modes are evaluated for their largest values
constexpr double kBetweenPlaces = 1.05;  // a sine between places a 32nd of a half wave apart: 1.0012

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
    bound_shapes(*model, problem.beam.bending_stiffness(), problem.hub.radius);
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

// Largest displacement, rotation of the tangent and curvature of the straight beam for each mode, from many places; a
// margin covers the values between them.
void NaturalModes::bound_shapes(Model& model, double bending_stiffness, double radius) {
    const Eigen::Index count = shapes.rows(), places = kPlacesPerWave * count;
    const double none[kMaxSize] = {};
    Eigen::VectorXd x(count), y(count), rotation(count);
    Eigen::ArrayXd displacement = Eigen::ArrayXd::Zero(count), slope = displacement, curvature = displacement;
    const auto place = [&](Eigen::Index k) {
        return model.length() * static_cast<double>(k) / static_cast<double>(places);
    };
    model.set(none, none);
    for (Eigen::Index k = 0; k <= places; ++k) {
        model.jacobian(place(k), x.data(), y.data(), rotation.data());
        displacement = displacement.max((shapes.transpose() * y).array().abs());
        slope = slope.max((shapes.transpose() * rotation).array().abs());
    }
    for (Eigen::Index i = 1; i < count; ++i) {
        model.set(shapes.col(i).data(), none);
        for (Eigen::Index k = 0; k <= places; ++k)
            curvature[i] = std::max(curvature[i], std::fabs(model.bending_moment(place(k)) / bending_stiffness));
    }
    const Eigen::VectorXd hub = shapes.transpose() * Eigen::Map<const Eigen::VectorXd>(model.hub_row(), count);
    for (Eigen::Index i = 1; i < count; ++i) {
        shape.push_back(kBetweenPlaces * (displacement[i] + std::fabs(radius * hub[i])));
        beta.push_back(std::max(kBetweenPlaces * slope[i] / shape.back(),
                                std::sqrt(kBetweenPlaces * curvature[i] / shape.back())));
        slope_norm.push_back(std::sqrt(model.length()) * shape.back() * beta.back());
        h.push_back(hub[i]);
    }
}

}  // namespace beamcam::sim
