// What a problem may not be, and what it should not be: every finding at once.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/initial.hpp"
#include "sim/problem.hpp"
#include "sim/scales.hpp"
#include "sim/system.hpp"

namespace beamcam::sim {
namespace {

// No number of a mechanism is larger, in SI; squares and products of a few such numbers stay far from overflow.
constexpr double kLargest = 1e30;

class Findings {
  public:
    void refuse(std::string path, std::string message) { list.push_back({std::move(path), std::move(message), true}); }
    void warn(std::string path, std::string message) { list.push_back({std::move(path), std::move(message), false}); }
    void positive(const char* path, double value, const char* unit) {
        if (!(value > 0) || !std::isfinite(value))
            refuse(path, fmt::format("must be a positive number{}{}, is {:g}", *unit ? " of " : "", unit, value));
        else
            sane(path, value);
    }
    void not_negative(const char* path, double value) {
        if (!(value >= 0) || !std::isfinite(value))
            refuse(path, fmt::format("must not be negative, is {:g}", value));
        else
            sane(path, value);
    }
    void finite(const char* path, double value) {
        if (!std::isfinite(value))
            refuse(path, fmt::format("must be a finite number, is {:g}", value));
        else
            sane(path, value);
    }
    std::vector<Finding> list;

  private:
    void sane(const char* path, double value) {
        if (!(std::fabs(value) <= kLargest))
            refuse(path, fmt::format("must lie within ±{:g}, is {:g}: nothing is computed with larger numbers",
                                     kLargest, value));
    }
};

void check_table(Findings& out, const char* t_path, const char* v_path, const std::vector<double>& t,
                 const std::vector<double>& v, std::size_t least) {
    if (t.size() < least)
        out.refuse(t_path, fmt::format("needs at least {} point{}, has {}", least, least == 1 ? "" : "s", t.size()));
    if (t.size() != v.size())
        out.refuse(v_path, fmt::format("must have as many values as the times ({}), has {}", t.size(), v.size()));
    for (std::size_t i = 1; i < t.size(); ++i)
        if (!(t[i] > t[i - 1])) {
            out.refuse(t_path, fmt::format("times must increase: {:g} follows {:g}", t[i], t[i - 1]));
            break;
        }
    const auto sane = [](double x) { return std::fabs(x) <= kLargest; };
    if (!std::all_of(t.begin(), t.end(), sane))
        out.refuse(t_path, fmt::format("times must be finite, and within ±{:g}", kLargest));
    if (!std::all_of(v.begin(), v.end(), sane))
        out.refuse(v_path, fmt::format("values must be finite, and within ±{:g}", kLargest));
}

void check_hub(Findings& out, const Problem& p) {
    out.finite("hub.radius", p.hub.radius);
    if (p.beam.length > 0 && std::isfinite(p.hub.radius) && !(p.hub.radius > -p.beam.length))
        out.refuse("hub.radius", fmt::format("must be larger than minus the beam's length ({:g} m), is {:g} m",
                                             -p.beam.length, p.hub.radius));
    out.not_negative("hub.inertia", p.hub.inertia);
    if (const auto* d = std::get_if<ConstantTorque>(&p.hub.drive)) out.finite("hub.drive.value", d->value);
    if (const auto* d = std::get_if<HarmonicTorque>(&p.hub.drive)) {
        out.finite("hub.drive.amplitude", d->amplitude);
        out.not_negative("hub.drive.frequency", d->frequency);
        out.finite("hub.drive.phase", d->phase);
    }
    if (const auto* d = std::get_if<TorqueTable>(&p.hub.drive))
        check_table(out, "hub.drive.t", "hub.drive.torque", d->t, d->torque, 1);
    if (const auto* d = std::get_if<ConstantSpeed>(&p.hub.drive)) out.finite("hub.drive.speed", d->speed);
    if (const auto* d = std::get_if<SpinUp>(&p.hub.drive)) {
        out.finite("hub.drive.speed", d->speed);
        out.positive("hub.drive.duration", d->duration, "seconds");
    }
    if (const auto* d = std::get_if<AngleTable>(&p.hub.drive))
        check_table(out, "hub.drive.t", "hub.drive.theta", d->t, d->theta, 2);
}

void check_beam(Findings& out, const Problem& p) {
    const Beam& b = p.beam;
    out.positive("beam.length", b.length, "metres");
    out.positive("beam.area", b.area, "m^2");
    out.positive("beam.second_moment", b.second_moment, "m^4");
    out.positive("beam.density", b.density, "kg/m^3");
    out.positive("beam.youngs_modulus", b.youngs_modulus, "Pa");
    out.positive("beam.depth", b.depth, "metres");
    if (!(b.poisson_ratio > -1 && b.poisson_ratio < 0.5))
        out.refuse("beam.poisson_ratio", fmt::format("must lie between -1 and 0.5, is {:g}", b.poisson_ratio));
    if (b.modes < 1 || b.modes > kMaxModes)
        out.refuse("beam.modes", fmt::format("must be 1 to {}, is {}", kMaxModes, b.modes));
    for (double z : b.damping_ratio)
        if (!(z >= 0 && z <= kLargest)) {
            out.not_negative("beam.damping_ratio", z);
            break;
        }
    if (b.damping_ratio.size() > 1 && static_cast<int>(b.damping_ratio.size()) != b.modes)
        out.refuse("beam.damping_ratio", fmt::format("needs one number, or one for each of the {} modes; has {}",
                                                     b.modes, b.damping_ratio.size()));
    if (b.kelvin_voigt) {
        out.not_negative("beam.kelvin_voigt", *b.kelvin_voigt);
        if (!b.damping_ratio.empty() &&
            std::any_of(b.damping_ratio.begin(), b.damping_ratio.end(), [](double z) { return z != 0; }))
            out.refuse("beam.kelvin_voigt", "cannot be given together with damping_ratio; remove one of them");
    }
    if (b.basis == Basis::hub_beam && is_prescribed(p.hub.drive))
        out.refuse("beam.basis",
                   "hub-beam shapes are those of a freely turning hub; with a prescribed drive use \"cantilever\" or "
                   "\"auto\"");
    if (b.basis == Basis::hub_beam && b.model == ModelKind::paper)
        out.refuse("beam.basis",
                   "the paper's equation (4) is written in the hub's frame; use \"cantilever\" or \"auto\"");
}

void check_contact(Findings& out, const Problem& p) {
    const Contact& c = p.contact;
    if (c.stiffness) out.positive("contact.stiffness", *c.stiffness, "N/m^n");
    if (!(c.exponent >= 1 && c.exponent <= 2))
        out.refuse("contact.exponent", fmt::format("must lie between 1 and 2, is {:g}", c.exponent));
    if (!(c.restitution >= 0 && c.restitution <= 1))
        out.refuse("contact.restitution", fmt::format("must lie between 0 and 1, is {:g}", c.restitution));
    const bool singular = c.damping == DampingLaw::gonthier || c.damping == DampingLaw::flores ||
                          c.damping == DampingLaw::hu_guo || c.damping == DampingLaw::zhang_sharf;
    if (c.model == ContactModel::compliant && singular && c.restitution < 0.01)
        out.refuse(
            "contact.restitution",
            fmt::format("the law {} has no finite damping at 0: give at least 0.01 (is {:g}) or use hunt-crossley, "
                        "lankarani-nikravesh, herbert-mcwhannell or lee-wang",
                        name(c.damping), c.restitution));
    if (c.offset) out.not_negative("contact.offset", *c.offset);
    out.positive("contact.approach_floor.value", c.approach_floor.value, "m/s");
    out.not_negative("contact.collision_gap", c.collision_gap);
    if (const auto* f = std::get_if<CoulombFriction>(&c.friction)) {
        out.not_negative("contact.friction.coefficient", f->coefficient);
        out.positive("contact.friction.slip_speed", f->slip_speed, "m/s");
    }
    if (const auto* f = std::get_if<StickSlipFriction>(&c.friction)) {
        out.not_negative("contact.friction.coefficient", f->coefficient);
        if (f->static_coefficient && !(*f->static_coefficient >= f->coefficient))
            out.refuse(
                "contact.friction.static_coefficient",
                fmt::format("must be at least the coefficient {:g}, is {:g}", f->coefficient, *f->static_coefficient));
        else if (f->static_coefficient)
            out.not_negative("contact.friction.static_coefficient", *f->static_coefficient);
        if (f->stiffness) out.positive("contact.friction.stiffness", *f->stiffness, "N/m");
        if (f->damping) out.not_negative("contact.friction.damping", *f->damping);
    }
}

void check_cam(Findings& out, const Problem& p) {
    const Cam& cam = *p.cam;
    out.positive("cam.radius", cam.radius, "metres");
    out.finite("cam.centre", std::fabs(cam.centre.x) > std::fabs(cam.centre.y) ? cam.centre.x : cam.centre.y);
    out.finite("cam.phase", cam.phase);
    out.finite("cam.speed", cam.speed);
    if (!(cam.eccentricity >= 0))
        out.refuse("cam.eccentricity",
                   fmt::format("must not be negative, is {:g} m; turn the phase by 180 deg instead", cam.eccentricity));
    else if (cam.radius > 0 && !(cam.eccentricity < cam.radius))
        out.refuse(
            "cam.eccentricity",
            fmt::format("must be smaller than the cam's radius {:g} m, is {:g} m: the axis would lie outside the disc",
                        cam.radius, cam.eccentricity));
    if (cam.youngs_modulus) out.positive("cam.youngs_modulus", *cam.youngs_modulus, "Pa");
    if (!(cam.poisson_ratio > -1 && cam.poisson_ratio < 0.5))
        out.refuse("cam.poisson_ratio", fmt::format("must lie between -1 and 0.5, is {:g}", cam.poisson_ratio));
}

// Where cam and beam are to each other; every number is known to be sane.
struct StartGap {
    double gap, x;  // [m]
};
// Of a straight beam: the distance of a segment and a disc.
StartGap straight_gap(const Problem& p) {
    const Cam& cam = *p.cam;
    double angle = p.initial.angle;
    if (is_prescribed(p.hub.drive)) angle = DriveLaw(p.hub.drive, angle).motion(0).angle;
    const Vec2 along = unit(angle), disc = cam.centre + cam.eccentricity * unit(cam.phase);
    const double x = std::clamp(dot(disc, along) - p.hub.radius, 0.0, p.beam.length);
    return {norm((p.hub.radius + x) * along - disc) - cam.radius - contact_offset(p), x};
}
StartGap gap_at_start(const Problem& p) {
    System system(p);
    const InitialState start = initial_state(system);
    const ContactState c = system.contact(0, start.y.data(), true);
    return {c.gap, c.x};
}

void check_geometry(Findings& out, const Problem& p) {
    const Cam& cam = *p.cam;
    const double d = contact_offset(p), away = norm(cam.centre), a = p.hub.radius;
    const double nearest_axis = away - cam.eccentricity - cam.radius;
    if (nearest_axis <= 0) {
        out.refuse("cam.centre", fmt::format("the cam passes over the hub's axis: its centre is {:g} m away, "
                                             "eccentricity and radius make {:g} m; move it away",
                                             away, cam.eccentricity + cam.radius));
        return;
    }
    if (a > nearest_axis) {
        out.refuse(
            "hub.radius",
            fmt::format(
                "the hub reaches {:g} m from its axis, into the circle that the cam sweeps, which comes as near as "
                "{:g} m; make it smaller or move the cam away",
                a, nearest_axis));
        return;
    }
    const double reach = a + p.beam.length + d;
    if (nearest_axis > reach) {
        out.warn(
            "cam.centre",
            fmt::format("the beam reaches {:g} m from the axis, the cam comes no nearer than {:g} m: they never touch",
                        reach, nearest_axis));
        return;
    }
    const bool rigid = p.beam.model == ModelKind::rigid || p.beam.modes == 0;
    if (rigid && is_prescribed(p.hub.drive) && p.contact.model == ContactModel::restitution) {
        out.refuse("contact.model",
                   "nothing gives way to an impulse when a rigid beam meets the cam at a prescribed angle; use "
                   "\"compliant\" contact, a flexible beam, or a torque instead of the angle");
        return;
    }
    if (p.initial.shape == InitialShape::resting) return;
    try {
        const auto [gap, x] = p.initial.shape == InitialShape::straight ? straight_gap(p) : gap_at_start(p);
        if (gap < -1e-12 * std::max(1.0, p.beam.length))
            out.refuse("initial.angle", fmt::format("beam and cam overlap by {:.3g} m at the start (at {:.3g} m along "
                                                    "the beam); raise the angle, turn cam.phase, "
                                                    "or use \"shape\": \"resting\"",
                                                    -gap, x));
    } catch (const StepFailure& failure) {
        out.refuse("initial.shape", failure.what());
    }
}

}  // namespace

std::vector<Finding> validate(const Problem& problem) {
    Findings out;
    check_hub(out, problem);
    check_beam(out, problem);
    check_contact(out, problem);
    if (problem.cam) check_cam(out, problem);
    out.finite("gravity", problem.gravity);
    out.finite("initial.angle", problem.initial.angle);
    out.finite("initial.angular_velocity", problem.initial.angular_velocity);
    if (!(problem.solver.rtol >= 1e-13 && problem.solver.rtol <= 1e-2))
        out.refuse("solver.rtol", fmt::format("must lie between 1e-13 and 1e-2, is {:g}", problem.solver.rtol));
    // Far below rounding of anything that moves; a tolerance of zero by another name.
    if (!(problem.solver.atol >= 1e-40 && problem.solver.atol <= 1e10))
        out.refuse("solver.atol", fmt::format("must lie between 1e-40 and 1e10, is {:g}", problem.solver.atol));
    if (problem.solver.max_steps < 1)
        out.refuse("solver.max_steps", fmt::format("must be at least 1, is {}", problem.solver.max_steps));
    if (problem.initial.shape == InitialShape::resting) {
        if (!problem.cam)
            out.refuse("initial.shape", "a beam cannot rest on a cam that is not there; give a cam or another shape");
        if (is_prescribed(problem.hub.drive))
            out.refuse("initial.shape",
                       "a beam whose angle is prescribed does not rest on the cam; use \"straight\" or \"static\"");
    }
    bool sane = out.list.empty();
    if (sane) {
        out.list = beyond_arithmetic(problem);
        sane = out.list.empty();
    }
    if (sane && problem.cam) check_geometry(out, problem);
    if (sane && problem.beam.model == ModelKind::paper)
        out.warn("beam.model",
                 "the paper's equation (4) does not conserve energy (its stiffening uses L cos θ); compare with "
                 "\"first-order\"");
    return std::move(out.list);
}

}  // namespace beamcam::sim
