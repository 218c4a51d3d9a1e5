#include "sim/problem/assumptions.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace beamcam::sim {
namespace {

constexpr double kSlender = 10;              // L/h from which the first modes of Euler and Bernoulli are good to 2 %
constexpr double kVisibleCorrection = 0.05;  // of a frequency
constexpr double kShearFactor = 5.0 / 6;     // κ of a rectangle

bool is_of_the_paper(const Beam& beam) {
    const Beam paper;
    return beam.length == paper.length && !beam.section && !beam.material && beam.area == paper.area &&
           beam.second_moment == paper.second_moment && beam.density == paper.density &&
           beam.youngs_modulus == paper.youngs_modulus;
}

bool is_of_the_paper(const Cam& cam) {
    return !cam.profile && cam.radius == Cam{}.radius && !cam.material && !cam.youngs_modulus;
}

std::string about_slenderness(const Beam& beam) {
    const double slenderness = beam.length / (2 * section_properties(beam).c_max), loss = shear_correction(beam);
    std::string text = fmt::format(
        "beam: length / depth = {:.3g}; shear and rotary inertia, which are not modelled, "
        "would lower the frequency of shape {} by {:.2g} %",
        slenderness, beam.modes, 100 * loss);
    if (slenderness < kSlender)
        text += fmt::format("; Euler–Bernoulli beams are slender, {:g} or more", kSlender);
    else if (loss > kVisibleCorrection)
        text += "; use fewer modes, or a thinner beam";
    return text;
}

std::string about_bending(const Problem& problem) {
    const double slope = static_slope(problem);
    return fmt::format("beam: clamped, its weight bends it by {:.2g} rad at the tip; the model {} {}", slope,
                       name(problem.beam.model),
                       problem.beam.model == ModelKind::exact ? "holds for any bending"
                       : slope > kSmallSlope ? fmt::format("holds up to about {:g} rad: use \"exact\"", kSmallSlope)
                                             : fmt::format("holds up to about {:g} rad", kSmallSlope));
}

std::string about_stiffness(Problem problem) {
    const double assumed = contact_stiffness(problem), exponent = contact_exponent(problem);
    problem.contact.stiffness.reset();
    problem.contact.exponent.reset();
    std::string text = fmt::format(
        "contact.stiffness: none is given, so {:g} N/m^{:g} is assumed, which suits the paper's example; \"hertz\" is ",
        assumed, exponent);
    if (problem.cam->profile && !is_line_contact(problem))
        return text + "that of a sphere with the cam's radius of curvature at the contact";
    const std::string contact =
        is_line_contact(problem)
            ? fmt::format("a line contact of {:g} m", std::get<Rectangle>(*problem.beam.section).width)
            : fmt::format("a sphere of {:g} m on a plane", problem.cam->radius);
    return text + fmt::format("{:.3g} N/m^{:.3g} here, that of {}", contact_stiffness(problem),
                              contact_exponent(problem), contact);
}

}  // namespace

// ω = ω_EB [1 − ½(βr)²(1 + E/(κG))], r² = I/A, E/G = 2(1 + ν), βL = (N − ½)π                                 (S99)
double shear_correction(const Beam& beam) {
    if (beam.model == ModelKind::rigid) return 0;
    const SectionProperties section = section_properties(beam);
    const double beta = (beam.modes - 0.5) * std::numbers::pi / beam.length;
    const double shear = 2 * (1 + material_properties(beam).poisson_ratio) / kShearFactor;
    return 0.5 * beta * beta * section.second_moment / section.area * (1 + shear);
}

double static_slope(const Problem& problem) {
    const Beam& beam = problem.beam;
    if (beam.model == ModelKind::rigid) return 0;
    return beam.line_density() * std::fabs(problem.gravity) * std::pow(beam.length, 3) / (6 * beam.bending_stiffness());
}

std::vector<std::string> assumptions(const Problem& problem, bool has_stiffness, double end_time) {
    std::vector<std::string> out;
    const bool own_beam = !is_of_the_paper(problem.beam);
    const bool own_cam = problem.cam && !is_of_the_paper(*problem.cam);
    if (own_beam && problem.beam.model != ModelKind::rigid) {
        out.push_back(about_slenderness(problem.beam));
        out.push_back(about_bending(problem));
    }
    const bool needs_stiffness = problem.cam && problem.contact.model == ContactModel::compliant;
    if (needs_stiffness && !has_stiffness && (own_beam || own_cam)) out.push_back(about_stiffness(problem));
    const ModelKind model = problem.beam.model;
    const bool has_shapes = model != ModelKind::rigid && model != ModelKind::exact;
    const bool torque_on_hub = problem.hub.spring || !std::holds_alternative<FreeDrive>(problem.hub.drive);
    if (has_shapes && torque_on_hub && resolved_basis(problem) == Basis::hub_beam)
        out.push_back(
            "beam.basis: hub-beam shapes have only the moment of the hub's inertia at the root, so deflections under "
            "the torque on the hub converge slowly with beam.modes, as `beamcam accuracy` shows");
    const auto* torque = std::get_if<TorqueTable>(&problem.hub.drive);
    const auto* angle = std::get_if<AngleTable>(&problem.hub.drive);
    if (const double last = torque ? torque->t.back() : angle ? angle->t.back() : end_time; last < end_time)
        out.push_back(fmt::format("hub.drive: after the table's last time, {:g} s, the {} stays constant", last,
                                  torque ? "torque" : "speed"));
    return out;
}

}  // namespace beamcam::sim
