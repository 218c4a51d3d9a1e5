#include "sim/contact/contact_law.hpp"

#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

double NormalLaw::elastic(double penetration) const {
    if (!(penetration > 0)) return 0;
    if (exponent == 1.5) return stiffness * penetration * std::sqrt(penetration);
    return stiffness * std::pow(penetration, exponent);
}

ForceAndSlopes NormalLaw::linearized(double penetration, double rate, double approach) const {
    if (!(penetration > 0)) return {};
    const double bracket = factor(rate, approach);
    if (!(bracket > 0)) return {};
    const double stored = elastic(penetration), f = stored * bracket;  // (S30)
    return {f, exponent * f / penetration, stored * damping / approach};
}

double NormalLaw::stored_energy(double penetration) const {
    return penetration > 0 ? elastic(penetration) * penetration / (exponent + 1) : 0;
}

namespace {

// {D(1+e) − ln[(1+D)/(1−eD)]}/D²: zero where a contact with the factor D has the restitution e   (S31)
double restitution_residual(double d, double e) {
    if (d > 0.02) return (d * (1 + e) - std::log1p(d) + std::log1p(-e * d)) / (d * d);
    // Its series Σ_{k≥2} Dᵏ⁻²[(−1)ᵏ − eᵏ]/k where the difference would cancel; eight terms reach rounding.
    double sum = 0.5 * (1 - e) * (1 + e), power = 1, ek = e * e;
    for (int k = 3; k <= 11; ++k) {
        power *= d;
        ek *= e;
        sum += power * ((k % 2 ? -1.0 : 1.0) - ek) / k;
    }
    return sum;
}

}  // namespace

double damping_factor(DampingLaw law, double c) {
    switch (law) {
        case DampingLaw::none:
            return 0;
        case DampingLaw::hunt_crossley:
            return 1.5 * (1 - c);
        case DampingLaw::lankarani_nikravesh:
            return 0.75 * (1 - c * c);
        case DampingLaw::herbert_mcwhannell:
            return 6 * (1 - c) / ((2 * c - 1) * (2 * c - 1) + 3);
        case DampingLaw::lee_wang:
            return 0.75 * (1 - c);
        case DampingLaw::gonthier:
            return (1 - c * c) / c;
        case DampingLaw::flores:
            return 8 * (1 - c) / (5 * c);
        case DampingLaw::hu_guo:
            return 1.5 * (1 - c) / c;
        case DampingLaw::zhang_sharf: {
            if (c >= 1) return 0;
            // The residual starts negative for small D·(…)… its non-zero root lies below 1/c, where the
            // The reduced residual is (1 − c²)/2 > 0 at D = 0 and −∞ at D = 1/c.
            const auto f = [c](double d) { return restitution_residual(d, c); };
            const double top = (1 - 1e-15) / c;
            if (!(f(top) < 0)) return top;
            return find_root(f, 0.0, top);
        }
    }
    return 0;
}

double effective_restitution(double d) {
    if (d <= 0) return 1;
    const auto f = [d](double e) { return restitution_residual(d, e); };
    const double top = std::fmin(1.0, (1 - 1e-15) / d);
    // Positive at e = 0; towards e = 1/D the logarithm tends to −∞; negative at e = 1 when D < 1.
    if (!(f(top) < 0)) return top;
    return find_root(f, 0.0, top);
}

}  // namespace beamcam::sim
