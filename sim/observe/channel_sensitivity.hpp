// How each channel depends on the modes within a part of a step: bounds of |∂c/∂q|, |∂c/∂q̇| and |∂c/∂q̈|, which turn the
// bounds of each mode (ModeVibrations) into vibrations of the channel. MODEL.md §12, (S59).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/observe/channels.hpp"
#include "sim/observe/constants.hpp"
#include "sim/observe/part_bounds.hpp"

namespace beamcam::sim {

// To eight modes; what is absent is zero. `mixed`: contribution of products of modes, `mixed_rate` of those with rates;
// `shift`: frequency of the factor of q [rad/s].
struct Sensitivity {
    std::optional<Lanes> q{}, rate{}, acceleration{}, mixed{}, mixed_rate{}, shift{};
};

class ChannelSensitivity {
  public:
    // Basis and part must outlive it.
    ChannelSensitivity(System& system, const ModeBasis& basis, const PartBounds& part)
        : system_(system), basis_(basis), part_(part), gravity_(std::fabs(system.problem().gravity)) {
        if (!system.has_cam()) return;
        cam_radius_ = system.problem().cam->radius;
        friction_ = std::max(system.friction().kinetic, system.friction().limit);
    }

    // Calls visit(sensitivity, vibrations) with all modes, eight by eight: a separate loop for each channel.
    template <class Visit>
    void each_group(Channel channel, Visit&& visit) const;

    double cam_radius() const { return cam_radius_; }
    double gravity() const { return gravity_; }
    double friction() const { return friction_; }  // largest coefficient

  private:
    using Group = ModeBasis::Group;
    using Vibrations = ModeVibrations;
    double theta_dot() const { return part_.part.motion->theta_dot; }
    // Of the inertia: a mode vibrates about the shape of the others.
    Lanes turning(const Group& of, const Vibrations& m) const {
        return of.inertia * m.amplitude * (theta_dot() * part_.inertia_root);
    }
    // Of the place of contact: a slope rotates the normal, which passes the disc's centre at the distance `away`.
    Lanes foot(const Group& of) const {
        if (!part_.foot_moves()) return {};
        return kBentContactShift * (of.slope * part_.away + of.shape * part_.inclination);
    }
    // Displacement of the beam at the contact: from that of the root on it grows by its slopes.
    Lanes displacement(const Group& of) const {
        return smaller(of.shape, of.h * (basis_.reach - basis_.length) + of.slope * part_.farthest);
    }
    // Where tangents turn by δ, sin δ is δ but for ½δ²δ_i of each mode; against the hub they turn by twice the
    // inclination at most. The deflection of the tip changes by that over the length.
    Lanes far_tip(const Group& of) const {
        return basis_.bends_far ? of.slope * (2 * basis_.length * part_.inclination * part_.inclination) : Lanes{};
    }
    // The same of velocities across the beam; and those along it, L|v′v̇′|, squared and times those by the rotation.
    Lanes far_kinetic(const Group& of, const Vibrations& m) const {
        if (!basis_.bends_far) return {};
        const double speed = theta_dot() * basis_.reach + part_.part.motion->deflection_speed,
                     along = basis_.length * part_.inclination * part_.part.motion->slope_speed;
        return of.slope * m.rate *
               (basis_.mass * basis_.length * part_.inclination *
                (2 * speed * part_.inclination + 0.5 * along + theta_dot() * part_.deflection));
    }
    template <class Visit>
    void visit_coordinate(std::size_t j, const Visit& visit) const;
    template <class Visit>
    void visit_tip(ChannelKind kind, const Visit& visit) const;
    template <class Visit>
    void visit_contact(ChannelKind kind, const Visit& visit) const;
    template <class Visit>
    void visit_energy(ChannelKind kind, const Visit& visit) const;
    template <class Visit, class Each>
    void visit_all(const Visit& visit, const Each& sensitivity) const {
        for (std::size_t g = 0; g < basis_.groups.size(); ++g)
            visit(sensitivity(basis_.groups[g], part_.groups[g]), part_.groups[g]);
    }

    System& system_;
    const ModeBasis& basis_;
    const PartBounds& part_;
    const double gravity_;
    double friction_ = 0, cam_radius_ = 0;
};

template <class Visit>
void ChannelSensitivity::each_group(Channel channel, Visit&& visit) const {
    switch (channel.kind) {
        case ChannelKind::q:
            return visit_coordinate(static_cast<std::size_t>(channel.index) - 1, visit);
        case ChannelKind::theta:
            return visit_all(visit, [](const Group& of, const Vibrations&) { return Sensitivity{.q = of.h}; });
        case ChannelKind::theta_dot:  // Θ̇ = p/(J + qᵀBq), or that of the drive
            return visit_all(visit, [&](const Group& of, const Vibrations& m) {
                const double share = system_.drive().prescribed() ? 0 : 2 / basis_.J;
                return Sensitivity{.rate = of.h, .mixed = share * turning(of, m)};
            });
        case ChannelKind::tip_deflection:
        case ChannelKind::tip_rate:
            return visit_tip(channel.kind, visit);
        case ChannelKind::separation:
        case ChannelKind::separation_paper: {  // (S41)
            const double pull = 1.5 * gravity_ / basis_.length;
            return visit_all(visit, [&](const Group& of, const Vibrations& m) {
                return Sensitivity{.acceleration = of.h * part_.arm,
                                   .mixed = (foot(of) + of.h * part_.arm) * pull * m.amplitude,
                                   .mixed_rate = foot(of) * part_.hub_acceleration * m.amplitude};
            });
        }
        case ChannelKind::gap:
        case ChannelKind::contact_x:
        case ChannelKind::contact_s:
        case ChannelKind::contact_force:
        case ChannelKind::friction_force:
        case ChannelKind::energy_contact:
            return visit_contact(channel.kind, visit);
        case ChannelKind::energy_kinetic:
        case ChannelKind::energy_potential:
        case ChannelKind::energy_elastic:
        case ChannelKind::work_drive:
            return visit_energy(channel.kind, visit);
        default:  // of no mode, largest at the end, a polynomial, or searched by samples
            return;
    }
}

template <class Visit>
void ChannelSensitivity::visit_coordinate(std::size_t j, const Visit& visit) const {
    for (std::size_t g = 0; g < basis_.groups.size(); ++g) {
        Sensitivity of{.q = Lanes{}};
        for (std::size_t i = g * kNodes; i < std::min(basis_.size(), (g + 1) * kNodes); ++i)
            (*of.q)[static_cast<int>(i % kNodes)] = std::fabs(basis_.share(j, i));
        visit(of, part_.groups[g]);
    }
}

// −(L + Δu) sin α + Δv cos α: what is not linear is of third order.
template <class Visit>
void ChannelSensitivity::visit_tip(ChannelKind kind, const Visit& visit) const {
    const double length = basis_.length, alpha = part_.alpha;
    const double third = length * alpha * alpha / 6 + 0.5 * length * part_.inclination * part_.inclination +
                         0.5 * part_.deflection * alpha;
    if (kind == ChannelKind::tip_deflection)
        return visit_all(visit, [&](const Group& of, const Vibrations& m) {
            return Sensitivity{.q = magnitude(of.tip), .mixed = (of.h * (3 * third) + far_tip(of)) * m.amplitude};
        });
    visit_all(visit, [&](const Group& of, const Vibrations& m) {
        return Sensitivity{.rate = magnitude(of.tip), .mixed_rate = (of.h * (9 * third) + far_tip(of)) * m.rate};
    });
}

template <class Visit>
void ChannelSensitivity::visit_contact(ChannelKind kind, const Visit& visit) const {
    const auto by_shape = [&](auto&& q) {
        visit_all(visit, [&](const Group& of, const Vibrations&) {
            return Sensitivity{.q = q(of), .shift = of.wave * part_.slide};
        });
    };
    switch (kind) {
        case ChannelKind::gap:
            return by_shape([&](const Group& of) { return displacement(of); });
        case ChannelKind::contact_x:
            return by_shape([&](const Group& of) { return foot(of); });
        case ChannelKind::contact_s:
            return by_shape(
                [&](const Group& of) { return cam_radius_ * of.slope + part_.rim_share * displacement(of); });
        case ChannelKind::energy_contact:
            return by_shape([&](const Group& of) { return part_.force * displacement(of); });
        default: {
            const double share = kind == ChannelKind::contact_force ? 1 : friction_,
                         per_depth = share * part_.force_per_depth, per_rate = share * part_.force_per_rate;
            return visit_all(visit, [&](const Group& of, const Vibrations&) {
                return Sensitivity{.q = per_depth * displacement(of) + (per_rate * part_.slide) * of.slope,
                                   .rate = per_rate * displacement(of),
                                   .shift = of.wave * part_.slide};
            });
        }
    }
}

template <class Visit>
void ChannelSensitivity::visit_energy(ChannelKind kind, const Visit& visit) const {
    const double fastest = theta_dot();
    switch (kind) {
        case ChannelKind::energy_kinetic:
            return visit_all(visit, [&](const Group& of, const Vibrations& m) {
                return Sensitivity{.rate = fastest * of.U,
                                   .mixed = fastest * turning(of, m),
                                   .mixed_rate = (0.25 * basis_.mass) * m.rate * m.rate + far_kinetic(of, m)};
            });
        case ChannelKind::energy_potential:
            return visit_all(visit, [&](const Group& of, const Vibrations& m) {
                return Sensitivity{
                    .q = gravity_ * of.W,
                    .mixed = gravity_ * (of.weight * part_.weight_root + basis_.mass * far_tip(of)) * m.amplitude,
                    .shift = Lanes{} + 2 * fastest};
            });
        case ChannelKind::energy_elastic:
            return visit_all(visit, [](const Group& of, const Vibrations& m) {
                return Sensitivity{.mixed = 0.25 * of.stiffness * m.amplitude * m.amplitude};
            });
        default:  // work_drive: where all is resolved, a polynomial
            if (part_.part.modes->resolved) return;
            if (!system_.drive().prescribed())  // (S55)
                return visit_all(
                    visit, [&](const Group& of, const Vibrations&) { return Sensitivity{.q = part_.torque * of.h}; });
            return visit_all(visit, [&](const Group& of, const Vibrations& m) {
                return Sensitivity{.q = of.U * part_.part.motion->theta_ddot,
                                   .rate = (2 * fastest) * of.U,
                                   .mixed_rate = (2 * fastest) * turning(of, m)};
            });
    }
}

}  // namespace beamcam::sim
