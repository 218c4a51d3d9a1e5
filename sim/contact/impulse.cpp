#include "sim/contact/impulse.hpp"

#include "sim/contact/impulse_of.hpp"

namespace beamcam::sim {

ImpactResult resolve_impact(const Compliance& c, double v_n, double v_t, double friction, double restitution,
                            ImpactLaw law) {
    return resolve_impact<double>(c, v_n, v_t, friction, restitution, law);
}

}  // namespace beamcam::sim
