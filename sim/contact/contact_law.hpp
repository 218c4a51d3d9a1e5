// The force of compliant contact along the normal: F = K δⁿ (1 + D δ̇/δ̇₋), never negative. MODEL.md §8.
#pragma once

namespace beamcam::sim {

inline constexpr double kZeroFactor = 1e-9;  // of the factor of the clamp: smaller ones are rounding and have no sign

// The force and its derivatives by penetration and rate; zero where the law would pull.
struct ForceAndSlopes {
    double force = 0, by_depth = 0, by_rate = 0;
};

struct NormalLaw {
    double stiffness = 1e8;  // K [N/m^n]
    double exponent = 1.5;   // n
    double damping = 0;      // D [–]

    // δ penetration [m] (<= 0: no force), δ̇ its rate, δ̇₋ > 0 the approach speed of this touch [m/s].
    ForceAndSlopes linearized(double penetration, double rate, double approach) const;
    double force(double penetration, double rate, double approach) const {  // [N]
        return linearized(penetration, rate, approach).force;
    }
    double elastic(double penetration) const;        // K δⁿ [N]
    double stored_energy(double penetration) const;  // K δⁿ⁺¹/(n+1) [J]
    // 1 + D δ̇/δ̇₋: where it turns negative the force is clamped, with a kink.
    double factor(double rate, double approach) const { return 1 + damping * rate / approach; }
};

}  // namespace beamcam::sim
