// Bending shapes of the beam: eigenfunctions of y⁗ = β⁴ y, free at the tip, and at the root either
// clamped (`cantilever`) or carried by the freely turning hub (`hub-beam`): y(0) = a y′(0) and
// y″(0) − a y‴(0) + (I_h/ρA) β⁴ y′(0) = 0, which is orthogonality to the rigid turn (S3).
//
// Written as A cos βx + B sin βx + C e^{−βx} + D e^{−β(L−x)}: every term is bounded, so forty modes
// are as accurate as one. Normalized so that ρA∫y² + I_h y′(0)² = m, the mass of the beam:
// coordinates are in metres, and y(L) = ±2 for the clamped ones (S4).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

class Shapes {
  public:
    // The shapes of this problem's resolved basis, `beam.modes` of them (none for `rigid`).
    static Shapes of(const Problem& problem);
    static Shapes cantilever(int count, double length);
    // `inertia` is I_h/(ρA) [m³].
    static Shapes hub_beam(int count, double length, double radius, double inertia);

    int count() const { return static_cast<int>(beta_.size()); }
    double beta(int i) const { return beta_[static_cast<std::size_t>(i)]; }  // [1/m]
    // At most |y_i| anywhere; |y_i′| <= β times it, |y_i″| <= β² times it.
    double bound(int i) const;
    // Values and derivatives at x in [0, L]; any pointer may be null. Arrays of `count` numbers:
    // y [–], y1 = dy/dx [1/m], y2 [1/m²], y3 [1/m³].
    void evaluate(double x, double* y, double* y1, double* y2, double* y3 = nullptr) const;

  private:
    struct Coefficients {
        double a, b, c, d;
    };
    double length_ = 1;
    std::vector<double> beta_;
    std::vector<Coefficients> coefficients_;
};

}  // namespace beamcam::sim
