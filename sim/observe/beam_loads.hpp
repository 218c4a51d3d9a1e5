// Bending moment, force on the hub and acceleration of the tip, by the balance of forces on the part of the beam beyond
// a section: d'Alembert's forces, weight and contact force. MODEL.md (S96)–(S98).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "sim/base/numerics.hpp"
#include "sim/dynamics/contact_geometry.hpp"

namespace beamcam::sim {

class BeamLoads {
  public:
    // `model` is that of the states to come: it keeps the nodes.
    BeamLoads(const Problem& problem, Model& model);

    // In the state of the model, which must outlive the other calls, with its acceleration ξ̈; `contact`: the forces
    // that act, or null.
    void set(const Model& model, const double* acceleration, const ContactState* contact);

    // M(x), positive where the beam is bent counter-clockwise, as EI κ [N m].
    double moment(double x) const;
    // Where |M| is largest (x), and |M| there (y).
    Vec2 largest_moment() const;
    // The force of the fixed axis on the hub [N].
    Vec2 pivot_force() const;

  private:
    Quadrature rule_;
    SpectralIntegral integral_;
    Eigen::MatrixXd beyond_;  // row k: the weights of ∫ from node k to the tip
    double length_, line_density_, gravity_, offset_;

    const Model* model_ = nullptr;
    Eigen::VectorXd force_x_, force_y_, turn_;  // line load f = −ρA(r̈ + g) and r × f at the nodes
    Eigen::VectorXd x_, y_;                     // r at the nodes
    std::optional<double> contact_x_;           // absent: no contact force
    Vec2 contact_force_;                        // on the beam
    double contact_turn_ = 0;                   // its moment about O
    mutable Eigen::VectorXd weights_;           // scratch
};

// r̈ of the point at x [m/s²].
Vec2 point_acceleration(const Model& model, const double* acceleration, double x);

}  // namespace beamcam::sim
