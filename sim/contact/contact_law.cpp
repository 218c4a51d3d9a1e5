#include "sim/contact/contact_law.hpp"

#include <cmath>

#include "sim/base/assert.hpp"

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

double NormalLaw::stored_energy(double penetration) const {
    return penetration > 0 ? elastic(penetration) * penetration / (exponent + 1) : 0;
}

}  // namespace beamcam::sim
