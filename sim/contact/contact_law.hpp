// The normal force of compliant contact, F = K δⁿ (1 + D δ̇/δ̇₋), clamped at zero. MODEL.md (S30).
#pragma once

namespace beamcam::sim {

// The force and its derivatives by penetration and penetration rate; zero where the force is clamped.
struct ForceAndSlopes {
    double force = 0, by_depth = 0, by_rate = 0;
};

struct NormalLaw {
    double stiffness = 1e8;  // K [N/m^n]
    double exponent = 1.5;   // n
    double damping = 0;      // D [–]

    // `penetration` δ [m] (<= 0: no force), `rate` δ̇ [m/s], `approach` δ̇₋ > 0, the approach speed of this touch [m/s].
    ForceAndSlopes linearized(double penetration, double rate, double approach) const;
    double force(double penetration, double rate, double approach) const {  // [N]
        return linearized(penetration, rate, approach).force;
    }
    double elastic(double penetration) const;        // K δⁿ [N]
    double stored_energy(double penetration) const;  // K δⁿ⁺¹/(n+1) [J]
    // 1 + D δ̇/δ̇₋; where it is negative the force is clamped.
    double factor(double rate, double approach) const { return 1 + damping * rate / approach; }
};

}  // namespace beamcam::sim
