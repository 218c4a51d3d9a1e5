#include "sim/dynamics/contact_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/dynamics/constants.hpp"

namespace beamcam::sim {
ContactGeometry::ContactGeometry(const Problem& problem, const Model& model)
    : cam_(problem.cam.value_or(Cam{})),
      hub_radius_(problem.hub.radius),
      length_(model.length()),
      offset_(contact_offset(problem)),
      samples_(problem.beam.model == ModelKind::exact ? 4 * model.size() + kIntervalsOfExact
                                                      : 2 * model.size() + kIntervalsOfModes) {}

// A starting point for Newton's method: the foot on the straight beam if there is only one foot, else the nearest of a
// few points, which is not where a straight beam is farther by twice the deflection.
double ContactGeometry::near_foot(const Model& model, const GapBound& bound, Vec2 disc) const {
    const double* q = model.coordinates();
    const Vec2 along = unit(q[0]);
    const double straight_foot = std::clamp(dot(disc, along) - hub_radius_, 0.0, length_);
    if (bound.nearly_straight(q + 1)) return straight_foot;
    const double none[kMaxSize] = {}, step = length_ / samples_;
    const auto straight = [&](double x) { return norm((hub_radius_ + x) * along - disc); };
    const double most = straight(straight_foot) + step + 2 * bound.deflection(q, none);
    double best = std::numeric_limits<double>::infinity(), nearest = straight_foot;
    BeamPoint at;
    for (int i = 0; i <= samples_; ++i) {
        const double x = length_ * i / samples_;
        if (straight(x) > most) continue;
        model.point(x, at);
        const Vec2 d = at.r - disc;
        const double distance = dot(d, d);
        if (distance < best) {
            best = distance;
            nearest = x;
        }
    }
    return nearest;
}

// The foot of the perpendicular from B: a root of r′·(r − B) with r″·(r − B) + r′·r′ > 0          (S24)
BeamPoint ContactGeometry::foot(const Model& model, Vec2 disc, double x, ContactState& c) const {
    BeamPoint at;
    double low = 0, high = length_;
    c.at_end = false;
    for (int iteration = 0; iteration < kMaxFootSteps; ++iteration) {
        model.point(x, at);
        const Vec2 d = at.r - disc;
        const double slope = dot(at.r1, d);
        if ((x <= 0 && slope >= 0) || (x >= length_ && slope <= 0)) {
            c.at_end = true;
            break;
        }
        if (slope > 0)
            high = std::min(high, x);
        else
            low = std::max(low, x);
        const double bend = dot(at.r2, d) + dot(at.r1, at.r1);
        double next = bend > 0 ? x - slope / bend : (slope > 0 ? low : high);
        if (bend > 0 && std::fabs(next - x) <= kLastFootChange * length_ && next > 0 && next < length_) {
            if (next != x) model.point(x = next, at);
            break;
        }
        if (next <= low || next >= high) {
            const double edge = next <= low ? low : high;
            const bool free_end = edge == 0 || edge == length_;
            next = free_end && bend > 0 ? edge : 0.5 * (low + high);
        }
        // At an end the slope there decides, however near it is.
        const bool inside = next > 0 && next < length_;
        if (next == x || (inside && std::fabs(next - x) <= kFootChange * length_)) break;
        x = next;
    }
    c.x = x;
    return at;
}

ContactState ContactGeometry::evaluate(const Model& model, const GapBound& bound, double t, double shift) const {
    ContactState c;
    const CamPose pose = cam_pose(cam_, t);
    const BeamPoint at = foot(model, pose.disc, near_foot(model, bound, pose.disc), c);
    const Vec2 d = at.r - pose.disc;
    const double distance = norm(d);
    c.normal = d * (1 / distance);
    c.tangent = -perp(c.normal);
    c.side = c.at_end ? 0 : std::copysign(1, cross(at.r1, d));
    c.gap = distance - cam_.radius - offset_ + shift;  // (S25)
    c.gap_rate = dot(c.normal, at.v - pose.velocity);  // (S26)
    // χ̇, the angular velocity of the section; the contact face is at a distance d from the centre line (S27).
    const double chi_dot = cross(at.r1, at.v1) / dot(at.r1, at.r1);
    c.slip = dot(c.tangent, at.v - pose.velocity) + offset_ * chi_dot - cam_.speed * cam_.radius;
    return c;
}

void ContactGeometry::rows(const Model& model, const ContactState& c, double* jn, double* jt) const {
    double jx[kMaxSize], jy[kMaxSize], jchi[kMaxSize];
    model.jacobian(c.x, jx, jy, jchi);
    for (int i = 0; i < model.size(); ++i) {
        jn[i] = jx[i] * c.normal.x + jy[i] * c.normal.y;
        jt[i] = jx[i] * c.tangent.x + jy[i] * c.tangent.y + offset_ * jchi[i];
    }
}

// With w = ṙ − Ḃ, D = r − B and the foot moving by ẋ:                                                      (S44)
//   ẋ = −(ṙ′·D + r′·w)/(r″·D + r′·r′),   g̈ = ṅ·w + n·(r̈ + ṙ′ẋ − B̈),   ṅ = (Ḋ − n(n·Ḋ))/|D|,   Ḋ = w + r′ẋ
double ContactGeometry::gap_acceleration_at_rest(const Model& model, double t, const ContactState& c) const {
    BeamPoint p;
    model.point(c.x, p);
    const CamPose pose = cam_pose(cam_, t);
    const Vec2 d = p.r - pose.disc, w = p.v - pose.velocity;
    const double rate = c.at_end ? 0 : -(dot(p.v1, d) + dot(p.r1, w)) / (dot(p.r2, d) + dot(p.r1, p.r1));
    const Vec2 d_rate = w + rate * p.r1;
    const Vec2 n_rate = (d_rate - dot(c.normal, d_rate) * c.normal) * (1 / norm(d));
    const Vec2 disc_acceleration = -cam_.speed * cam_.speed * (pose.disc - cam_.centre);
    return dot(n_rate, w) + dot(c.normal, model.convective(c.x) + rate * p.v1 - disc_acceleration);
}

}  // namespace beamcam::sim
