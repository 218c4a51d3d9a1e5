#include "sim/contact/contact_law.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/assert.hpp"
#include "sim/base/numerics.hpp"

namespace beamcam::sim {

double NormalLaw::elastic(double penetration) const {
    if (!(penetration > 0)) return 0;
    if (exponent == 1.5) return stiffness * penetration * std::sqrt(penetration);
    return stiffness * std::pow(penetration, exponent);
}

ForceAndSlopes NormalLaw::linearized(double penetration, double rate, double approach) const {
    BEAMCAM_ASSERT(approach > 0 && stiffness > 0 && exponent >= 1);
    if (!(penetration > 0)) return {};
    const double bracket = factor(rate, approach);
    if (!(bracket > 0)) return {};
    const double stored = elastic(penetration), f = stored * bracket;  // (S30)
    return {f, exponent * f / penetration, stored * damping / approach};
}

double NormalLaw::penetration(double normal, double rate, double approach) const {
    return std::copysign(std::pow(std::fabs(normal) / (stiffness * factor(rate, approach)), 1 / exponent), normal);
}

double NormalLaw::stored_energy(double penetration) const {
    return penetration > 0 ? elastic(penetration) * penetration / (exponent + 1) : 0;
}

FrictionLaw FrictionLaw::of(const Problem& problem, const NormalLaw& normal, double mass) {
    FrictionLaw law;
    if (const auto* coulomb = std::get_if<CoulombFriction>(&problem.contact.friction)) {
        law.kinetic = law.limit = coulomb->coefficient;
        law.slip_speed = coulomb->slip_speed;
    } else if (const auto* stick_slip = std::get_if<StickSlipFriction>(&problem.contact.friction)) {
        law.kinetic = stick_slip->coefficient;
        law.limit = std::max(law.kinetic, stick_slip->static_coefficient.value_or(law.kinetic));
        law.bristle = problem.cam.has_value() && problem.contact.model == ContactModel::compliant && !law.none();
        if (!law.bristle) return law;
        // Mindlin's ratio of tangential to normal stiffness, 2(1−ν)/(2−ν), times the normal stiffness n K δⁿ⁻¹ at the
        // penetration that the beam's mass reaches at 1 m/s (S37).
        const double n = normal.exponent, nu = material_properties(problem.beam).poisson_ratio;
        const double depth = impact_depth(n, normal.stiffness, mass, 1);
        law.stiffness =
            stick_slip->stiffness.value_or(2 * (1 - nu) / (2 - nu) * n * normal.stiffness * std::pow(depth, n - 1));
    }
    return law;
}

// Newton's method from below the magnitude of v, from where it does not overshoot: tanh is concave. Where the slip
// yields so little that it never does, the slip is as good.
double FrictionLaw::slip_near(double normal, double friction, double slip, double mobility) const {
    const double most = mobility * kinetic * normal, trial = slip - mobility * friction;
    if (!(most > slip_speed)) return slip;
    double v = trial / (1 + most / slip_speed);
    for (int i = 0; i < kMostIterations; ++i) {
        const double share = std::tanh(v / slip_speed);
        const double step = (trial - v - most * share) / (1 + most / slip_speed * (1 - share * share));
        v += step;
        if (!(std::fabs(step) > kNegligible * std::fabs(v))) break;
    }
    return v;
}

double FrictionLaw::force(FrictionState state, double normal, double slip, double z) const {
    if (none()) return 0;
    if (!bristle) return coulomb(normal, slip);
    if (state == FrictionState::stick) return -stiffness * z;  // (S35)
    return state == FrictionState::slide_plus ? -kinetic * normal : kinetic * normal;
}

double FrictionLaw::margin(FrictionState state, double normal, double growth, double slip, double z) const {
    if (state == FrictionState::stick) return limit * normal - std::fabs(force(state, normal, slip, z));
    return sign(state) * slip - kinetic * growth / stiffness;
}

}  // namespace beamcam::sim
