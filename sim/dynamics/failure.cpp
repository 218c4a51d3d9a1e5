#include "sim/dynamics/failure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "sim/base/counted.hpp"
#include "sim/cam/cam_shape.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {
namespace {

// Beyond these limits the assumption of small deflections is the most probable cause.
constexpr double kLargestSlope = 0.5;     // [rad] between the ends of the beam
constexpr double kFastRotation = 0.5;     // of the first bending frequency: rotation affects the stiffness
constexpr double kRunawayRotation = 1e3;  // of that frequency: possible only if the inertia vanished
constexpr double kSharpTouch = 0.1;       // of the time to maximum penetration: typical step in contact
constexpr double kUsableDepth = 0.25;     // of the cam's radius: largest penetration with a meaningful force

// The beam and its contact at the last good instant.
struct BeamState {
    double slope = 0, deflection = 0;  // of the tip against the root's tangent [rad], [m]
    double theta_dot = 0;              // |θ̇| [rad/s]
    double approach = 0;               // approach speed of the touch [m/s]
    double mass = 0;                   // effective mass at the contact point [kg]; 0: without a contact or inertia
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
        // inertia_message describes this failure.
    }
    return out;
}

bool large_deflection(const Problem& p, const BeamState& beam) {
    return p.beam.model != ModelKind::rigid && p.beam.model != ModelKind::exact && beam.slope > kLargestSlope;
}

// Fast rotation destabilizes the beam.
bool rotation_diverges(const Problem& p, const BeamState& beam) {
    return (p.beam.model == ModelKind::zeroth_order || p.beam.model == ModelKind::paper) &&
           beam.theta_dot > kFastRotation * first_clamped_frequency(p.beam);
}

std::string divergence_message(const Problem& p, const BeamState& beam) {
    return fmt::format(
        "the deflection grows without bound: the {} model has {}, and at |θ̇| = {:.3g} rad/s rotation takes more "
        "stiffness than bending has (first bending frequency {:.3g} rad/s); use \"model\": \"first-order\", a stiffer "
        "beam, or a slower rotation",
        name(p.beam.model),
        p.beam.model == ModelKind::paper ? "L cos θ for L in its centrifugal stiffening" : "no centrifugal stiffening",
        beam.theta_dot, first_clamped_frequency(p.beam));
}

std::string deflection_message(const Problem& p, const BeamState& beam) {
    if (rotation_diverges(p, beam)) return divergence_message(p, beam);
    return fmt::format(
        "the beam has bent through {:.2g} rad, its tip by {:.2g} m of {:g} m, and the {} model holds for small "
        "deflections; use \"model\": \"exact\", a stiffer or lighter beam, or gentler loads (gravity is {:g} m/s^2)",
        beam.slope, beam.deflection, p.beam.length, name(p.beam.model), p.gravity);
}

std::string inertia_message(const Problem& p) {
    return fmt::format(
        "the {} model with {} of the basis {} lost its positive inertia, because the hub ({:g} kg m^2) is too light "
        "for these "
        "shapes; use fewer modes, \"basis\": \"hub-beam\", a larger hub.inertia, or \"model\": \"second-order\"",
        name(p.beam.model), counted(p.beam.modes, "shape"), name(resolved_basis(p)), p.hub.inertia);
}

// A touch, whose penetration a stiffness would limit, or a load that no impact has.
std::string passed_cam_message(const Problem& p, const BeamState& beam) {
    const double n = contact_exponent(p), k = contact_stiffness(p), radius = cam_shape(p)->inner_radius();
    const double depth = impact_depth(n, k, beam.mass, beam.approach);
    if (depth < 0.5 * radius)
        return fmt::format(
            "the beam was pressed through the centre of the cam (radius {:g} m), which no impact does at contact "
            "stiffness {:g} N/m^{:g}; change hub.drive, the load on the beam or the cam's path",
            radius, k, n);
    const double stiffness =
        0.5 * (n + 1) * beam.mass * beam.approach * beam.approach / std::pow(kUsableDepth * radius, n + 1);
    return fmt::format(
        "the beam was pressed through the centre of the cam: the touch at {:.3g} m/s is {:.2g} m deep at contact "
        "stiffness {:g} N/m^{:g}, the cam's radius {:g} m; use contact.stiffness of {:.1g} or more, a cam.radius of "
        "{:.1g} m or more, or \"contact\": {{\"model\": \"restitution\"}}",
        beam.approach, depth, k, n, radius, stiffness, depth / kUsableDepth);
}

std::string locked_message(const Problem& p, const BeamState& beam) {
    return fmt::format(
        "friction locks the beam to the cam: at x = {:.3g} m, with the face {:.3g} m off the centre line, a "
        "coefficient above {:.2g} presses the beam into the cam by more than the contact force pushes it off; use a "
        "smaller contact.friction.coefficient or contact.offset, or another direction of cam.speed",
        beam.x, contact_offset(p), beam.lock);
}

// What limits the length of the steps.
std::string step_size_limits(const Problem& p, System& system, const BeamState& beam) {
    std::vector<std::string> limits;
    const double fastest = system.highest_frequency(), damping = system.damping_ratio();
    if (fastest > 0)
        limits.push_back(fmt::format("{} up to {:.3g} rad/s need steps near {:.1g} s", counted(p.beam.modes, "mode"),
                                     fastest, 1 / fastest));
    if (fastest > 0 && damping > 1)
        limits.push_back(
            fmt::format("damping {:.2g} times the critical one needs steps near {:.1g} s, but with "
                        "\"method\": \"cvode-bdf\"",
                        damping, 1 / (2 * damping * fastest)));
    if (p.cam && p.contact.model == ContactModel::compliant && beam.mass > 0) {
        // The depth at 1 m/s is also the time to it in seconds.
        const double n = contact_exponent(p), k = contact_stiffness(p);
        limits.push_back(fmt::format("contact stiffness {:g} N/m^{:g} needs steps near {:.1g} s in a touch", k, n,
                                     kSharpTouch * impact_depth(n, k, beam.mass, 1)));
    }
    limits.push_back(fmt::format("rtol is {:g}", p.solver.rtol));
    return fmt::format("{}", fmt::join(limits, ", "));
}

std::string cause(const Failure& failure, System& system, const BeamState& beam) {
    const Problem& p = system.problem();
    switch (failure.why) {
        case Stop::steps_spent:
            return fmt::format(
                "the budget of {} steps (solver.max_steps) is spent, the last one {:.2g} s long: {}; a larger "
                "solver.max_steps allows more",
                p.solver.max_steps, failure.last_step, step_size_limits(p, system, beam));
        case Stop::too_slow:
            if (large_deflection(p, beam)) return deflection_message(p, beam);
            return fmt::format(
                "at the current step size of {:.2g} s the run needs {:.2g} steps, far more than its budget of {} "
                "(solver.max_steps): {}",
                failure.last_step, failure.projected_steps, p.solver.max_steps, step_size_limits(p, system, beam));
        case Stop::passed_cam:
            return passed_cam_message(p, beam);
        case Stop::locked:
            return locked_message(p, beam);
        case Stop::inertia_lost:
            return large_deflection(p, beam) ? deflection_message(p, beam) : inertia_message(p);
        case Stop::stuck:
            if (large_deflection(p, beam)) return deflection_message(p, beam);
            return std::string("touch and release follow each other without progress in time; use a smaller ") +
                   (p.contact.model == ContactModel::restitution
                        ? "contact.restitution or solver.rtol, or more modes"
                        : "solver.rtol, or a softer contact.friction.stiffness");
        case Stop::refused:
            return failure.message;
        case Stop::method:
            break;
    }
    const bool coupled = resolved_basis(p) == Basis::cantilever && !is_prescribed(p.hub.drive);
    if (coupled && beam.theta_dot > kRunawayRotation * first_clamped_frequency(p.beam)) return inertia_message(p);
    if (large_deflection(p, beam)) return deflection_message(p, beam);
    if (rotation_diverges(p, beam)) return divergence_message(p, beam);
    return fmt::format("{}: {}", failure.message, step_size_limits(p, system, beam));
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
