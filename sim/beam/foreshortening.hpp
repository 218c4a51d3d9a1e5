// The foreshortening of an inextensible beam: H(x) = ∫₀ˣφ′φ′ᵀ in closed form, for shapes with φ⁗ = β⁴φ. MODEL.md (S5a).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/beam/model.hpp"
#include "sim/beam/shapes.hpp"

namespace beamcam::sim {

// All shapes and their first three derivatives at one x.
struct ShapesAt {
    double x = -1;
    double y[kMaxModes], y1[kMaxModes], y2[kMaxModes], y3[kMaxModes];

    void evaluate(const Shapes& shapes, double where) {
        x = where;
        shapes.evaluate(x, y, y1, y2, y3);
    }
};

class Foreshortening {
  public:
    explicit Foreshortening(const Shapes& shapes);

    // H(x), column-major N².
    void matrix(const ShapesAt& here, double* h) const;
    // hq ← H(x) q.
    void times(const ShapesAt& here, const double* q, double* hq) const;

  private:
    void antiderivative(const ShapesAt& here, const double* q, double* out) const;

    std::vector<double> beta4_;
    Eigen::MatrixXd difference_;  // 1/(β_i⁴ − β_j⁴), zero on the diagonal
    Eigen::MatrixXd root_;        // the antiderivative of φ_i′φ_j′ at x = 0
};

}  // namespace beamcam::sim
