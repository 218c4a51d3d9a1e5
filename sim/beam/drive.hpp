// The drive of the hub: none, a torque τ(t), or a prescribed angle θ(t). MODEL.md §6.
#pragma once

#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

struct HubMotion {
    double angle = 0, rate = 0, acceleration = 0;  // [rad], [rad/s], [rad/s²]
};

// The drive whose clock starts at `t` of this one's.
Drive later(const Drive& drive, double t);

class DriveLaw {
  public:
    DriveLaw(const Drive& drive, double start_angle);
    bool prescribed() const { return prescribed_; }
    bool has_torque() const { return has_torque_; }
    double torque(double t) const;     // [N m]; 0 unless a torque law
    HubMotion motion(double t) const;  // only if prescribed; θ(0) is the initial angle, or that of the table
    // Instants > 0 at which the law is not smooth. Integration steps end there.
    const std::vector<double>& kinks() const { return kinks_; }

  private:
    Drive drive_;
    double start_;
    bool prescribed_, has_torque_;
    std::vector<double> kinks_;
    std::vector<double> spline_;  // second derivatives of an angle table (S93)
};

}  // namespace beamcam::sim
