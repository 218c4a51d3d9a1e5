#include "sim/dynamics/failure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/cam/cam_shape.hpp"
#include "sim/dynamics/constants.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {
namespace {

// The beam and its contact at the last good instant.
struct BeamState {
    double slope = 0, deflection = 0;  // of the tip against the root's tangent [rad], [m]
    double theta_dot = 0;              // |θ̇| [rad/s]
    double approach = 0;               // approach speed of the touch [m/s]
    double mass = 0;                   // effective mass at the contact point [kg]
    double x = 0, lock = 0;            // of the contact [m]; the coefficient of friction above which it may lock
};

BeamState beam_state(double t, System& system, const double* y) {
    BeamState out;
    system.set_state(t, y);
    BeamPoint root, tip;
    system.model().point(0, root);
    system.model().point(system.model().length(), tip);
    out.slope = std::fabs(std::atan2(cross(root.r1, tip.r1), dot(root.r1, tip.r1)));
    out.deflection = std::fabs(cross(root.r1, tip.r - root.r)) / norm(root.r1);
    out.theta_dot = std::fabs(system.model().hub_rate());
    out.approach = system.phase().approach;
    if (!system.has_cam()) return out;
    try {
        const ContactState c = system.contact(t, y);
        const Compliance response = system.compliance(t, y, c);
        if (response.nn > 0) out.mass = 1 / response.nn;
        out.x = c.x;
        out.lock = response.nn / std::fabs(response.nt);
    } catch (const InertiaLost&) {
        // The effective mass stays zero; inertia_message describes this failure.
    }
    return out;
}

const char* modes_noun(const Problem& p) { return p.beam.modes == 1 ? "mode" : "modes"; }

std::string model_and_modes(const Problem& p) {
    return fmt::format("{} model with {} {} {}", name(p.beam.model), p.beam.modes, name(resolved_basis(p)),
                       modes_noun(p));
}

// ρA g L⁴/(8EI), the static tip deflection of the clamped beam.
double sag(const Problem& p) {
    return p.beam.line_density() * std::fabs(p.gravity) * std::pow(p.beam.length, 4) / (8 * p.beam.bending_stiffness());
}

// True if the deflections are too large for a modal model.
bool large_deflection(const Problem& p, const BeamState& beam) {
    return p.beam.model != ModelKind::rigid && p.beam.model != ModelKind::exact && beam.slope > kLargestSlope;
}

// For a model in which fast rotation destabilizes the beam; else empty.
std::string divergence_message(const Problem& p, const BeamState& beam) {
    const double bending = first_clamped_frequency(p.beam);
    if (!(beam.theta_dot > kFastRotation * bending)) return "";
    const char* lacks = nullptr;
    if (p.beam.model == ModelKind::zeroth_order)
        lacks = "the zeroth-order model has no centrifugal stiffening, so that rotation only reduces the stiffness";
    if (p.beam.model == ModelKind::paper)
        lacks =
            "the paper's equation (4) has L cos θ for L in its centrifugal stiffening, so that rotation reduces the "
            "stiffness unless the beam is nearly level";
    if (!lacks) return "";
    return fmt::format(
        "the deflection grows without bound: {}, at |θ̇| = {:.3g} rad/s by more than the bending stiffness (first "
        "bending frequency {:.3g} rad/s); use \"model\": \"first-order\", which is the consistent equation, a stiffer "
        "beam, or a slower rotation",
        lacks, beam.theta_dot, bending);
}

std::string deflection_message(const Problem& p, const BeamState& beam) {
    if (std::string divergence = divergence_message(p, beam); !divergence.empty()) return divergence;
    std::string by;
    if (sag(p) > kLargestSag * p.beam.length)
        by = fmt::format(" (clamped, it would sag by {:.2g} m under gravity {:g} m/s^2)", sag(p), p.gravity);
    return fmt::format(
        "the beam has bent through {:.2g} rad, its tip by {:.2g} m of {:g} m{}; the {} holds for small deflections and "
        "breaks down here: use \"model\": \"exact\", a stiffer or lighter beam, or gentler loads (gravity, speeds, "
        "drive)",
        beam.slope, beam.deflection, p.beam.length, by, model_and_modes(p));
}

std::string inertia_message(const Problem& p) {
    const char* basis =
        resolved_basis(p) == Basis::cantilever && !is_prescribed(p.hub.drive) && p.beam.model != ModelKind::paper
            ? "\"basis\": \"hub-beam\", "
            : "";
    return fmt::format(
        "the {} lost its positive inertia: the hub ({:g} kg m^2) is too light for these shapes; use {}fewer modes, a "
        "larger hub.inertia, or \"model\": \"second-order\"",
        model_and_modes(p), p.hub.inertia, basis);
}

std::string passed_cam_message(const Problem& p, const BeamState& beam) {
    const double n = contact_exponent(p), k = contact_stiffness(p), radius = cam_shape(p)->inner_radius();
    const double depth = impact_depth(n, k, beam.mass, beam.approach);
    const std::string law = fmt::format("{:g} N/m^{:g}", k, n);
    if (depth < 0.5 * radius) {
        const bool prescribed = is_prescribed(p.hub.drive), rigid = p.beam.model == ModelKind::rigid;
        return fmt::format(
            "the beam was pressed through the centre of the cam (radius {:g} m), which no impact does at contact "
            "stiffness {}: the cause is {}",
            radius, law,
            !prescribed ? "the load on the beam; change hub.drive, gravity or the cam's path, or raise "
                          "contact.stiffness"
            : rigid     ? "the prescribed angle, which no force changes; change hub.drive or the cam's path"
                        : "the prescribed angle; change hub.drive or the cam's path, or raise contact.stiffness");
    }
    const double stiffness =
        0.5 * (n + 1) * beam.mass * beam.approach * beam.approach / std::pow(kUsableDepth * radius, n + 1);
    return fmt::format(
        "the beam was pressed through the centre of the cam: the touch at {:.3g} m/s is {:.2g} m deep at contact "
        "stiffness {}, the cam's radius {:g} m; use contact.stiffness of {:.1g} or more, a cam.radius of {:.1g} m "
        "or more, or \"contact\": {{\"model\": \"restitution\"}}, which has no penetration",
        beam.approach, depth, law, radius, stiffness, depth / kUsableDepth);
}

std::string locked_message(const Problem& p, const BeamState& beam) {
    return fmt::format(
        "friction locks the beam to the cam: at x = {:.3g} m, with the face {:.3g} m off the centre line, a "
        "coefficient "
        "above {:.2g} presses the beam into the cam by more than the contact force pushes it off; use a smaller "
        "contact.friction.coefficient or contact.offset, or another direction of cam.speed",
        beam.x, contact_offset(p), beam.lock);
}

std::string stuck_message(const Problem& p) {
    std::string what = "touch and release follow each other without progress in time: ";
    if (p.contact.model == ContactModel::restitution)
        return what + "use a smaller contact.restitution, or \"contact\": {\"model\": \"compliant\"}";
    if (std::holds_alternative<StickSlipFriction>(p.contact.friction))
        return what +
               "the bristle can neither stick nor slide; use a softer contact.friction.stiffness or "
               "\"friction\": {\"type\": \"coulomb\"}";
    return what + fmt::format("use a smaller solver.rtol (is {:g}), or \"method\": \"rk8\"", p.solver.rtol);
}

// The causes that limit the step size, and the remedies.
std::string step_size_limits(const Problem& p, System& system, const BeamState& beam, bool spent) {
    std::vector<std::string> needs;
    const double fastest = system.highest_frequency();
    if (fastest > 0)
        needs.push_back(fmt::format("{} {} up to {:.3g} rad/s need steps near {:.1g} s (fewer: longer ones)",
                                    p.beam.modes, modes_noun(p), fastest, 1 / fastest));
    if (p.cam && p.contact.model == ContactModel::compliant && beam.mass > 0) {
        // The depth at 1 m/s is also the time to it in seconds.
        const double n = contact_exponent(p), k = contact_stiffness(p);
        const std::string with = fastest > 0 ? fmt::format(" with {} {}", p.beam.modes, modes_noun(p)) : "";
        needs.push_back(fmt::format(
            "contact stiffness {:g} N/m^{:g}{} needs steps near {:.1g} s in a touch (softer, or \"contact\": "
            "{{\"model\": \"restitution\"}}: longer ones)",
            k, n, with, kSharpTouch * impact_depth(n, k, beam.mass, 1)));
    }
    if (const auto* coulomb = std::get_if<CoulombFriction>(&p.contact.friction);
        coulomb && p.contact.model == ContactModel::compliant && coulomb->slip_speed < kNarrowSlip)
        needs.push_back(
            fmt::format("friction reverses within {:g} m/s of slip (larger contact.friction.slip_speed: "
                        "longer steps)",
                        coulomb->slip_speed));
    if (p.contact.model == ContactModel::compliant && beam.approach > 0 && beam.approach < kSlowApproach &&
        damping_factor(p.contact.damping, p.contact.restitution) > 0)
        needs.push_back(
            fmt::format("the dissipation of this touch is divided by its approach speed of {:.2g} m/s (larger "
                        "contact.approach_floor.value: longer steps)",
                        beam.approach));
    const double ratio = system.damping_ratio();
    if (fastest > 0 && ratio > 1 && p.solver.method != Method::cvode_bdf)
        needs.push_back(
            fmt::format("damping {:.2g} times the critical one needs steps near {:.1g} s (\"method\": "
                        "\"cvode-bdf\" does not)",
                        ratio, 1 / (2 * ratio * fastest)));
    needs.push_back(fmt::format("rtol is {:g} (larger: longer steps)", p.solver.rtol));
    if (spent) needs.push_back("or raise solver.max_steps");
    return fmt::format("{}", fmt::join(needs, "; "));
}

std::string cause(const Failure& failure, System& system, const BeamState& beam) {
    const Problem& p = system.problem();
    switch (failure.why) {
        case Stop::steps_spent:
            return fmt::format("the budget of {} steps (solver.max_steps) is spent, the last one {:.2g} s long; {}",
                               p.solver.max_steps, failure.last_step, step_size_limits(p, system, beam, true));
        case Stop::too_slow:
            if (large_deflection(p, beam)) return deflection_message(p, beam);
            return fmt::format(
                "at the current step size of {:.2g} s the run needs {:.2g} steps, far more than its budget of {} "
                "(solver.max_steps); {}",
                failure.last_step, failure.projected_steps, p.solver.max_steps,
                step_size_limits(p, system, beam, false));
        case Stop::passed_cam:
            return passed_cam_message(p, beam);
        case Stop::locked:
            return locked_message(p, beam);
        case Stop::inertia_lost:
            return large_deflection(p, beam) ? deflection_message(p, beam) : inertia_message(p);
        case Stop::stuck:
            return large_deflection(p, beam) ? deflection_message(p, beam) : stuck_message(p);
        case Stop::refused:
            return failure.message;
        case Stop::method:
            break;
    }
    const bool coupled = resolved_basis(p) == Basis::cantilever && !is_prescribed(p.hub.drive);
    if (coupled && beam.theta_dot > kRunawayRotation * first_clamped_frequency(p.beam)) return inertia_message(p);
    if (large_deflection(p, beam)) return deflection_message(p, beam);
    if (std::string divergence = divergence_message(p, beam); !divergence.empty()) return divergence;
    const char* unbounded =
        p.beam.model == ModelKind::paper
            ? " (the paper's equation (4) has no energy that would bound its motion: use \"model\": "
              "\"first-order\", which has)"
            : "";
    return fmt::format("{}{}; {}", failure.message, unbounded, step_size_limits(p, system, beam, false));
}

}  // namespace

std::string explain(const Failure& failure, System& system, const double* y) {
    std::string text = cause(failure, system, beam_state(failure.t, system, y));
    // The message of the integrator follows, unless the cause begins with it.
    const bool by_integrator = failure.why == Stop::method || failure.why == Stop::inertia_lost;
    if (by_integrator && !text.starts_with(failure.message)) text += fmt::format(" ({})", failure.message);
    return fmt::format("at t = {:.9g} s: {}", failure.t, text);
}

}  // namespace beamcam::sim
