// The equations of motion of hub and beam, one class a rung of the model ladder: inertia, bias
// forces, energies, and the kinematics of a point of the centre line. No cam, no contact, no time.
//
// Coordinates ξ = (Θ, q_1…q_N): Θ turns the frame, q are the scene's own (metres; radians for
// `exact`). The hub angle is θ = Θ + Σ h_i q_i, h = y_i′(0) in hub-beam shapes, else 0. MODEL.md §3.
//
// A model is a calculator with a memory of one state: `set` it, then ask. Nothing allocates after
// construction. Not for use by two threads at once; `clone` for another observer.
#pragma once

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

class Model {
  public:
    virtual ~Model() = default;
    virtual std::unique_ptr<Model> clone() const = 0;

    int size() const { return size_; }  // 1 + N
    double mass() const { return mass_; }
    double length() const { return length_; }

    // The state that everything below refers to; both arrays of `size` numbers, kept by copy.
    void set(const double* xi, const double* rate);

    const double* coordinates() const { return xi_; }  // as set

    // f ← generalized forces of gravity, elasticity, damping and velocity (everything but contact
    // and torque), and the inertia for the solves below. False: the inertia is not positive.
    virtual bool assemble(double* f) = 0;
    // f ← M⁻¹ f with the inertia of the last `assemble`.
    virtual void solve(double* f) const = 0;
    // The hub held at the acceleration `hub` (frame = hub: cantilever coordinates): f ← (hub, q̈),
    // and the torque that does it is returned [N m].
    virtual double solve_held(double* f, double hub) const = 0;

    // Kinematics at arc position x in [0, L].
    virtual void point(double x, BeamPoint& p) const = 0;
    // ∂r/∂ξ as rows of X and Y, and ∂χ/∂ξ of the angle χ of the tangent; arrays of `size`.
    virtual void jacobian(double x, double* jx, double* jy, double* jchi) const = 0;
    // Acceleration of the point at ξ̈ = 0: (dJ/dt) ξ̇ [m/s²].
    virtual Vec2 convective(double x) const = 0;
    virtual double bending_moment(double x) const = 0;  // EI κ [N m]
    virtual Energies energies() const = 0;
    double damping_power() const;  // q̇ᵀ C_d q̇ [W]
    bool damped() const { return damped_; }
    // Diagonal of C_d [kg/s], N numbers; null when undamped or when C_d is full.
    const double* diagonal_damping() const { return damped_ && damping_diagonal_ ? damping_->data() : nullptr; }

    // C_d, N² numbers column by column; empty when undamped.
    std::vector<double> damping_matrix() const;

    double hub_angle() const;                           // θ of the set state
    double hub_rate() const;                            // θ̇
    const double* hub_row() const { return hub_row_; }  // ∂θ/∂ξ

    // Linearized about the straight beam at rest, without gravity: dense, column-major, size²:
    // inertia and stiffness of (Θ, q), and the centrifugal stiffness per Ω² of the turning beam.
    virtual void linearize(double* mass, double* stiffness, double* centrifugal) const = 0;
    // Angular frequency scale of coordinate i (0-based, of q) for step bounds: √(K_ii/M_ii).
    virtual double frequency(int i) const = 0;

  protected:
    explicit Model(const Problem& problem);
    Model(const Model&) = default;
    virtual void state_changed() = 0;
    // −C_d q̇ added to f[1…N].
    void add_damping(double* f) const;
    // C_d from the problem's ratios or Kelvin–Voigt time; needs `linearize` (S20, S21).
    void build_damping(const Problem& problem);

    int size_ = 1, modes_ = 0;
    double length_, mass_, radius_, hub_inertia_, gravity_, line_density_, stiffness_;
    double xi_[kMaxSize] = {}, rate_[kMaxSize] = {};
    double hub_row_[kMaxSize] = {};
    bool damped_ = false, damping_diagonal_ = true;
    std::shared_ptr<const std::vector<double>> damping_;  // N (diagonal) or N² numbers
};

// The rung of the ladder that the problem names.
std::unique_ptr<Model> make_model(const Problem& problem);

}  // namespace beamcam::sim
