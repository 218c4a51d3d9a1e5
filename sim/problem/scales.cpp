#include "sim/problem/scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/problem/derived.hpp"

namespace beamcam::sim {
namespace {

struct Range {
    double low, high;
};
// Squares, cubes and products of a few numbers in these ranges neither overflow nor vanish.
constexpr Range kInertias{1e-60, 1e60}, kUsual{1e-30, 1e30};
constexpr double kLight = 299792458;  // [m/s]
// Positions along the beam are sums with the hub's radius, the gap is a difference of distances: beyond these shares
// of the length rounding leaves less than five digits of them.
constexpr double kMostHubRadius = 1e6, kMostCamSize = 1e9;

struct Part {
    const char* path;
    double value;
};

class Scales {
  public:
    // Refuses `value` where it is out of range, at the part that is most extreme; the first such finding only, of which
    // the others follow.
    void within(const Range& range, const char* what, double value, const char* unit,
                std::initializer_list<Part> parts) {
        if (!list.empty() || (value >= range.low && value <= range.high)) return;
        const Part* worst = parts.begin();
        for (const Part& part : parts)
            if (decades(part.value) > decades(worst->value)) worst = &part;
        list.push_back(
            {worst->path,
             fmt::format("{:g} makes {} {} than {:g} {}, which the equations cannot be computed with", worst->value,
                         what, value < 1 ? "smaller" : "larger", value < 1 ? range.low : range.high, unit),
             true});
    }
    void slower_than_light(const char* path, const char* what, double rate, double arm) {
        const double speed = std::fabs(rate) * arm;
        if (speed <= kLight) return;
        list.push_back({path,
                        fmt::format("{:g} rad/s would move {} at {:.3g} m/s, faster than light ({:.3g} m/s)", rate,
                                    what, speed, kLight),
                        true});
    }
    void resolved(const char* path, double size, double length, double most, const char* what) {
        if (std::fabs(size) <= most * length) return;
        list.push_back(
            {path,
             fmt::format("{:g} m is more than {:g} times the beam's length of {:g} m: {} would be lost in rounding",
                         size, most, length, what),
             true});
    }
    std::vector<Finding> list;

  private:
    static double decades(double value) { return value == 0 ? 0 : std::fabs(std::log10(std::fabs(value))); }
};

// Of the clamped beam: 3.516 √(EI/ρA)/L², by factors that cannot overflow together.
double first_frequency(const Beam& b) {
    return 3.5160152685 * std::sqrt(b.youngs_modulus) * std::sqrt(b.second_moment) /
           (std::sqrt(b.density) * std::sqrt(b.area)) / b.length / b.length;
}

double fastest(const Drive& drive) {
    if (const auto* d = std::get_if<ConstantSpeed>(&drive)) return d->speed;
    if (const auto* d = std::get_if<SpinUp>(&drive)) return d->speed;
    return 0;
}

void judge_beam(Scales& out, const Problem& p) {
    const Beam& b = p.beam;
    const double mass = b.density * b.area * b.length;
    out.within(kInertias, "the beam's mass", mass, "kg",
               {{"beam.length", b.length}, {"beam.area", b.area}, {"beam.density", b.density}});
    out.within(kInertias, "the beam's moment of inertia", mass * b.length * b.length / 3, "kg m^2",
               {{"beam.length", b.length}, {"beam.area", b.area}, {"beam.density", b.density}});
    if (b.model == ModelKind::rigid) return;
    out.within(kUsual, "the beam's first bending frequency", first_frequency(b), "rad/s",
               {{"beam.youngs_modulus", b.youngs_modulus},
                {"beam.length", b.length},
                {"beam.second_moment", b.second_moment},
                {"beam.area", b.area},
                {"beam.density", b.density}});
}

void judge_contact(Scales& out, const Problem& p) {
    if (!p.cam || p.contact.model != ContactModel::compliant) return;
    const double n = p.contact.exponent, k = contact_stiffness(p);
    const double mass = p.beam.density * p.beam.area * p.beam.length;
    const double depth = impact_depth(n, k, mass, 1);
    const char* path = p.contact.stiffness || !p.cam->youngs_modulus ? "contact.stiffness" : "cam.youngs_modulus";
    out.within(kUsual, "the depth of a touch at 1 m/s", depth, "m", {{path, p.contact.stiffness.value_or(k)}});
}

}  // namespace

std::vector<Finding> beyond_arithmetic(const Problem& p) {
    Scales out;
    judge_beam(out, p);
    judge_contact(out, p);
    if (!out.list.empty()) return std::move(out.list);
    const double length = p.beam.length, reach = std::fabs(p.hub.radius) + length;
    out.resolved("hub.radius", p.hub.radius, length, kMostHubRadius, "positions along the beam");
    out.slower_than_light("initial.angular_velocity", "the tip", p.initial.angular_velocity, reach);
    out.slower_than_light("hub.drive.speed", "the tip", fastest(p.hub.drive), reach);
    if (!p.cam) return std::move(out.list);
    out.resolved("cam.radius", p.cam->radius, length, kMostCamSize, "the gap");
    out.slower_than_light("cam.speed", "the rim", p.cam->speed, p.cam->radius + p.cam->eccentricity);
    return std::move(out.list);
}

}  // namespace beamcam::sim
