#include "sim/contact/friction.hpp"

#include <algorithm>

#include "sim/contact/constants.hpp"

namespace beamcam::sim {

FrictionLaw FrictionLaw::of(const Problem& problem, const NormalLaw& normal, double mass) {
    FrictionLaw law;
    if (const auto* coulomb = std::get_if<CoulombFriction>(&problem.contact.friction)) {
        law.kinetic = law.limit = coulomb->coefficient;
        law.slip_speed = coulomb->slip_speed;
    } else if (const auto* stick_slip = std::get_if<StickSlipFriction>(&problem.contact.friction)) {
        law.bristle = problem.cam.has_value() && problem.contact.model == ContactModel::compliant;
        law.kinetic = stick_slip->coefficient;
        law.limit = std::max(law.kinetic, stick_slip->static_coefficient.value_or(law.kinetic));
        if (!law.bristle) return law;
        // Mindlin's ratio of tangential to normal stiffness, 2(1−ν)/(2−ν), times the normal stiffness n K δⁿ⁻¹ at the
        // penetration that the beam's mass reaches at 1 m/s (S37).
        const double n = normal.exponent, nu = problem.beam.poisson_ratio;
        const double depth = impact_depth(n, normal.stiffness, mass, 1);
        law.stiffness =
            stick_slip->stiffness.value_or(2 * (1 - nu) / (2 - nu) * n * normal.stiffness * std::pow(depth, n - 1));
        law.damping = stick_slip->damping.value_or(0);
        law.lags = law.damping / law.stiffness > kShortestLag * depth;  // at 1 m/s the depth is a time in seconds
    }
    return law;
}

double FrictionLaw::force(FrictionState state, double normal, double slip, double z) const {
    if (none()) return 0;
    if (!bristle) return coulomb(normal, slip);
    if (state == FrictionState::stick) return -(stiffness * z + damping * slip);  // (S35)
    return state == FrictionState::slide_plus ? -kinetic * normal : kinetic * normal;
}

// While sliding, the spring and the dashpot together carry the kinetic friction: k z + c ż = ±μN (S36).
double FrictionLaw::bristle_rate(FrictionState state, double normal, double slip, double z) const {
    if (state == FrictionState::stick) return slip;
    return lags ? stiffness / damping * (sliding_bristle(state, normal) - z) : 0;
}

}  // namespace beamcam::sim
