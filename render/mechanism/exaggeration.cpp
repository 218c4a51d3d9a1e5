#include "render/mechanism/exaggeration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

using sim::Pose;
using sim::Problem;
using sim::unit;

double smoothstep(double from, double to, double x) {
    const double s = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return s * s * (3 - 2 * s);
}

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

Vec2 turned(Vec2 v, double angle) {
    const Vec2 u = unit(angle);
    return {u.x * v.x - u.y * v.y, u.y * v.x + u.x * v.y};
}

// Distance from O at which a straight beam touches the disc; 0: O is inside it.
double straight_reach(const Problem& problem, const Pose& pose) {
    const double d = norm(pose.disc_centre), r = pose.disc_radius + sim::contact_offset(problem);
    return d <= r ? 0 : std::sqrt(d * d - r * r);
}

// The centre line's direction at the point nearest the cam.
Vec2 tangent_at_nearest(const Problem& problem, const Pose& pose) {
    const double at = pose.nearest->x / problem.beam.length * static_cast<double>(pose.centreline.size() - 1);
    const auto i = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(pose.centreline.size() - 2)));
    return pose.centreline[i + 1] - pose.centreline[i];
}

// Side of the beam on which the cam lies, at the nearest point: ±1, or between if that is an end of the beam.
double cam_side(const Problem& problem, const Pose& pose) {
    if (!problem.cam || !pose.nearest) return 0;
    const Vec2 t = tangent_at_nearest(problem, pose);
    const double length = norm(t), across = length > 0 ? dot(pose.nearest->normal, sim::perp(t)) / length : 0.0;
    return std::copysign(smoothstep(0, 0.5, std::abs(across)), across);
}

// 1 if the beam may touch the cam, 0 if its root is the point nearest the cam: the beam points away.
double towards_cam(const Problem& problem, const Pose& pose) {
    if (!problem.cam || !pose.nearest) return 0;
    const double of_root =
        norm(pose.centreline.front() - pose.disc_centre) - pose.disc_radius - sim::contact_offset(problem);
    return of_root > 0 ? 1 - smoothstep(0.7, 1, pose.nearest->gap / of_root) : 1;
}

// 1 if the point nearest the cam fixes the base line, 0 if not (the beam is far away).
double cam_weight(const Problem& problem, const Pose& pose) {
    if (!problem.cam || !pose.nearest) return 0;
    const double l = problem.beam.length, reach = straight_reach(problem, pose);
    if (!(reach > 0)) return 0;
    const double stations_from_axis = pose.nearest->x + problem.hub.radius;
    return smoothstep(0.2 * reach, 0.6 * reach, stations_from_axis) *
           (1 - smoothstep(0.15 * l, 0.45 * l, pose.nearest->gap));
}

// Angle of the least-squares line through O, about which free vibration is visible. For a prescribed hub: its angle,
// since the clamp does not rotate.
double mean_angle(const Problem& problem, const Pose& pose) {
    if (sim::is_prescribed(problem.hub.drive)) return pose.theta;
    double xy = 0, xx = 0;
    for (Vec2 p : pose.centreline) {
        const Vec2 local = turned(p, -pose.theta);
        xy += local.x * local.y, xx += local.x * local.x;
    }
    return pose.theta + (xx > 0 ? std::atan(xy / xx) : 0.0);
}

// The point of the centre line nearest the cam.
Vec2 nearest_on_line(const Problem& problem, const Pose& pose) {
    const double reach = pose.disc_radius + sim::contact_offset(problem) + pose.nearest->gap;
    return pose.disc_centre + pose.nearest->normal * reach;
}

double base_angle(const Problem& problem, const Pose& pose, double weight) {
    const double mean = mean_angle(problem, pose);
    if (weight == 0) return mean;
    const Vec2 p = nearest_on_line(problem, pose);
    return mean + weight * wrapped(std::atan2(p.y, p.x) - mean);
}

struct Foot {
    Vec2 point;
    double distance = 0, station = 0;  // station: index with fraction
};
Foot foot_on(const std::vector<Vec2>& line, Vec2 from) {
    Foot best{line.front(), norm(line.front() - from), 0};
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const Vec2 a = line[i], ab = line[i + 1] - a;
        const double length2 = dot(ab, ab);
        const double s = length2 > 0 ? std::clamp(dot(from - a, ab) / length2, 0.0, 1.0) : 0.0;
        const Vec2 p = a + ab * s;
        const double distance = norm(p - from);
        if (distance < best.distance) best = {p, distance, static_cast<double>(i) + s};
    }
    return best;
}

// The rotation about O that brings the line to `distance` from the disc's centre, by Newton's method: rotating the line
// by δ is rotating the centre by −δ, and d(distance)/dδ = (k × point)·n.
std::optional<double> turn_to(const std::vector<Vec2>& line, Vec2 centre, double distance, double scale) {
    double turn = 0;
    for (int i = 0; i < 30; ++i) {
        const Vec2 c = turned(centre, -turn);
        const Foot foot = foot_on(line, c);
        const double miss = foot.distance - distance;
        if (std::abs(miss) < 1e-9 * scale) return turn;
        if (!(foot.distance > 0)) return {};
        const Vec2 n = (foot.point - c) * (1 / foot.distance);
        const double rate = dot(sim::perp(foot.point), n);
        if (std::abs(rate) < 1e-3 * scale) return {};
        turn -= std::clamp(miss / rate, -0.2, 0.2);
        if (std::abs(turn) > 0.6) return {};
    }
    return {};
}

void add_normals(DrawnBeam& beam) {
    const std::size_t n = beam.line.size();
    beam.left.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 t = beam.line[std::min(i + 1, n - 1)] - beam.line[i == 0 ? 0 : i - 1];
        const double length = norm(t);
        beam.left[i] = length > 0 ? sim::perp(t) * (1 / length) : Vec2{0, 1};
    }
}

// Slope of the drawn base-frame deflection at the contact, relative to the true one.
double contact_tilt(const Problem& problem, const Pose& pose, double base, double factor) {
    const Vec2 t = turned(tangent_at_nearest(problem, pose), -base);
    return std::atan2(factor * t.y, t.x) - std::atan2(t.y, t.x);
}

double largest_deflection(const Pose& pose, double base) {
    double most = 0;
    for (Vec2 p : pose.centreline) most = std::max(most, std::abs(turned(p, -base).y));
    return most;
}

}  // namespace

DrawnBeam drawn_beam(const Problem& problem, const Pose& pose, double factor, double depth, const Problem* reference) {
    DrawnBeam beam;
    beam.line = pose.centreline;
    const double weight = cam_weight(problem, pose), base = base_angle(problem, pose, weight);
    beam.base_angle = base;
    const double offset = problem.cam ? sim::contact_offset(problem) : 0.0;
    if (factor != 1) {
        for (Vec2& p : beam.line) {
            const Vec2 local = turned(p, -base);
            p = turned({local.x, factor * local.y}, base);
        }
        if (weight > 0) {
            const double requested = pose.disc_radius + offset + std::max(pose.nearest->gap, 0.0);
            const auto turn = turn_to(beam.line, pose.disc_centre, requested, problem.beam.length);
            beam.clear = turn.has_value();
            if (turn) {
                for (Vec2& p : beam.line) p = turned(p, weight * *turn);
                beam.base_angle += weight * *turn;
            }
        }
    }
    add_normals(beam);
    beam.side = cam_side(problem, pose) * towards_cam(problem, pose);
    const bool borrowed = !problem.cam && reference && reference->cam;
    if (borrowed) beam.side = 1;
    beam.low = -depth / 2 + beam.side * (depth / 2 - (borrowed ? sim::contact_offset(*reference) : offset));
    beam.high = beam.low + depth;
    if (problem.cam && pose.nearest) {
        const Foot foot = foot_on(beam.line, pose.disc_centre);
        DrawnContact contact;
        contact.normal = foot.distance > 0 ? (foot.point - pose.disc_centre) * (1 / foot.distance) : Vec2{0, 1};
        contact.on_disc = pose.disc_centre + contact.normal * pose.disc_radius;
        contact.on_face = foot.point - contact.normal * offset;
        contact.x = foot.station / static_cast<double>(beam.line.size() - 1) * problem.beam.length;
        contact.gap = foot.distance - pose.disc_radius - offset;
        // 1e-5 of the length is a hundredth of a pixel in a full-size picture.
        if (factor != 1 && contact.gap < -1e-5 * problem.beam.length) beam.clear = false;
        // A contact drawn far from the true place on the beam would be wrong.
        constexpr double kElsewhere = 0.05;  // of the length; automatic factors reach about half of it
        if (factor != 1 && pose.nearest->touching &&
            std::abs(contact.x - pose.nearest->x) > kElsewhere * problem.beam.length)
            beam.clear = false;
        beam.contact = contact;
    }
    return beam;
}

double film_factor(const Problem& problem, std::size_t frames, const std::function<Pose(std::size_t)>& pose_of,
                   std::optional<double> requested) {
    constexpr double kShare = 0.10, kTilt = 0.25;  // of the length; [rad]
    constexpr double kMost = 50;                   // what bends less is drawn straight
    if (problem.beam.model == sim::ModelKind::rigid) return 1;
    double factor = requested.value_or(1e6);
    if (!requested) {
        double deflection = 0, slope = 0;
        for (std::size_t k = 0; k < frames; ++k) {
            const Pose pose = pose_of(k);
            const double weight = cam_weight(problem, pose), base = base_angle(problem, pose, weight);
            deflection = std::max(deflection, largest_deflection(pose, base));
            if (pose.nearest && pose.nearest->touching && problem.cam)
                slope = std::max(slope, std::abs(contact_tilt(problem, pose, base, 2)));
        }
        // Below a millionth of the length there are only rounding errors.
        if (deflection < 1e-6 * problem.beam.length) return 1;
        factor = kShare * problem.beam.length / deflection;
        if (slope > 0) factor = std::min(factor, kTilt / slope);
        factor = factor > 1 ? round_down_125(std::min(factor, kMost)) : 1.0;
    }
    return clear_factor(problem, frames, pose_of, factor);
}

double clear_factor(const Problem& problem, std::size_t frames, const std::function<Pose(std::size_t)>& pose_of,
                    double factor) {
    const auto clear = [&](double n) {
        for (std::size_t k = 0; k < frames; ++k)
            if (!drawn_beam(problem, pose_of(k), n, beam_depth(problem.beam)).clear) return false;
        return true;
    };
    while (factor > 1 && !clear(factor)) factor = round_down_125(factor * 0.999);
    return std::max(factor, 1.0);
}

}  // namespace beamcam::render
