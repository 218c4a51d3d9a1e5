// Bounds of modes and hub within a step that is a polynomial in time, from its states at both ends and the Gauss nodes;
// and the contact there. The same as the steps of the exponential collocation provide by themselves.
#pragma once

#include <array>
#include <vector>

#include "sim/integrate/integrator.hpp"
#include "sim/observe/mode_basis.hpp"

namespace beamcam::sim {

class PolynomialBounds {
  public:
    explicit PolynomialBounds(const ModeBasis& basis);  // which must outlive it

    // `states`: at both ends of [from, to] and, between them, at its nodes.
    using States = std::array<const double*, kNodes + 2>;
    void set(System& system, double from, double to, const States& states);
    const ModalBounds& modes() const { return modes_; }
    const MotionBounds& motion() const { return motion_; }

  private:
    ModalBounds::Mode bound(std::size_t i, double h, Lanes& rate, Lanes& force);
    void bound_hub(System& system, double from, double to);
    void bound_points();
    void bound_power(System& system, double h, const States& states);

    const ModeBasis& basis_;
    std::vector<Lanes> q_, rate_, force_;                        // at the nodes
    std::vector<double> first_, last_, first_rate_, last_rate_;  // at the ends; the first entry is the frame's
    Lanes angle_{}, theta_dot_{};
    ModalBounds modes_;
    MotionBounds motion_;
};

}  // namespace beamcam::sim
