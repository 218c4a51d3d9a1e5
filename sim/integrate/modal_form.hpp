// The equations of motion in the form of an exponential integrator: oscillators and their coupling. The coupling is
// given by plain arrays for `rigid`, `zeroth-order` and `first-order` with a free hub in hub–beam shapes (no coupling
// through the inertia) or with a prescribed hub in any shapes. For `exact` it is the difference between its forces of
// inertia and gravity (InertiaForces) and those of the vibrating straight beam.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/oscillator.hpp"

namespace beamcam::sim {

struct ModalForm {
    // Other models and shapes have no such form: Runge and Kutta's method integrates them.
    static bool exists(System& system);
    // Throws InertiaLost and std::domain_error where the straight beam has no positive inertia.
    static std::shared_ptr<const ModalForm> of(System& system);

    int n = 0;  // modes
    // Natural modes of the straight beam with its hub, in columns: ξ = natural z, z = to_natural ξ, z₀ the rigid turn.
    // Empty where the coordinates are the natural ones and the coupling is given by the arrays below.
    Eigen::MatrixXd natural, to_natural;
    std::vector<double> mode_columns, mode_rows;  // of z₁…z_n: row-major (n + 1) × n, and transposed
    bool by_arrays() const { return natural.size() == 0; }
    // In place, of coordinates and rates at the start of a state.
    void to_coordinates(double* state) const { transform(natural, state); }
    void to_modes(double* state) const { transform(to_natural, state); }

    bool prescribed = false, shortening = false, damped = false;
    double J = 0, S = 0, mass = 1, gravity = 0, radius = 0, length = 1;
    std::vector<Oscillator> oscillators;
    // Row-major n × n, empty where the modes are not the coordinates: B of J + qᵀBq [kg], and G/m, empty for models
    // without it. f_i = Θ̇² (Bq)_i/m + g sin Θ (Gq)_i/m + …
    std::vector<double> inertia, fall;
    std::vector<double> weight;        // W/m
    std::vector<double> U;             // [kg m], zero for a free hub
    std::vector<double> h;             // θ = Θ + h·q
    std::vector<double> shape;         // largest values of the shapes, at most
    std::vector<double> beta;          // wave numbers: shape times it bounds the slope, times its square the curvature
    std::vector<double> inertia_root;  // c with |B_ij| <= c_i c_j [√kg]
    std::vector<double> slope_norm;    // √∫φ′², if the beam shortens [1/√m]

  private:
    static std::shared_ptr<ModalForm> begin(const System& system, const Model& model);
    static std::shared_ptr<const ModalForm> by_arrays_of(System& system);
    static std::shared_ptr<const ModalForm> of_natural_modes(System& system);
    void bound_shapes(Model& model, double bending_stiffness);
    void transform(const Eigen::MatrixXd& by, double* state) const;
};

}  // namespace beamcam::sim
