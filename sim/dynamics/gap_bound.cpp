#include "sim/dynamics/gap_bound.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/assert.hpp"
#include "sim/beam/shapes.hpp"

namespace beamcam::sim {

constexpr double kSingleFoot = 0.5;     // limit of |v″| × distance of the disc; at 1 a second foot can appear
constexpr double kLeastShapeBound = 3;  // bounds all shapes of a beam that does not reach beyond its hinge

GapBound::GapBound(const Problem& problem, const Model& model, const TurningCam& cam)
    : modes_(model.size() - 1),
      exact_(problem.beam.model == ModelKind::exact),
      length_(model.length()),
      radius_(problem.hub.radius),
      offset_(contact_offset(problem)),
      cam_(cam) {
    if (modes_ == 0 || exact_) return;
    const Shapes shapes = Shapes::of(problem);
    for (int i = 0; i < modes_; ++i) {
        shape_bounds_.push_back(std::max(kLeastShapeBound, shapes.bound(i)));
        wave_numbers_.push_back(shapes.beta(i));
    }
}

// Of `exact` the curvature is Σ q_j P_j′(z)·2/L, and |P_j′| <= j(j + 1)/2.
bool GapBound::nearly_straight(const double* q) const {
    double curvature = 0;
    if (exact_)
        for (int j = 1; j <= modes_; ++j) curvature += j * (j + 1) / length_ * std::fabs(q[j - 1]);
    for (std::size_t i = 0; i < shape_bounds_.size(); ++i)
        curvature += shape_bounds_[i] * wave_numbers_[i] * wave_numbers_[i] * std::fabs(q[i]);
    const double far = length_ + std::fabs(radius_) + norm(cam_.axis()) + cam_.shape().largest_arm();
    return curvature * far < kSingleFoot;
}

// A lower bound of the gap of the straight beam at the frame's angle. For a disc it is the gap itself: the distance of
// B from the beam. The distance of a point from a convex cam is at least its distance beyond any tangent: here the one
// along the beam, which gives the gap of a beam that reaches the foot, and the one across the line from the axis to the
// beam's nearest point.
double GapBound::straight_gap(double angle, double t) const {
    const Vec2 along = unit(angle);
    const auto nearest = [&](Vec2 to) { return std::clamp(dot(to, along), radius_, radius_ + length_) * along; };
    if (cam_.is_disc()) {
        const OsculatingDisc disc = cam_.disc(t, along);
        return norm(disc.centre - nearest(disc.centre)) - disc.radius - offset_;
    }
    const auto beyond = [&](Vec2 normal) {
        const double height = cam_.shape().at(cam_.alpha(t, normal)).h;
        const double root = dot(radius_ * along - cam_.axis(), normal), tip = root + length_ * dot(along, normal);
        return std::min(root, tip) - height - offset_;
    };
    const Vec2 across = perp(along), apart = nearest(cam_.axis()) - cam_.axis();
    const double faced = beyond(dot(across, cam_.axis()) < 0 ? across : -across), away = norm(apart);
    return away > 0 ? std::max(faced, beyond(apart * (1 / away))) : faced;
}

// The gap of the straight beam, less the largest contributions of bending, rotation and the cam's motion.
double GapBound::lower_bound(const DriveLaw& drive, double t, double h, const double* xi, const double* spread) const {
    BEAMCAM_ASSERT(h >= 0);
    double angle = xi[0], rotation = spread[0];
    if (drive.prescribed()) {
        angle = drive.motion(t).angle;
        rotation = 0;
        for (const double side : {-h, h}) {
            // Within a step the rate of every drive law is monotone or quadratic in time.
            const HubMotion now = drive.motion(t), then = drive.motion(t + side);
            rotation = std::max({rotation, std::fabs(h * now.rate), std::fabs(h * then.rate),
                                 std::fabs(h * (now.rate + 0.5 * side * now.acceleration))});
        }
    }
    return straight_gap(angle, t) - deflection(xi, spread) - rotation * (std::fabs(radius_) + length_) -
           h * std::fabs(cam_.speed()) * cam_.shape().largest_slope();
}

// Upper bound of the distance between a point of the beam and the same point of a straight beam. Foreshortening adds at
// most ½∫v′² + ½|a|α², with α the slope at the root. Of `exact`, a section angle ψ − θ moves the points beyond it by at
// most L|ψ − θ|, and |ψ − θ| <= 2Σ|q|.
double GapBound::deflection(const double* xi, const double* spread) const {
    double bending = 0, slope = 0;
    for (int i = 0; i < modes_; ++i) {
        const double q = std::fabs(xi[i + 1]) + spread[i + 1];
        if (exact_) {
            bending += 2 * length_ * q;
        } else {
            const auto k = static_cast<std::size_t>(i);
            bending += shape_bounds_[k] * q;
            slope += shape_bounds_[k] * wave_numbers_[k] * q;
        }
    }
    return bending + 0.5 * (length_ + std::fabs(radius_)) * slope * slope;
}

double GapBound::travel(const double* change) const {
    const double straight[kMaxSize] = {};
    return std::fabs(change[0]) * (std::fabs(radius_) + length_) + deflection(straight, change);
}

}  // namespace beamcam::sim
