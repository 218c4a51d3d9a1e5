// Friction of compliant contact: regularized Coulomb friction, or a bristle that sticks and slides. MODEL.md §8.
#pragma once

#include <cmath>

#include "sim/contact/contact_law.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// stick-slip friction: sticking, or sliding towards +t or −t.
enum class Grip { stick, slide_plus, slide_minus };

struct FrictionLaw {
    double kinetic = 0, limit = 0;  // μ, μ_s [–]
    double slip_speed = 1e-3;       // v_s [m/s]
    bool bristle = false;
    double stiffness = 0, damping = 0;  // of the bristle: k [N/m], c [N s/m]
    // A bristle with a dashpot lags behind its force; only then is its deflection z a state while sliding (S36), and
    // only when the lag matters within a contact.
    bool lags = false;

    // `mass`: of the beam [kg].
    static FrictionLaw of(const Problem& problem, const NormalLaw& normal, double mass);

    bool none() const { return kinetic == 0 && limit == 0; }
    // Coulomb friction over the normal force.                                                              (S34)
    double ratio(double slip) const { return -kinetic * std::tanh(slip / slip_speed); }
    double coulomb(double normal, double slip) const { return -kinetic * normal * std::tanh(slip / slip_speed); }
    // On the beam along t, at deflection z [N].
    double force(Grip grip, double normal, double slip, double z) const;
    // Bristle deflection that carries the sliding force: where z is put at slip (S36).
    double sliding_bristle(Grip grip, double normal) const { return sign(grip) * kinetic * normal / stiffness; }
    // Where z is put when sliding ends: spring and dashpot go on with that force.
    double caught_bristle(Grip grip, double normal, double slip) const {
        return sliding_bristle(grip, normal) - damping / stiffness * slip;
    }
    double bristle_rate(Grip grip, double normal, double slip, double z) const;  // ż [m/s]
    // Speed of the bristle's foot over the cam in the direction of sliding, v_t − ż.
    double foot_speed(Grip grip, double normal, double slip, double z) const {
        return sign(grip) * (slip - bristle_rate(grip, normal, slip, z));
    }
    // Of sliding; −1 also while sticking.
    static double sign(Grip grip) { return grip == Grip::slide_plus ? 1 : -1; }
};

}  // namespace beamcam::sim
