#include "sim/dynamics/contact_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

// Intervals of a search along the beam, besides 2 or 4 for each coordinate: more for more curved shapes.
constexpr int kIntervalsOfModes = 9, kIntervalsOfExact = 13;

ContactGeometry::ContactGeometry(const Problem& problem, const Model& model, const TurningCam& cam)
    : cam_(cam),
      hub_radius_(problem.hub.radius),
      length_(model.length()),
      offset_(contact_offset(problem)),
      samples_(problem.beam.model == ModelKind::exact ? 4 * model.size() + kIntervalsOfExact
                                                      : 2 * model.size() + kIntervalsOfModes) {}

// The beam's normal at a point, on the side away from the cam.
Vec2 ContactGeometry::facing(const BeamPoint& at) const {
    const Vec2 across = perp(at.r1) * (1 / norm(at.r1));
    return dot(across, at.r - cam_.axis()) < 0 ? -across : across;
}

// A starting point for Newton's method: the foot on the straight beam if there is only one foot, else the nearest of a
// few points, which is not where a straight beam is farther by twice the deflection. The distance of a point is that
// from the disc that osculates the outline where its normal is the direction of the point from the axis.
double ContactGeometry::near_foot(const Model& model, const GapBound& bound, double t) const {
    const double* q = model.coordinates();
    const Vec2 along = unit(q[0]), across = perp(along);
    const OsculatingDisc faced = cam_.disc(t, dot(across, cam_.axis()) < 0 ? across : -across);
    const double straight_foot = std::clamp(dot(faced.centre, along) - hub_radius_, 0.0, length_);
    if (bound.nearly_straight(q + 1)) return straight_foot;
    const double none[kMaxSize] = {}, step = length_ / samples_;
    const auto distance = [&](const Vec2& r) {
        const auto radial = [&] { return (r - cam_.axis()) * (1 / norm(r - cam_.axis())); };
        const OsculatingDisc disc = cam_.is_disc() ? faced : cam_.disc(t, radial());
        return norm(r - disc.centre) - disc.radius;
    };
    const auto straight = [&](double x) { return distance((hub_radius_ + x) * along); };
    const double most = straight(straight_foot) + step + 2 * bound.deflection(q, none);
    double best = std::numeric_limits<double>::infinity(), nearest = straight_foot;
    BeamPoint at;
    for (int i = 0; i <= samples_; ++i) {
        const double x = length_ * i / samples_;
        if (straight(x) > most) continue;
        model.point(x, at);
        if (const double away = distance(at.r); away < best) {
            best = away;
            nearest = x;
        }
    }
    return nearest;
}

// The foot of the perpendicular from B: a root of r′·(r − B) with r″·(r − B) + r′·r′ > 0          (S24)
// B is the centre of the disc that osculates the cam where its normal is that of the beam. It moves with r, but across
// the beam once r is the foot: Newton's method still converges quadratically. At an end of the beam the disc is the one
// at the nearest point of the cam.
BeamPoint ContactGeometry::foot(const Model& model, double t, double x, ContactState& c) const {
    BeamPoint at;
    double low = 0, high = length_;
    c.at_end = false;
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
        model.point(x, at);
        if (iteration == 0 || !cam_.is_disc()) c.disc = cam_.disc(t, facing(at));
        const Vec2 d = at.r - c.disc.centre;
        const double slope = dot(at.r1, d);
        if ((x <= 0 && slope >= 0) || (x >= length_ && slope <= 0)) {
            c.at_end = true;
            if (!cam_.is_disc()) c.disc = cam_.nearest(t, at.r, facing(at));
            break;
        }
        if (slope > 0)
            high = std::min(high, x);
        else
            low = std::max(low, x);
        const double bend = dot(at.r2, d) + dot(at.r1, at.r1);
        double next = bend > 0 ? x - slope / bend : (slope > 0 ? low : high);
        if (bend > 0 && std::fabs(next - x) <= kNegligible * length_ && next > 0 && next < length_) {
            if (next != x) model.point(x = next, at);
            if (!cam_.is_disc()) c.disc = cam_.disc(t, facing(at));
            break;
        }
        if (next <= low || next >= high) {
            const double edge = next <= low ? low : high;
            const bool free_end = edge == 0 || edge == length_;
            next = free_end && bend > 0 ? edge : 0.5 * (low + high);
        }
        // At an end the slope there decides, however near it is.
        const bool inside = next > 0 && next < length_;
        if (next == x || (inside && std::fabs(next - x) <= kRounding * length_)) break;
        x = next;
    }
    c.x = x;
    return at;
}

ContactState ContactGeometry::evaluate(const Model& model, const GapBound& bound, double t, double shift) const {
    ContactState c;
    const BeamPoint at = foot(model, t, near_foot(model, bound, t), c);
    const Vec2 d = at.r - c.disc.centre;
    const double distance = norm(d);
    c.normal = d * (1 / distance);
    c.tangent = -perp(c.normal);
    c.side = c.at_end ? 0 : std::copysign(1, cross(at.r1, d));
    c.gap = distance - c.disc.radius - offset_ + shift;  // (S25)
    c.gap_rate = dot(c.normal, at.v - c.disc.velocity);  // (S26)
    // χ̇, the angular velocity of the section; the contact face is at a distance d from the centre line (S27).
    const double chi_dot = cross(at.r1, at.v1) / dot(at.r1, at.r1);
    c.slip = dot(c.tangent, at.v - c.disc.velocity) + offset_ * chi_dot - cam_.speed() * c.disc.radius;
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
    const OsculatingDisc disc = cam_.disc(t, c.normal);
    const Vec2 d = p.r - disc.centre, w = p.v - disc.velocity;
    const double rate = c.at_end ? 0 : -(dot(p.v1, d) + dot(p.r1, w)) / (dot(p.r2, d) + dot(p.r1, p.r1));
    const Vec2 d_rate = w + rate * p.r1;
    const Vec2 n_rate = (d_rate - dot(c.normal, d_rate) * c.normal) * (1 / norm(d));
    const Vec2 disc_acceleration = -cam_.speed() * cam_.speed() * (disc.centre - cam_.axis());
    return dot(n_rate, w) + dot(c.normal, model.convective(c.x) + rate * p.v1 - disc_acceleration);
}

}  // namespace beamcam::sim
