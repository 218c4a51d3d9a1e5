// Values that follow from a problem's numbers.
#include <cmath>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

Basis resolved_basis(const Problem& problem) {
    if (problem.beam.basis != Basis::automatic) return problem.beam.basis;
    if (is_prescribed(problem.hub.drive) || problem.beam.model == ModelKind::paper) return Basis::cantilever;
    return Basis::hub_beam;
}

double contact_stiffness(const Problem& problem) {
    if (problem.contact.stiffness || !problem.cam) return problem.contact.stiffness.value_or(0);
    const Beam& beam = problem.beam;
    const Cam& cam = *problem.cam;
    const double cam_modulus = cam.youngs_modulus.value_or(beam.youngs_modulus);
    const double compliance = (1 - beam.poisson_ratio * beam.poisson_ratio) / beam.youngs_modulus +
                              (1 - cam.poisson_ratio * cam.poisson_ratio) / cam_modulus;
    return 4.0 / 3.0 / compliance * std::sqrt(cam.radius);  // (S29)
}

double contact_offset(const Problem& problem) { return problem.contact.offset.value_or(0.5 * problem.beam.depth); }

}  // namespace beamcam::sim
