#include "sim/dynamics/validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <vector>

#include "sim/base/counted.hpp"
#include "sim/base/numerics.hpp"
#include "sim/beam/table_smoothing.hpp"
#include "sim/cam/cam_shape.hpp"
#include "sim/cam/check_profile.hpp"
#include "sim/cam/lever.hpp"
#include "sim/dynamics/initial.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/problem/keys.hpp"

namespace beamcam::sim {
namespace {

constexpr double kLeastFiniteRestitution = 0.01;  // for dissipation laws with D → ∞ as c → 0
constexpr double kSameExponent = 1e-3;            // of a contact exponent that is written with a few digits
constexpr double kFarRestitution = 0.2;           // of the pre-set restitution from that of impacts: worth a warning
// Squares, cubes and products of a few numbers between these neither overflow nor vanish.
constexpr double kSmallestInertia = 1e-60, kLargestInertia = 1e60;  // mass [kg], moment of inertia [kg m²]
constexpr double kSmallestScale = 1e-30, kLargestScale = 1e30;      // frequency [rad/s], penetration [m]
constexpr double kSpeedOfLight = 299792458;                         // [m/s]
constexpr double kShallowest = 1e-8;  // of the length: a touch that is not lost in the rounding of positions
// Positions along the beam are sums with the hub's radius, and the gap is a difference of distances: beyond these
// multiples of the beam's length, rounding leaves fewer than five digits of them.
constexpr double kMaxHubRadius = 1e6, kMaxCamSize = 1e9;

class Issues {
  public:
    void error(std::string path, std::string message) { list.push_back({std::move(path), std::move(message), true}); }
    void warning(std::string path, std::string message) {
        list.push_back({std::move(path), std::move(message), false});
    }
    bool has_errors() const { return std::ranges::any_of(list, &Issue::fatal); }
    std::vector<Issue> list;
};

void check_table(Issues& out, const char* t_path, const char* v_path, const std::vector<double>& t,
                 const std::vector<double>& v, std::size_t least) {
    if (t.size() < least)
        return out.error(t_path, fmt::format("needs at least {}, has {}",
                                             counted(static_cast<long long>(least), "point"), t.size()));
    if (t.size() != v.size())
        out.error(v_path, fmt::format("must have as many values as the times ({}), has {}", t.size(), v.size()));
    for (std::size_t i = 1; i < t.size(); ++i)
        if (!(t[i] > t[i - 1])) {
            out.error(t_path, fmt::format("times must increase: {:g} follows {:g}", t[i], t[i - 1]));
            break;
        }
}

// The second derivative of a table is that of its steps where the steps explain most of it.
void check_angle_table(Issues& out, const AngleTable& d) {
    const std::size_t before = out.list.size();
    check_table(out, "hub.drive.t", "hub.drive.theta", d.t, d.theta, 2);
    if (out.list.size() > before || d.smooth.value_or(0) > 0) return;
    const std::optional<double> step = table_step(d.theta);
    if (!d.smooth && !step)
        out.error("hub.drive.smooth",
                  "\"auto\" needs values that are multiples of a step, and these are not; give the root mean square of "
                  "their errors, such as \"0.01 deg\"");
    if (!d.smooth || !step) return;
    const Roughness rough = roughness(d.t, d.theta, *step);
    if (rough.is_dominated_by_steps())
        out.warning(
            "hub.drive.theta",
            fmt::format("the values are multiples of {:.4g} rad, and these steps make most of the table's second "
                        "derivative ({:.3g} of {:.3g} rad/s²): the hub would follow the steps; use \"smooth\": "
                        "\"auto\"",
                        *step, std::min(rough.by_steps, rough.found), rough.found));
}

void check_hub(Issues& out, const Problem& p) {
    if (p.beam.length > 0 && std::isfinite(p.hub.radius) && !(p.hub.radius > -p.beam.length))
        out.error("hub.radius", fmt::format("must be larger than minus the beam's length ({:g} m), is {:g} m",
                                            -p.beam.length, p.hub.radius));
    if (const auto* d = std::get_if<TorqueTable>(&p.hub.drive))
        check_table(out, "hub.drive.t", "hub.drive.torque", d->t, d->torque, 1);
    if (const auto* d = std::get_if<AngleTable>(&p.hub.drive)) check_angle_table(out, *d);
}

void check_section(Issues& out, const Section& section) {
    if (const auto* s = std::get_if<Tube>(&section); s && s->wall > 0 && !(s->wall <= 0.5 * s->diameter))
        out.error("beam.section.wall",
                  fmt::format("must be at most half the diameter of {:g} m, is {:g} m; a solid rod "
                              "is \"type\": \"circle\"",
                              s->diameter, s->wall));
    const auto* s = std::get_if<CustomSection>(&section);
    if (s && s->area > 0 && s->c_max > 0 && !(s->second_moment <= s->area * s->c_max * s->c_max))
        out.error("beam.section.second_moment",
                  fmt::format("must be at most area · c_max² = {:g} m^4, that of two thin flanges, is {:g} m^4",
                              s->area * s->c_max * s->c_max, s->second_moment));
}

void check_beam(Issues& out, const Problem& p) {
    const Beam& b = p.beam;
    if (b.section) check_section(out, *b.section);
    if (b.section && beam_depth(b) >= b.length)
        out.error("beam.section",
                  fmt::format("is {:g} m deep, but the beam {:g} m long; write \"1 mm\" for millimetres", beam_depth(b),
                              b.length));
    if (b.damping_ratio.size() > 1 && static_cast<int>(b.damping_ratio.size()) != b.modes)
        out.error("beam.damping_ratio", fmt::format("needs one number, or one for each of the {} modes; has {}",
                                                    b.modes, b.damping_ratio.size()));
    if (b.kelvin_voigt && std::any_of(b.damping_ratio.begin(), b.damping_ratio.end(), [](double z) { return z != 0; }))
        out.error("beam.kelvin_voigt", "cannot be given together with damping_ratio; remove one of them");
    if (std::ranges::any_of(b.damping_ratio, [](double ratio) { return ratio > 1; }))
        out.warning("beam.damping_ratio", "is above 1, the critical damping; write 0.05 if 5 % is meant");
    if (b.basis == Basis::hub_beam && is_prescribed(p.hub.drive))
        out.error("beam.basis",
                  "hub-beam shapes are those of a freely rotating hub; with a prescribed drive use \"cantilever\" or "
                  "\"auto\"");
    if (b.basis == Basis::hub_beam && b.model == ModelKind::paper)
        out.error("beam.basis",
                  "the paper's equation (4) is written in the hub's frame; use \"cantilever\" or \"auto\"");
}

void check_contact(Issues& out, const Problem& p) {
    const Contact& c = p.contact;
    if (const double n = is_line_contact(p) ? kLineExponent : kPointExponent;
        c.model == ContactModel::compliant && !c.stiffness && c.exponent && std::fabs(*c.exponent - n) > kSameExponent)
        out.error("contact.exponent",
                  fmt::format("\"stiffness\": \"hertz\" has the exponent {:.4g}, not {:g}; remove it, or give the "
                              "stiffness as a number",
                              n, *c.exponent));
    const auto finite = [](DampingLaw law) { return std::isfinite(damping_factor(law, 0)); };
    if (c.model == ContactModel::compliant && !finite(c.damping) && c.restitution < kLeastFiniteRestitution) {
        std::vector<const char*> others;
        for (const auto& law : names(DampingLaw{}))
            if (law.value != DampingLaw::none && finite(law.value)) others.push_back(law.name);
        out.error("contact.restitution",
                  fmt::format("the law {} has no finite damping at 0: give at least {:g} (is {:g}) or use one of {}",
                              name(c.damping), kLeastFiniteRestitution, c.restitution, fmt::join(others, ", ")));
    }
    if (c.model == ContactModel::compliant && c.damping != DampingLaw::none && p.cam && c.restitution >= 0 &&
        c.restitution <= 1) {
        const double effective = effective_restitution(c.damping, c.restitution),
                     kept = std::max(c.restitution, kLeastFiniteRestitution);
        if (std::fabs(effective - c.restitution) > kFarRestitution)
            out.warning("contact.restitution",
                        fmt::format("the law {} gives impacts the restitution {:.2g} for {:g}; \"damping\": "
                                    "\"zhang-sharf\" gives {:g}{}",
                                    name(c.damping), effective, c.restitution, kept,
                                    kept > c.restitution ? fmt::format(" for \"restitution\": {:g}", kept) : ""));
    }
    if (const auto* f = std::get_if<StickSlipFriction>(&c.friction))
        if (f->static_coefficient && *f->static_coefficient >= 0 && !(*f->static_coefficient >= f->coefficient))
            out.error(
                "contact.friction.static_coefficient",
                fmt::format("must be at least the coefficient {:g}, is {:g}", f->coefficient, *f->static_coefficient));
}

void check_cam(Issues& out, const Problem& p) {
    const Cam& cam = *p.cam;
    if (cam.profile) {
        if (!out.has_errors()) std::ranges::move(check_profile(p), std::back_inserter(out.list));
        return;
    }
    if (cam.radius > 0 && !(cam.eccentricity < cam.radius))
        out.error(
            "cam.eccentricity",
            fmt::format("must be smaller than the cam's radius {:g} m, is {:g} m: the axis would lie outside the disc",
                        cam.radius, cam.eccentricity));
}

// True if the motion continues a contact; the gap is then that of the contact.
bool check_continued_contact(Issues& out, const Problem& p, double gap) {
    const std::optional<InitialContact>& contact = p.initial.contact;
    if (!contact || !contact->touching) return false;
    const double farthest = kNegligible * std::max(1.0, p.beam.length);
    if (gap > farthest || (gap < -farthest && p.contact.model == ContactModel::restitution))
        out.error("initial.contact", fmt::format("beam and cam do not touch at the start: the gap is {:.3g} m; remove "
                                                 "\"contact\", or give the state that belongs to it",
                                                 gap));
    return true;
}

ContactState contact_at_start(const Problem& p) {
    System system(p);
    return system.contact(0, initial_state(system).y.data());
}

// Most cams stay away from the tip by far, and need no search.
void warn_of_tip(Issues& out, const Problem& p, const CamShape& shape) {
    const double away = norm(p.cam->centre), tip = p.hub.radius + p.beam.length;
    if (away + shape.largest_slope() <= tip) return;
    const double farthest = Lever(p).farthest_foot();
    if (farthest > tip)
        out.warning(
            "cam.centre",
            fmt::format("a straight lever touches the cam up to {:.4g} m from the axis of the hub, but the beam "
                        "ends at {:.4g} m: it rests on the cam with its tip, and theta_follow, lift_error and "
                        "jump speeds are those of a longer lever; move the cam nearer",
                        farthest, tip));
}

void check_geometry(Issues& out, const Problem& p, const CamShape& shape) {
    const Cam& cam = *p.cam;
    const double d = contact_offset(p), away = norm(cam.centre), a = p.hub.radius;
    const double nearest_axis = away - shape.largest_reach();
    if (nearest_axis <= 0) {
        out.error("cam.centre",
                  fmt::format("the cam passes over the hub's axis: its own axis is {:g} m away, its outline "
                              "reaches {:g} m from there; move it away{}",
                              away, shape.largest_reach(), hint_of_unit(p)));
        return;
    }
    if (a > nearest_axis) {
        out.error("hub.radius",
                  fmt::format(
                      "the hub reaches {:g} m from its axis, but the cam comes as near as {:g} m; make the hub smaller "
                      "or move the cam away",
                      a, nearest_axis));
        return;
    }
    const double reach = a + p.beam.length + d;
    if (nearest_axis > reach) {
        out.warning(
            "cam.centre",
            fmt::format("the beam reaches {:g} m from the axis, the cam comes no nearer than {:g} m: they never touch",
                        reach, nearest_axis));
        return;
    }
    warn_of_tip(out, p, shape);
    const bool rigid = p.beam.model == ModelKind::rigid || p.beam.modes == 0;
    if (rigid && is_prescribed(p.hub.drive) && p.contact.model == ContactModel::restitution) {
        out.error("contact.model",
                  "a rigid beam at a prescribed angle cannot respond to an impulse; use \"compliant\" contact, a "
                  "flexible beam, or a torque instead of the angle");
        return;
    }
    if (p.initial.shape == InitialShape::resting) return;
    try {
        const ContactState start = contact_at_start(p);
        const double gap = start.gap + (p.initial.contact ? p.initial.contact->gap_offset : 0);
        if (check_continued_contact(out, p, gap)) return;
        if (gap < -kLongRounding * std::max(1.0, p.beam.length))
            out.error(
                std::holds_alternative<AngleTable>(p.hub.drive) ? "hub.drive.theta" : "initial.angle",
                fmt::format("beam and cam overlap by {:.3g} m at the start (at {:.3g} m along the beam); raise the "
                            "angle, {}",
                            -gap, start.x,
                            is_prescribed(p.hub.drive) ? "or change cam.phase"
                                                       : "change cam.phase, or use \"shape\": \"resting\""));
    } catch (const StepFailure& failure) {
        out.error("initial.shape", failure.what());
    }
}

void check_given_contact(Issues& out, const Problem& p) {
    if (!p.initial.contact) return;
    if (!p.cam) out.error("initial.contact", "the scene has no cam; give a cam, or remove it");
    if (p.initial.shape != InitialShape::straight)
        out.error("initial.contact",
                  fmt::format("the shape \"{}\" determines the contact; use \"straight\"", name(p.initial.shape)));
}

void check_given_shapes(Issues& out, const Problem& p) {
    const int shapes = p.beam.model == ModelKind::rigid ? 0 : p.beam.modes;
    for (const auto& [key, given] :
         {std::pair{"initial.q", &p.initial.q}, std::pair{"initial.q_dot", &p.initial.q_dot}}) {
        if (static_cast<int>(given->size()) > shapes)
            out.error(key, fmt::format("{} values, but the beam has {} shapes", given->size(), shapes));
        if (!given->empty() && p.initial.shape != InitialShape::straight)
            out.error(key, fmt::format("the shape \"{}\" determines the coordinates; use \"straight\"",
                                       name(p.initial.shape)));
    }
}

// ---- products of the numbers ----
// Each number may be valid, and yet their products (mass, inertia, frequency, penetration, speeds) overflow, vanish or
// lose their digits.

struct Factor {
    const char* path;
    double value;
};

// Reports a product outside [low, high] at its most extreme factor. Only the first: the others follow from it.
void check_product(Issues& out, double low, double high, const char* what, double value, const char* unit,
                   std::initializer_list<Factor> factors) {
    if (out.has_errors() || (value >= low && value <= high)) return;
    const auto decades = [](const Factor& f) { return f.value == 0 ? 0 : std::fabs(std::log10(std::fabs(f.value))); };
    const Factor& worst = *std::ranges::max_element(factors, {}, decades);
    out.error(worst.path,
              fmt::format("{:g} makes {} {} than {:g} {}, which the equations cannot be computed with", worst.value,
                          what, value < 1 ? "smaller" : "larger", value < 1 ? low : high, unit));
}

void check_speed(Issues& out, const char* path, const char* what, double rate, double arm) {
    const double speed = std::fabs(rate) * arm;
    if (speed <= kSpeedOfLight) return;
    out.error(path, fmt::format("{:g} rad/s would move {} at {:.3g} m/s, faster than light ({:.3g} m/s)", rate, what,
                                speed, kSpeedOfLight));
}

void check_size(Issues& out, const char* path, double size, double length, double most, const char* what) {
    if (std::fabs(size) <= most * length) return;
    out.error(path,
              fmt::format("{:g} m is more than {:g} times the beam's length of {:g} m: {} would be lost in rounding",
                          size, most, length, what));
}

double final_speed(const Drive& drive) {
    if (const auto* d = std::get_if<ConstantSpeed>(&drive)) return d->speed;
    if (const auto* d = std::get_if<SpinUp>(&drive)) return d->speed;
    return 0;
}

void check_beam_scales(Issues& out, const Problem& p) {
    const Beam& b = p.beam;
    const SectionProperties section = section_properties(b);
    const MaterialProperties material = material_properties(b);
    const Factor length{"beam.length", b.length}, area{b.section ? "beam.section" : "beam.area", section.area},
        second_moment{b.section ? "beam.section" : "beam.second_moment", section.second_moment},
        density{"beam.density", material.density};
    const double mass = b.line_density() * b.length;
    check_product(out, kSmallestInertia, kLargestInertia, "the beam's mass", mass, "kg", {length, area, density});
    check_product(out, kSmallestInertia, kLargestInertia, "the beam's moment of inertia",
                  mass * b.length * b.length / 3, "kg m^2", {length, area, density});
    if (b.model == ModelKind::rigid) return;
    check_product(out, kSmallestScale, kLargestScale, "the beam's first bending frequency", first_clamped_frequency(b),
                  "rad/s", {{"beam.youngs_modulus", material.youngs_modulus}, length, second_moment, area, density});
}

void check_contact_scales(Issues& out, const Problem& p) {
    if (!p.cam || p.contact.model != ContactModel::compliant) return;
    const double n = contact_exponent(p), k = contact_stiffness(p);
    const double mass = p.beam.line_density() * p.beam.length;
    const double depth = impact_depth(n, k, mass, 1);
    const char* path = p.contact.stiffness || !p.cam->youngs_modulus ? "contact.stiffness" : "cam.youngs_modulus";
    check_product(out, kSmallestScale, kLargestScale, "the depth of a touch at 1 m/s", depth, "m",
                  {{path, p.contact.stiffness.value_or(k)}});
    if (!out.has_errors() && depth < kShallowest * p.beam.length)
        out.error(path,
                  fmt::format("a touch at 1 m/s is {:.2g} m deep, less than {:g} of the beam's length, and lost in "
                              "rounding; \"model\": \"restitution\" describes contacts without depth",
                              depth, kShallowest));
}

void check_products(Issues& out, const Problem& p, const CamShape* shape) {
    check_beam_scales(out, p);
    check_contact_scales(out, p);
    if (out.has_errors()) return;
    const double length = p.beam.length, reach = std::fabs(p.hub.radius) + length;
    check_size(out, "hub.radius", p.hub.radius, length, kMaxHubRadius, "positions along the beam");
    check_speed(out, "initial.angular_velocity", "the tip", p.initial.angular_velocity, reach);
    check_speed(out, "hub.drive.speed", "the tip", final_speed(p.hub.drive), reach);
    if (!shape) return;
    check_size(out, p.cam->profile ? "cam.profile" : "cam.radius", shape->largest_reach(), length, kMaxCamSize,
               "the gap");
    check_speed(out, "cam.speed", "the rim", p.cam->speed, shape->largest_reach());
}

}  // namespace

std::vector<Issue> validate(const Problem& problem) {
    Issues out;
    check_ranges(problem, out.list);
    check_hub(out, problem);
    check_beam(out, problem);
    check_contact(out, problem);
    if (problem.cam) check_cam(out, problem);
    if (problem.initial.shape == InitialShape::resting) {
        if (!problem.cam)
            out.error("initial.shape",
                      "the beam cannot rest on the cam, because the scene has none; give a cam or "
                      "another shape");
        if (is_prescribed(problem.hub.drive))
            out.error("initial.shape",
                      "a beam whose angle is prescribed does not rest on the cam; use \"straight\" or \"static\"");
    }
    if (problem.gravity < 0) out.warning("gravity", "is negative: it acts upwards");
    check_given_shapes(out, problem);
    check_given_contact(out, problem);
    std::shared_ptr<const CamShape> shape;
    if (problem.cam && !out.has_errors()) shape = cam_shape(problem);
    if (!out.has_errors()) check_products(out, problem, shape.get());
    const bool sane = !out.has_errors();
    if (sane && shape) check_geometry(out, problem, *shape);
    if (sane && problem.beam.model == ModelKind::paper)
        out.warning("beam.model",
                    "the paper's equation (4) does not conserve energy (its stiffening uses L cos θ); compare with "
                    "\"first-order\"");
    return std::move(out.list);
}

void require_valid(const Problem& problem) {
    for (const Issue& finding : validate(problem))
        if (finding.fatal) throw std::invalid_argument(finding.path + ": " + finding.message);
}

}  // namespace beamcam::sim
