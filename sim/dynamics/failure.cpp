#include "sim/dynamics/failure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/dynamics/constants.hpp"
#include "sim/problem/derived.hpp"

namespace beamcam::sim {
namespace {

// What the beam looks like, and how its contact point answers, at the last good instant.
struct Look {
    double slope = 0, deflection = 0;  // of the tip against the root's tangent [rad], [m]
    double spin = 0;                   // |θ̇| [rad/s]
    double approach = 0;               // of the touch [m/s]
    double mass = 0;                   // that the contact point feels [kg]
};

Look look(double t, System& system, const double* y) {
    Look out;
    system.place(t, y);
    BeamPoint root, tip;
    system.model().point(0, root);
    system.model().point(system.model().length(), tip);
    out.slope = std::fabs(std::atan2(cross(root.r1, tip.r1), dot(root.r1, tip.r1)));
    out.deflection = std::fabs(cross(root.r1, tip.r - root.r)) / norm(root.r1);
    out.spin = std::fabs(system.model().hub_rate());
    out.approach = system.phase().approach;
    if (!system.has_cam()) return out;
    try {
        const ContactState c = system.contact(t, y, true);
        const double answer = system.compliance(t, y, c).nn;
        if (answer > 0) out.mass = 1 / answer;
    } catch (const InertiaLost&) {
        // Then no mass is what the contact point feels; the failure has other words for that.
    }
    return out;
}

const char* modes_word(const Problem& p) { return p.beam.modes == 1 ? "mode" : "modes"; }

std::string shapes(const Problem& p) {
    return fmt::format("{} model with {} {} {}", name(p.beam.model), p.beam.modes, name(resolved_basis(p)),
                       modes_word(p));
}

// ρA g L⁴/(8EI): the sag of the clamped beam's tip.
double sag(const Problem& p) {
    return p.beam.line_density() * std::fabs(p.gravity) * std::pow(p.beam.length, 4) / (8 * p.beam.bending_stiffness());
}

// A modal model whose deflections have left the range where it holds.
bool bent(const Problem& p, const Look& beam) {
    return p.beam.model != ModelKind::rigid && p.beam.model != ModelKind::exact && beam.slope > kLargestSlope;
}

// The first bending frequency of the clamped beam [rad/s].
double bending_frequency(const Problem& p) {
    return 3.5160152685 / (p.beam.length * p.beam.length) *
           std::sqrt(p.beam.bending_stiffness() / p.beam.line_density());
}

// Whether the model's own equations let the deflection of a turning beam grow without end.
std::string tell_lost_stiffness(const Problem& p, const Look& beam) {
    const double bending = bending_frequency(p);
    if (!(beam.spin > kFastSpin * bending)) return "";
    const char* lacks = nullptr;
    if (p.beam.model == ModelKind::zeroth_order)
        lacks = "the zeroth-order model has no centrifugal stiffening, so that turning only takes stiffness away";
    if (p.beam.model == ModelKind::paper)
        lacks =
            "the paper's equation (4) has L cos θ for L in its centrifugal stiffening, so that turning takes stiffness "
            "away unless the beam is nearly level";
    if (!lacks) return "";
    return fmt::format(
        "the deflection grows without end: {}, at |θ̇| = {:.3g} rad/s more than bending has (first bending frequency "
        "{:.3g} rad/s); use \"model\": \"first-order\", which is the consistent equation, a stiffer beam, or a slower "
        "turn",
        lacks, beam.spin, bending);
}

std::string tell_bent(const Problem& p, const Look& beam) {
    if (std::string lost = tell_lost_stiffness(p, beam); !lost.empty()) return lost;
    std::string by;
    if (sag(p) > kLargestSag * p.beam.length)
        by = fmt::format(" (clamped, it would sag by {:.2g} m under gravity {:g} m/s^2)", sag(p), p.gravity);
    return fmt::format(
        "the beam has bent through {:.2g} rad, its tip by {:.2g} m of {:g} m{}; the {} holds for small deflections and "
        "breaks down here: use \"model\": \"exact\", a stiffer or lighter beam, or gentler loads (gravity, speeds, "
        "drive)",
        beam.slope, beam.deflection, p.beam.length, by, shapes(p));
}

std::string tell_inertia(const Problem& p) {
    const char* basis =
        resolved_basis(p) == Basis::cantilever && !is_prescribed(p.hub.drive) && p.beam.model != ModelKind::paper
            ? "\"basis\": \"hub-beam\", "
            : "";
    return fmt::format(
        "the {} lost its positive inertia: the hub ({:g} kg m^2) is too light for these shapes; use {}fewer modes, a "
        "larger hub.inertia, or \"model\": \"second-order\"",
        shapes(p), p.hub.inertia, basis);
}

std::string tell_passed(const Problem& p, const Look& beam) {
    const double n = p.contact.exponent, k = contact_stiffness(p), radius = p.cam->radius;
    const double depth = impact_depth(n, k, beam.mass, beam.approach);
    const std::string law = fmt::format("{:g} N/m^{:g}", k, n);
    if (depth < 0.5 * radius)
        return fmt::format(
            "the beam was pressed through the centre of the cam (radius {:g} m), which no impact does at contact "
            "stiffness {}: {} leaves no other way; change hub.drive, gravity or the cam's path, or raise "
            "contact.stiffness",
            radius, law, is_prescribed(p.hub.drive) ? "the prescribed angle" : "what presses the beam on");
    // A quarter of the radius deep: the force law and its geometry still mean something.
    const double stiffness = 0.5 * (n + 1) * beam.mass * beam.approach * beam.approach / std::pow(0.25 * radius, n + 1);
    return fmt::format(
        "the beam was pressed through the centre of the cam: the touch at {:.3g} m/s is {:.2g} m deep at contact "
        "stiffness {}, the cam's radius {:g} m; it takes contact.stiffness of {:.1g} or more, a cam.radius of {:.1g} m "
        "or more, or "
        "\"contact\": {{\"model\": \"restitution\"}}, which has no depth",
        beam.approach, depth, law, radius, stiffness, 4 * depth);
}

std::string tell_stuck(const Problem& p) {
    std::string what = "touch and release follow each other without time passing: ";
    if (p.contact.model == ContactModel::restitution)
        return what + "use a smaller contact.restitution, or \"contact\": {\"model\": \"compliant\"}";
    if (std::holds_alternative<StickSlipFriction>(p.contact.friction))
        return what +
               "the bristle can neither hold nor slide; use a softer contact.friction.stiffness or "
               "\"friction\": {\"type\": \"coulomb\"}";
    return what + fmt::format("use a smaller solver.rtol (is {:g}), or \"method\": \"rk8\"", p.solver.rtol);
}

// What keeps the steps short, and what would lengthen them.
std::string what_limits(const Problem& p, System& system, const Look& beam, bool spent) {
    std::vector<std::string> needs;
    const double fastest = system.highest_frequency();
    if (fastest > 0)
        needs.push_back(fmt::format("{} {} up to {:.3g} rad/s need steps near {:.1g} s (fewer: longer ones)",
                                    p.beam.modes, modes_word(p), fastest, 1 / fastest));
    if (p.cam && p.contact.model == ContactModel::compliant && beam.mass > 0) {
        // The depth at 1 m/s is the time to it in seconds.
        const double n = p.contact.exponent, k = contact_stiffness(p);
        const std::string with = fastest > 0 ? fmt::format(" with {} {}", p.beam.modes, modes_word(p)) : "";
        needs.push_back(fmt::format(
            "contact stiffness {:g} N/m^{:g}{} needs steps near {:.1g} s in a touch (softer, or \"contact\": "
            "{{\"model\": \"restitution\"}}: longer ones)",
            k, n, with, kSharpTouch * impact_depth(n, k, beam.mass, 1)));
    }
    if (const auto* coulomb = std::get_if<CoulombFriction>(&p.contact.friction);
        coulomb && p.contact.model == ContactModel::compliant && coulomb->slip_speed < 1e-4)
        needs.push_back(
            fmt::format("friction turns over within {:g} m/s of slip (larger contact.friction.slip_speed: "
                        "longer steps)",
                        coulomb->slip_speed));
    if (p.contact.model == ContactModel::compliant && beam.approach > 0 && beam.approach < kSlowApproach &&
        damping_factor(p.contact.damping, p.contact.restitution) > 0)
        needs.push_back(
            fmt::format("the dissipation of this touch is divided by its approach speed of {:.2g} m/s (larger "
                        "contact.approach_floor.value: longer steps)",
                        beam.approach));
    // The model's own decay, 2ζω or ηω².
    double ratio = 0.5 * p.beam.kelvin_voigt.value_or(0) * fastest;
    for (const double z : p.beam.damping_ratio) ratio = std::max(ratio, z);
    if (fastest > 0 && ratio > 1 && p.solver.method != Method::cvode_bdf)
        needs.push_back(
            fmt::format("damping {:.2g} times the critical one needs steps near {:.1g} s (\"method\": "
                        "\"cvode-bdf\" steps over it)",
                        ratio, 1 / (2 * ratio * fastest)));
    needs.push_back(fmt::format("rtol is {:g} (larger: longer steps)", p.solver.rtol));
    if (spent) needs.push_back("or raise solver.max_steps");
    return fmt::format("{}", fmt::join(needs, "; "));
}

std::string cause(const Failure& failure, System& system, const Look& beam) {
    const Problem& p = system.problem();
    switch (failure.why) {
        case Stop::steps_spent:
            return fmt::format("the budget of {} steps (solver.max_steps) is spent, the last one {:.2g} s long; {}",
                               p.solver.max_steps, failure.last_step, what_limits(p, system, beam, true));
        case Stop::too_slow:
            if (bent(p, beam)) return tell_bent(p, beam);
            return fmt::format(
                "at the pace of late, steps of {:.2g} s, the run would take {:.2g} steps, far more than its budget of "
                "{} "
                "(solver.max_steps); {}",
                failure.last_step, failure.whole, p.solver.max_steps, what_limits(p, system, beam, false));
        case Stop::passed_cam:
            return tell_passed(p, beam);
        case Stop::inertia_lost:
            return bent(p, beam) ? tell_bent(p, beam) : tell_inertia(p);
        case Stop::stuck:
            return bent(p, beam) ? tell_bent(p, beam) : tell_stuck(p);
        case Stop::method:
            break;
    }
    const bool coupled = resolved_basis(p) == Basis::cantilever && !is_prescribed(p.hub.drive);
    if (coupled && beam.spin > kRunawaySpin * bending_frequency(p)) return tell_inertia(p);
    if (bent(p, beam)) return tell_bent(p, beam);
    if (std::string lost = tell_lost_stiffness(p, beam); !lost.empty()) return lost;
    const char* unbounded =
        p.beam.model == ModelKind::paper
            ? " (the paper's equation (4) has no energy that would bound its motion: use \"model\": "
              "\"first-order\", which has)"
            : "";
    return fmt::format("{}{}; {}", failure.words, unbounded, what_limits(p, system, beam, false));
}

}  // namespace

std::string explain(const Failure& failure, System& system, const double* y) {
    std::string text = cause(failure, system, look(failure.t, system, y));
    // What the integrator itself said stays visible behind a cause in other terms.
    const bool own_words = failure.why == Stop::method || failure.why == Stop::inertia_lost;
    if (own_words && !text.starts_with(failure.words)) text += fmt::format(" ({})", failure.words);
    return fmt::format("at t = {:.9g} s: {}", failure.t, text);
}

}  // namespace beamcam::sim
