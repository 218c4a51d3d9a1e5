#include "sim/problem/number_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/problem/constants.hpp"

namespace beamcam::sim {
namespace {

struct Factor {
    const char* path;
    double value;
};

class RangeIssues {
  public:
    // Reports a product outside [low, high] at its most extreme factor. Only the first: the others follow from it.
    void within(double low, double high, const char* what, double value, const char* unit,
                std::initializer_list<Factor> factors) {
        if (!list.empty() || (value >= low && value <= high)) return;
        const Factor* worst = factors.begin();
        for (const Factor& factor : factors)
            if (decades(factor.value) > decades(worst->value)) worst = &factor;
        list.push_back({worst->path,
                        fmt::format("{:g} makes {} {} than {:g} {}, which the equations cannot be computed with",
                                    worst->value, what, value < 1 ? "smaller" : "larger", value < 1 ? low : high, unit),
                        true});
    }
    void slower_than_light(const char* path, const char* what, double rate, double arm) {
        const double speed = std::fabs(rate) * arm;
        if (speed <= kSpeedOfLight) return;
        list.push_back({path,
                        fmt::format("{:g} rad/s would move {} at {:.3g} m/s, faster than light ({:.3g} m/s)", rate,
                                    what, speed, kSpeedOfLight),
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
    std::vector<Issue> list;

  private:
    static double decades(double value) { return value == 0 ? 0 : std::fabs(std::log10(std::fabs(value))); }
};

double final_speed(const Drive& drive) {
    if (const auto* d = std::get_if<ConstantSpeed>(&drive)) return d->speed;
    if (const auto* d = std::get_if<SpinUp>(&drive)) return d->speed;
    return 0;
}

void check_beam_scales(RangeIssues& out, const Problem& p) {
    const Beam& b = p.beam;
    const double mass = b.density * b.area * b.length;
    out.within(kSmallestInertia, kLargestInertia, "the beam's mass", mass, "kg",
               {{"beam.length", b.length}, {"beam.area", b.area}, {"beam.density", b.density}});
    out.within(kSmallestInertia, kLargestInertia, "the beam's moment of inertia", mass * b.length * b.length / 3,
               "kg m^2", {{"beam.length", b.length}, {"beam.area", b.area}, {"beam.density", b.density}});
    if (b.model == ModelKind::rigid) return;
    out.within(kSmallestScale, kLargestScale, "the beam's first bending frequency", first_clamped_frequency(b), "rad/s",
               {{"beam.youngs_modulus", b.youngs_modulus},
                {"beam.length", b.length},
                {"beam.second_moment", b.second_moment},
                {"beam.area", b.area},
                {"beam.density", b.density}});
}

void check_contact_scales(RangeIssues& out, const Problem& p) {
    if (!p.cam || p.contact.model != ContactModel::compliant) return;
    const double n = p.contact.exponent, k = contact_stiffness(p);
    const double mass = p.beam.density * p.beam.area * p.beam.length;
    const double depth = impact_depth(n, k, mass, 1);
    const char* path = p.contact.stiffness || !p.cam->youngs_modulus ? "contact.stiffness" : "cam.youngs_modulus";
    out.within(kSmallestScale, kLargestScale, "the depth of a touch at 1 m/s", depth, "m",
               {{path, p.contact.stiffness.value_or(k)}});
}

}  // namespace

std::vector<Issue> number_range_issues(const Problem& p) {
    RangeIssues out;
    check_beam_scales(out, p);
    check_contact_scales(out, p);
    if (!out.list.empty()) return std::move(out.list);
    const double length = p.beam.length, reach = std::fabs(p.hub.radius) + length;
    out.resolved("hub.radius", p.hub.radius, length, kMaxHubRadius, "positions along the beam");
    out.slower_than_light("initial.angular_velocity", "the tip", p.initial.angular_velocity, reach);
    out.slower_than_light("hub.drive.speed", "the tip", final_speed(p.hub.drive), reach);
    if (!p.cam) return std::move(out.list);
    out.resolved("cam.radius", p.cam->radius, length, kMaxCamSize, "the gap");
    out.slower_than_light("cam.speed", "the rim", p.cam->speed, p.cam->radius + p.cam->eccentricity);
    return std::move(out.list);
}

}  // namespace beamcam::sim
