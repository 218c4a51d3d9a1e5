#include "sim/observe/part_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "sim/observe/constants.hpp"

namespace beamcam::sim {

PartBounds::PartBounds(System& system, const ModeBasis& basis)
    : groups(basis.groups.size()), system_(system), basis_(basis) {
    if (system.has_cam()) disc_speed = system.problem().cam->eccentricity * std::fabs(system.problem().cam->speed);
}

void PartBounds::set(const Part& of) {
    part = of;
    set_vibrations(*part.modes, part.elapsed, groups);
    sum_modes();
    const DriveLaw& drive = system_.drive();
    torque = drive.has_torque() ? std::max(std::fabs(drive.torque(part.from)), std::fabs(drive.torque(part.to))) : 0;
    if (!system_.has_cam()) return;
    place_contact();
    const MotionBounds& motion = *part.motion;
    foot_speed = slide = 0;
    if (foot_moves()) {
        foot_speed = kBentContactShift * (motion.theta_dot * (basis_.reach + away) + disc_speed);
        slide = foot_speed + kBentContactShift * (motion.slope_speed * away + motion.deflection_speed);
    }
    if (part.touch) bound_force();
}

void PartBounds::sum_modes() {
    Lanes shapes{}, slopes{}, turns{}, inertia{}, weight{}, accelerations{};
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const ModeBasis::Group& of = basis_.groups[g];
        const Lanes& amplitude = groups[g].amplitude;
        shapes += of.shape * amplitude;
        slopes += of.slope * amplitude;
        turns += of.h * amplitude;
        inertia += of.inertia * amplitude;
        weight += of.weight * amplitude;
        accelerations += of.h * groups[g].acceleration;
    }
    deflection = sum(shapes);
    inclination = sum(slopes);
    alpha = sum(turns);
    inertia_root = sum(inertia);
    weight_root = sum(weight);
    hub_acceleration = part.motion->theta_ddot + sum(accelerations);
}

// Distance of the disc's centre from the beam, and of the contact from the root. At a foot where the tangent is
// inclined by δ against the frame, x = foot − u + tan δ (across − v), 0 ≤ −u ≤ ½xs² + ½|a|α² and |tan δ| ≤ s/(1 − ½s²)
// by (S7), (S13) and (S24), with the largest inclination s.
void PartBounds::place_contact() {
    const MotionBounds& motion = *part.motion;
    const double angle = 0.5 * (motion.angle_low + motion.angle_high),
                 turn = 0.5 * (motion.angle_high - motion.angle_low) - motion.ripple;  // of the frame
    const Vec2 disc = system_.cam(part.from).disc, along = unit(angle);
    const double root = system_.problem().hub.radius, foot = dot(disc, along),
                 on_beam = std::clamp(foot, root, root + basis_.length), moved = disc_speed * part.length();
    const double distance = norm(disc - on_beam * along);
    away = distance + turn * basis_.reach + moved + deflection;
    bound_gap(distance, norm(disc - root * along), turn, moved);
    const double turned = turn * norm(disc) + moved, across = std::fabs(dot(disc, perp(along))) + turned;
    const double shortened = 1 - 0.5 * inclination * inclination;
    const bool steep = !(inclination < 1);
    const double shift =
        turned + inclination / shortened * (across + deflection) + 0.5 * std::fabs(root) * alpha * alpha;
    const auto on = [&](double x) { return std::clamp(x, 0.0, basis_.length); };
    nearest = steep ? 0 : on(foot - root - shift);
    farthest = steep ? basis_.length : on((foot - root + shift) / shortened);
    arm = farthest > 0 ? farthest + deflection : 0;
}

// From the distances of the disc's centre, which moves, from a straight beam in the middle of the angles and from its
// root; the frame turns. Every point of the bent beam is next to one of the straight beam, and the other way round but
// for what the beam shortens by; and the root is no farther than its distance.
void PartBounds::bound_gap(double distance, double to_root, double turn, double moved) {
    const double root = std::fabs(system_.problem().hub.radius), radius = system_.problem().cam->radius,
                 touching = radius + system_.offset() - system_.phase().gap_offset;
    const double shortened = 0.5 * root * alpha * alpha, around = turn * basis_.reach + moved + deflection + shortened;
    gap_low = distance - around - touching;
    rim_share = gap_low > 0 ? radius / (radius + gap_low) : 1;
    gap_high = std::min(distance + around + 0.5 * basis_.length * inclination * inclination,
                        to_root + root * (turn + alpha) + shortened + moved) -
               touching;
}

// The law is convex in the penetration and linear in its rate: its slopes just beyond the deepest and fastest point are
// the largest.
void PartBounds::bound_force() {
    double depth = 0, rate = 0;
    for (int k = 0; k < TouchSamples::kCount; ++k) {
        depth = std::max(depth, std::fabs(part.touch->gap[k]));
        rate = std::max(rate, std::fabs(part.touch->gap_rate[k]));
    }
    const double least = kFollowedRadians / part.length();
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const ModeBasis::Group& of = basis_.groups[g];
        for (int k = 0; k < groups[g].free_count; ++k) {
            const ModeVibrations::Free& v = groups[g].free[k];
            depth += sum(where_above(v.frequency, least, of.shape * v.value));
            rate += sum(where_above(v.frequency, least, of.shape * v.rate + of.slope * (slide * v.value)));
        }
    }
    const double more = kSlopeProbe * depth;
    const auto law = [&](double d, double v) { return system_.normal_law().force(d, v, system_.phase().approach); };
    force = law(depth, rate);
    force_per_depth = more > 0 ? (law(depth + more, rate) - force) / more : 0;
    force_per_rate = rate > 0 ? (force - law(depth, 0)) / rate : 0;
}

}  // namespace beamcam::sim
