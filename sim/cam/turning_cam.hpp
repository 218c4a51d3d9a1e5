// The cam as it turns: its angle, and the disc that osculates its outline at a point of contact. MODEL.md §7.
#pragma once

#include <cmath>
#include <memory>

#include "sim/cam/cam_shape.hpp"

namespace beamcam::sim {

// The disc about the outline's centre of curvature, which moves with the cam. Up to their second derivatives, distance
// and normal of a point near the outline are those of this disc; a disc osculates itself everywhere (S109).
struct OsculatingDisc {
    Vec2 centre, velocity;  // B [m], Ḃ [m/s]
    double radius = 0;      // ρ [m]
};

class TurningCam {
  public:
    explicit TurningCam(const Problem& problem);

    const CamShape& shape() const { return *shape_; }
    bool is_disc() const { return is_disc_; }
    Vec2 axis() const { return axis_; }                           // C
    double speed() const { return speed_; }                       // ω
    double angle(double t) const { return phase_ - speed_ * t; }  // ψ (S23)
    // The angle α in the cam's frame of a normal in space, and contact_s at the point of the outline that has it.
    double alpha(double t, Vec2 normal) const { return std::atan2(normal.y, normal.x) - angle(t); }
    double place(double t, Vec2 normal) const;

    // The disc at the point of the outline with the outward unit normal n in space.
    OsculatingDisc disc(double t, Vec2 normal) const;
    // The disc at the point of the outline that is nearest to a point in space, which lies outside or less than a
    // radius of curvature within. `normal`: a guess of the outward normal there.
    OsculatingDisc nearest(double t, Vec2 point, Vec2 normal) const;

  private:
    double nearest_normal(Vec2 point, double alpha) const;
    bool refine_normal(Vec2 point, double& alpha) const;

    std::shared_ptr<const CamShape> shape_;
    Vec2 axis_;
    double phase_, speed_, radius_, eccentricity_;
    bool is_disc_;
};

}  // namespace beamcam::sim
