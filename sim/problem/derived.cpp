// The derived values of problem.hpp.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/assert.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

constexpr double kPaperDepth = 0.0368;    // [m] depth of the beam with the default section
constexpr double kCollisionGap = 0.02;    // [s] "auto" for a beam of 1 m on Earth
constexpr double kPalmgrenFactor = 1.36;  // δ = 1.36 [(η₁ + η₂)F]^0.9/b^0.8, η = (1 − ν²)/E
// ω₁√(ρAL⁴/(EI)) of a clamped beam, the square of its first eigenvalue.
constexpr double kFirstClampedFrequency = 3.5160152685;

bool is_prescribed(const Drive& drive) {
    return std::holds_alternative<ConstantSpeed>(drive) || std::holds_alternative<SpinUp>(drive) ||
           std::holds_alternative<AngleTable>(drive);
}

bool is_independent_of_time(const Drive& drive) {
    return std::holds_alternative<FreeDrive>(drive) || std::holds_alternative<ConstantTorque>(drive);
}

Basis resolved_basis(const Problem& problem) {
    if (problem.beam.basis != Basis::automatic) return problem.beam.basis;
    if (is_prescribed(problem.hub.drive) || problem.beam.model == ModelKind::paper) return Basis::cantilever;
    return Basis::hub_beam;
}

bool is_line_contact(const Problem& problem) {
    return problem.beam.section && std::holds_alternative<Rectangle>(*problem.beam.section);
}

double contact_exponent(const Problem& problem) {
    const bool line = !problem.contact.stiffness && is_line_contact(problem);
    return problem.contact.exponent.value_or(line ? kLineExponent : kPointExponent);
}

double contact_stiffness(const Problem& problem) {
    const double factor = problem.contact.stiffness_factor;
    if (problem.contact.stiffness || !problem.cam) return factor * problem.contact.stiffness.value_or(0);
    const Cam& cam = *problem.cam;
    const MaterialProperties beam = material_properties(problem.beam);
    const MaterialProperties disc =
        cam.material ? material_properties(*cam.material)
                     : MaterialProperties{0, cam.youngs_modulus.value_or(beam.youngs_modulus), cam.poisson_ratio};
    const auto compliance = [](const MaterialProperties& of) {
        return (1 - of.poisson_ratio * of.poisson_ratio) / of.youngs_modulus;
    };
    const double modulus = factor / (compliance(beam) + compliance(disc));
    if (is_line_contact(problem))
        return modulus * std::pow(std::get<Rectangle>(*problem.beam.section).width, 2 - kLineExponent) /
               std::pow(kPalmgrenFactor, kLineExponent);  // (S29a)
    return 4.0 / 3.0 * modulus * std::sqrt(cam.radius);   // (S29)
}

double collision_gap(const Problem& problem) {
    const double g = problem.gravity == 0 ? kEarthGravity : std::fabs(problem.gravity);
    return problem.contact.collision_gap.value_or(kCollisionGap * std::sqrt(problem.beam.length * kEarthGravity / g));
}

// The paper's beam is drawn with the depth that its section was made with, 0.1 % more than √(12 I/A).
double beam_depth(const Beam& beam) {
    if (beam.depth) return *beam.depth;
    if (beam.section) return 2 * section_properties(*beam.section).c_max;
    if (beam.area == Beam{}.area && beam.second_moment == Beam{}.second_moment) return kPaperDepth;
    return std::sqrt(12 * beam.second_moment / beam.area);
}

double contact_offset(const Problem& problem) {
    return problem.contact.offset.value_or(0.5 * beam_depth(problem.beam));
}

// In factors that cannot overflow together.
double first_clamped_frequency(const Beam& b) {
    const SectionProperties section = section_properties(b);
    const MaterialProperties material = material_properties(b);
    return kFirstClampedFrequency * std::sqrt(material.youngs_modulus) * std::sqrt(section.second_moment) /
           (std::sqrt(material.density) * std::sqrt(section.area)) / b.length / b.length;
}

double impact_depth(double exponent, double stiffness, double mass, double speed) {
    BEAMCAM_ASSERT(exponent >= 1 && stiffness > 0 && mass >= 0 && speed >= 0);
    return std::pow(0.5 * (exponent + 1) * mass * speed * speed / stiffness, 1 / (exponent + 1));
}

double cam_period(const Problem& problem) {
    const bool turns = problem.cam && problem.cam->speed != 0;
    return turns ? 2 * std::numbers::pi / std::fabs(problem.cam->speed) : 1;
}

double turn_fraction(double turns) { return turns - std::floor(turns); }

double section_phase(const Problem& problem, double psi) {
    if (!problem.cam || problem.cam->speed == 0) return 0;
    return turn_fraction(std::copysign(1, problem.cam->speed) * (problem.cam->phase - psi) / (2 * std::numbers::pi));
}

void set_shapes(Problem& problem, ModelKind model, Basis basis, int modes) {
    Beam& beam = problem.beam;
    const bool angles = model == ModelKind::exact;  // its coordinates are angles, those of other models lengths
    const bool same = basis == beam.basis && angles == (beam.model == ModelKind::exact) && model != ModelKind::rigid;
    const auto count = static_cast<std::size_t>(modes);
    for (std::vector<double>* given : {&problem.initial.q, &problem.initial.q_dot})
        given->resize(same ? std::min(given->size(), count) : 0);
    if (beam.damping_ratio.size() > 1) beam.damping_ratio.resize(count, double(beam.damping_ratio.back()));
    beam.model = model;
    beam.basis = basis;
    beam.modes = modes;
}

}  // namespace beamcam::sim
