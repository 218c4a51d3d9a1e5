// The equations of motion of hub and beam: inertia, bias forces, energies, and the kinematics of a point of the centre
// line. One class for each kind of beam model. No cam, no contact, no time.
//
// Coordinates ξ = (Θ, q_1…q_N): Θ is the angle of the frame, q_i are the coordinates of the scene (metres; radians for
// `exact`). The hub angle is θ = Θ + Σ h_i q_i, with h_i = y_i′(0) in hub-beam shapes, else 0. MODEL.md §3.
//
// `set` stores a state, which all other functions refer to. They allocate nothing. One model serves one thread; use
// `clone` for others.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "sim/base/vec2.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

inline constexpr int kMaxModes = 40;
inline constexpr int kMaxSize = 1 + kMaxModes;

// A point of the centre line: position, its derivatives by arc position, and velocities.
struct BeamPoint {
    Vec2 r;   // [m]
    Vec2 r1;  // ∂r/∂x [–]
    Vec2 r2;  // ∂²r/∂x² [1/m]
    Vec2 v;   // material velocity ṙ [m/s]
    Vec2 v1;  // ∂ṙ/∂x [1/s]
};

struct Energies {
    double kinetic = 0;  // T [J]
    double gravity = 0;  // V_g, zero at the height of O [J]
    double elastic = 0;  // bending [J]
};

// The linear equations of motion about the straight beam at rest, without gravity: inertia and stiffness of ξ, and the
// centrifugal stiffness per Ω² of a beam that rotates at Ω. MODEL.md §13.
struct Linearization {
    Eigen::MatrixXd mass, stiffness, centrifugal;
    explicit Linearization(Eigen::Index size) { mass = stiffness = centrifugal = Eigen::MatrixXd::Zero(size, size); }
};

class Model {
  public:
    virtual ~Model() = default;
    virtual std::unique_ptr<Model> clone() const = 0;

    int size() const { return size_; }  // 1 + N
    double mass() const { return mass_; }
    double length() const { return length_; }

    // Copies the state ξ, ξ̇: two arrays of `size` numbers.
    void set(const double* xi, const double* rate);

    const double* coordinates() const { return xi_; }  // ξ

    // f ← generalized forces of gravity, elasticity, damping and velocity, without contact and torque. Also computes
    // the inertia for the solves below; false if it is not positive definite.
    virtual bool assemble(double* f) = 0;
    // f ← M⁻¹ f with the inertia of the last `assemble`.
    virtual void solve(double* f) const = 0;
    // With the prescribed angular acceleration `hub` of the hub, not in hub-beam shapes: f ← (hub, q̈). Returns the
    // torque that it takes besides the forces in f[0] [N m].
    virtual double solve_held(double* f, double hub) const = 0;

    // Prepares for many calls at these arc positions.
    virtual void keep(const Eigen::VectorXd& /*x*/) {}
    // Kinematics at arc position x in [0, L].
    virtual void point(double x, BeamPoint& p) const = 0;
    // ∂X/∂ξ, ∂Y/∂ξ and ∂χ/∂ξ, χ the angle of the tangent; arrays of `size`.
    virtual void jacobian(double x, double* jx, double* jy, double* jchi) const = 0;
    // Acceleration of the point for ξ̈ = 0 [m/s²].
    virtual Vec2 convective(double x) const = 0;
    virtual double bending_moment(double x) const = 0;  // EI κ [N m]
    virtual Energies energies() const = 0;
    double damping_power() const;                                      // q̇ᵀ C_d q̇ [W]
    const Eigen::MatrixXd* damping() const { return damping_.get(); }  // C_d, N × N [kg/s]; null if undamped

    double hub_angle() const;                           // θ
    double hub_rate() const;                            // θ̇
    const double* hub_row() const { return hub_row_; }  // ∂θ/∂ξ

    virtual Linearization linearize() const = 0;
    // Angular frequency that belongs to q_i, i from 0 [rad/s]. Bounds of step sizes are derived from it.
    virtual double frequency(int i) const = 0;

  protected:
    explicit Model(const Problem& problem);
    Model(const Model&) = default;
    virtual void state_changed() = 0;
    // Adds −C_d q̇ to f[1…N].
    void add_damping(double* f) const;
    // Computes C_d from damping ratios or the Kelvin–Voigt time, by `linearize` (S20), (S21).
    void build_damping(const Problem& problem);

    int size_ = 1, modes_ = 0;
    double length_, mass_, radius_, hub_inertia_, gravity_, line_density_, stiffness_;
    double xi_[kMaxSize] = {}, rate_[kMaxSize] = {};
    double hub_row_[kMaxSize] = {};
    std::shared_ptr<const Eigen::MatrixXd> damping_;
};

std::unique_ptr<Model> make_model(const Problem& problem);

}  // namespace beamcam::sim
