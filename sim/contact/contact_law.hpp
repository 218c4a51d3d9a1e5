// The forces of compliant contact. The normal force is F = K δⁿ (1 + D δ̇/δ̇₋), clamped at zero, MODEL.md (S30); friction
// is regularized Coulomb friction, or a bristle that sticks and slips, MODEL.md §8.
#pragma once

#include <cmath>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// The force and its derivatives by penetration and penetration rate; zero where the force is clamped.
struct ForceAndSlopes {
    double force = 0, by_depth = 0, by_rate = 0;
};

struct NormalLaw {
    double stiffness = 1e8;  // K [N/m^n]
    double exponent = 1.5;   // n
    double damping = 0;      // D [–]
    // ρ for which Hertz's stiffness of a sphere is given, of a cam whose radius of curvature changes; 0: K is constant.
    double hertz_radius = 0;  // [m]

    // The law where the cam has that radius of curvature [m] (S29).
    NormalLaw at(double radius) const {
        NormalLaw law = *this;
        if (hertz_radius > 0) law.stiffness *= std::sqrt(radius / hertz_radius);
        return law;
    }
    // `penetration` δ [m] (<= 0: no force), `rate` δ̇ [m/s], `approach` δ̇₋ > 0, the approach speed of this touch [m/s].
    ForceAndSlopes linearized(double penetration, double rate, double approach) const;
    double force(double penetration, double rate, double approach) const {  // [N]
        return linearized(penetration, rate, approach).force;
    }
    // The penetration [m] at which the force is `normal` [N]; of the opposite force it is the opposite.
    double penetration(double normal, double rate, double approach) const;
    double elastic(double penetration) const;        // K δⁿ [N]
    double stored_energy(double penetration) const;  // K δⁿ⁺¹/(n+1) [J]
    // 1 + D δ̇/δ̇₋; where it is negative the force is clamped.
    double factor(double rate, double approach) const { return 1 + damping * rate / approach; }
};

struct FrictionLaw {
    double kinetic = 0, limit = 0;  // μ, μ_s [–]
    double slip_speed = 1e-3;       // v_s of Coulomb friction [m/s]
    bool bristle = false;           // stick-slip friction
    double stiffness = 0;           // of the bristle: k [N/m]

    // `mass`: mass of the beam [kg].
    static FrictionLaw of(const Problem& problem, const NormalLaw& normal, double mass);

    bool none() const { return kinetic == 0 && limit == 0; }
    // F_t/N of Coulomb friction (S34).
    double ratio(double slip) const { return -kinetic * std::tanh(slip / slip_speed); }
    double coulomb(double normal, double slip) const { return normal * ratio(slip); }
    // −∂F_t/∂v_t of Coulomb friction where |F_t|/N is `along` [N s/m].
    double resistance(double normal, double along) const {
        return kinetic > 0 ? normal * (kinetic - along * along / kinetic) / slip_speed : 0;
    }
    // The slip v with v − cF_t(N, v) = slip − c·friction, c = `mobility` [m/(N s)]: the law's pair of friction and slip
    // that a slip which yields to friction by c passes from the present one.
    double slip_near(double normal, double friction, double slip, double mobility) const;
    // Friction force on the beam along t, for a bristle with the deflection z [N].
    double force(FrictionState state, double normal, double slip, double z) const;
    // The bristle's deflection at which its spring carries the sliding force (S36).
    double sliding_bristle(FrictionState state, double normal) const {
        return sign(state) * kinetic * normal / stiffness;
    }
    // Positive while the state of the bristle lasts: [N] of stick, [m/s] of sliding. `growth`: Ṅ [N/s], which counts
    // while it slides.                                                                                  (S35), (S36)
    double margin(FrictionState state, double normal, double growth, double slip, double z) const;
    // +1 or −1, the direction of sliding; −1 while sticking, too.
    static double sign(FrictionState state) { return state == FrictionState::slide_plus ? 1 : -1; }
};

}  // namespace beamcam::sim
