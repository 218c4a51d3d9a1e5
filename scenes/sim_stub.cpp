// Stand-in until the simulation lands: names of channels and the plain ranges of problem.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/simulate.hpp"

namespace beamcam::sim {
namespace {
struct Named {
    ChannelKind kind;
    const char* name;
    const char* unit;
};
constexpr Named kBefore[] = {{ChannelKind::t, "t", "s"},
                             {ChannelKind::theta, "theta", "rad"},
                             {ChannelKind::theta_dot, "theta_dot", "rad/s"},
                             {ChannelKind::tip_deflection, "tip_deflection", "m"},
                             {ChannelKind::tip_rate, "tip_rate", "m/s"},
                             {ChannelKind::contact_force, "contact_force", "N"},
                             {ChannelKind::friction_force, "friction_force", "N"},
                             {ChannelKind::gap, "gap", "m"},
                             {ChannelKind::contact_x, "contact_x", "m"},
                             {ChannelKind::contact_s, "contact_s", "m"},
                             {ChannelKind::cam_angle, "cam_angle", "rad"}};
constexpr Named kAfter[] = {{ChannelKind::energy_kinetic, "energy_kinetic", "J"},
                            {ChannelKind::energy_potential, "energy_potential", "J"},
                            {ChannelKind::energy_elastic, "energy_elastic", "J"},
                            {ChannelKind::energy_contact, "energy_contact", "J"},
                            {ChannelKind::loss_structural, "loss_structural", "J"},
                            {ChannelKind::loss_contact, "loss_contact", "J"},
                            {ChannelKind::loss_friction, "loss_friction", "J"},
                            {ChannelKind::work_cam, "work_cam", "J"},
                            {ChannelKind::work_drive, "work_drive", "J"},
                            {ChannelKind::energy_residual, "energy_residual", "J"},
                            {ChannelKind::separation, "separation", ""},
                            {ChannelKind::separation_paper, "separation_paper", ""}};
}  // namespace
std::string name(Channel channel) {
    if (channel.kind == ChannelKind::q) return fmt::format("q{}", channel.index);
    for (const auto& n : kBefore)
        if (n.kind == channel.kind) return n.name;
    for (const auto& n : kAfter)
        if (n.kind == channel.kind) return n.name;
    return "?";
}
std::optional<Channel> channel_named(std::string_view text) {
    for (const auto& n : kBefore)
        if (text == n.name) return Channel{n.kind, 0};
    for (const auto& n : kAfter)
        if (text == n.name) return Channel{n.kind, 0};
    int i = 0;
    if (text.starts_with("q") &&
        std::from_chars(text.data() + 1, text.data() + text.size(), i).ptr == text.data() + text.size() && i > 0)
        return Channel{ChannelKind::q, i};
    return std::nullopt;
}
std::vector<Channel> all_channels(const Problem& problem) {
    std::vector<Channel> out;
    for (const auto& n : kBefore) out.push_back({n.kind, 0});
    if (problem.beam.model != ModelKind::rigid)
        for (int i = 1; i <= problem.beam.modes; ++i) out.push_back({ChannelKind::q, i});
    for (const auto& n : kAfter) out.push_back({n.kind, 0});
    return out;
}
Basis resolved_basis(const Problem& p) { return p.beam.basis != Basis::automatic ? p.beam.basis : Basis::hub_beam; }
std::vector<Finding> validate(const Problem& p) {
    std::vector<Finding> out;
    auto need = [&](bool ok, const char* path, double value, const char* what) {
        if (!ok) out.push_back({path, fmt::format("{} = {:g} {}", path, value, what), true});
    };
    auto positive = [&](const char* path, double v) { need(v > 0, path, v, "must be positive"); };
    auto non_negative = [&](const char* path, double v) { need(v >= 0, path, v, "must not be negative"); };
    non_negative("hub.inertia", p.hub.inertia);
    positive("beam.length", p.beam.length);
    positive("beam.area", p.beam.area);
    positive("beam.second_moment", p.beam.second_moment);
    positive("beam.density", p.beam.density);
    positive("beam.youngs_modulus", p.beam.youngs_modulus);
    positive("beam.depth", p.beam.depth);
    need(p.beam.poisson_ratio > -1 && p.beam.poisson_ratio < 0.5, "beam.poisson_ratio", p.beam.poisson_ratio,
         "must lie between -1 and 0.5");
    for (double z : p.beam.damping_ratio) non_negative("beam.damping_ratio", z);
    if (p.beam.kelvin_voigt) non_negative("beam.kelvin_voigt", *p.beam.kelvin_voigt);
    if (p.cam) {
        positive("cam.radius", p.cam->radius);
        non_negative("cam.eccentricity", p.cam->eccentricity);
        need(p.cam->eccentricity < p.cam->radius, "cam.eccentricity", p.cam->eccentricity,
             "must be smaller than cam.radius");
        if (p.cam->youngs_modulus) positive("cam.youngs_modulus", *p.cam->youngs_modulus);
        need(p.cam->poisson_ratio > -1 && p.cam->poisson_ratio < 0.5, "cam.poisson_ratio", p.cam->poisson_ratio,
             "must lie between -1 and 0.5");
    }
    if (p.contact.stiffness) positive("contact.stiffness", *p.contact.stiffness);
    need(p.contact.exponent >= 1 && p.contact.exponent <= 2, "contact.exponent", p.contact.exponent,
         "must lie in 1 … 2");
    need(p.contact.restitution >= 0 && p.contact.restitution <= 1, "contact.restitution", p.contact.restitution,
         "must lie in 0 … 1");
    if (p.contact.offset) non_negative("contact.offset", *p.contact.offset);
    positive("contact.approach_floor.value", p.contact.approach_floor.value);
    non_negative("contact.collision_gap", p.contact.collision_gap);
    if (auto* c = std::get_if<CoulombFriction>(&p.contact.friction)) {
        non_negative("contact.friction.coefficient", c->coefficient);
        positive("contact.friction.slip_speed", c->slip_speed);
    }
    if (auto* c = std::get_if<StickSlipFriction>(&p.contact.friction)) {
        non_negative("contact.friction.coefficient", c->coefficient);
        if (c->stiffness) positive("contact.friction.stiffness", *c->stiffness);
        if (c->damping) non_negative("contact.friction.damping", *c->damping);
    }
    if (auto* d = std::get_if<SpinUp>(&p.hub.drive)) positive("hub.drive.duration", d->duration);
    if (auto* d = std::get_if<HarmonicTorque>(&p.hub.drive)) non_negative("hub.drive.frequency", d->frequency);
    need(p.solver.rtol >= 1e-13 && p.solver.rtol <= 1e-2, "solver.rtol", p.solver.rtol, "must lie in 1e-13 … 1e-2");
    positive("solver.atol", p.solver.atol);
    return out;
}
}  // namespace beamcam::sim
namespace beamcam::sim {
SolverError::SolverError(const std::string& what, double last_good_time, Result partial_result)
    : std::runtime_error(what), last_time(last_good_time), partial(std::move(partial_result)) {}
}  // namespace beamcam::sim
