// Newton's method for systems of nonlinear equations, with a Jacobian by finite differences.
#pragma once

#include <Eigen/Core>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"

namespace beamcam::sim {

inline constexpr int kMaxHalvings = 20;            // of one step
inline constexpr double kNewtonDifference = 1e-7;  // of an unknown's magnitude: step of the finite differences

// Half the difference of f between x + step and x − step.
template <class F>
Eigen::VectorXd central_difference(F&& f, const Eigen::VectorXd& x, const Eigen::VectorXd& step) {
    Eigen::VectorXd plus(x.size()), minus(x.size());
    f(x + step, plus);
    f(x - step, minus);
    return 0.5 * (plus - minus);
}

// Solves function(x, residual) for x from the given guess; false if it does not converge. scale[i] and size[i] are the
// natural magnitudes of unknown i and of residual i, which make quantities of different units comparable.
template <class F>
bool newton(F&& function, Eigen::VectorXd& x, const Eigen::VectorXd& scale, const Eigen::VectorXd& size) {
    const Eigen::Index n = x.size();
    Eigen::VectorXd f(n), g(n);
    Eigen::MatrixXd jacobian(n, n);
    const auto residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) {
        function(at, r);
        r = r.cwiseQuotient(size).eval();
    };
    residual(x, f);
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
        for (Eigen::Index j = 0; j < n; ++j) {
            const Eigen::VectorXd step = kNewtonDifference * scale[j] * Eigen::VectorXd::Unit(n, j);
            jacobian.col(j) = central_difference(residual, x, step) / kNewtonDifference;
        }
        const Eigen::VectorXd dx = solve(jacobian, -f).cwiseProduct(scale);
        if (!dx.allFinite()) return false;
        double factor = 1;  // damping: halved until the residual does not grow
        const double before = f.norm();
        for (int half = 0;; ++half, factor *= 0.5) {
            const Eigen::VectorXd tried = x + factor * dx;
            residual(tried, g);
            if (g.norm() <= before || half > kMaxHalvings) {
                x = tried;
                f = g;
                break;
            }
        }
        if ((factor * dx).cwiseQuotient(scale).cwiseAbs().maxCoeff() < kLongRounding) return true;
    }
    return f.norm() < kNegligible;
}

}  // namespace beamcam::sim
