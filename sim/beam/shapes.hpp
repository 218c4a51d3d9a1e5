// Bending shapes of the beam: eigenfunctions of y⁗ = β⁴ y, free at the tip. At the root they are clamped (`cantilever`)
// or fixed to the freely rotating hub (`hub-beam`): y(0) = a y′(0) and y″(0) − a y‴(0) + (I_h/ρA) β⁴ y′(0) = 0, which
// makes them orthogonal to the rigid rotation (S3).
//
// The form A cos βx + B sin βx + C e^{−βx} + D e^{−β(L−x)} has only bounded terms, so forty modes are as accurate as
// one. Normalization: ρA∫y² + I_h y′(0)² = m, the mass of the beam. Coordinates are in metres, and clamped shapes have
// y(L) = ±2 (S4).
#pragma once

#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

class Shapes {
  public:
    // `beam.modes` shapes of the problem's resolved basis; none for `rigid`.
    static Shapes of(const Problem& problem);
    static Shapes cantilever(int count, double length);
    // `inertia` is I_h/(ρA) [m³].
    static Shapes hub_beam(int count, double length, double radius, double inertia);

    int count() const { return static_cast<int>(beta_.size()); }
    double beta(int i) const { return beta_[static_cast<std::size_t>(i)]; }  // [1/m]
    // An upper bound b of |y_i| on [0, L]; then |y_i′| <= βb and |y_i″| <= β²b.
    double bound(int i) const;
    // Values and derivatives at x in [0, L]: y [–], y1 = dy/dx [1/m], y2 [1/m²], y3 [1/m³], arrays of `count` numbers.
    // Pointers may be null.
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
