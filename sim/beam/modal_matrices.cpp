#include "sim/beam/modal_matrices.hpp"

#include <cmath>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"

namespace beamcam::sim {

ModalMatrices modal_matrices(const Problem& problem, const Shapes& shapes, Basis basis) {
    const Beam& beam = problem.beam;
    const double a = problem.hub.radius, length = beam.length, rho = beam.line_density();
    const int n = shapes.count();
    ModalMatrices m;
    m.J = problem.hub.inertia + rho * (std::pow(a + length, 3) - a * a * a) / 3;
    m.S = rho * (a * length + 0.5 * length * length);
    m.U = m.W = m.K = m.slope = Eigen::VectorXd::Zero(n);
    m.M = m.D = m.G = m.P0 = m.P1 = m.P2 = Eigen::MatrixXd::Zero(n, n);
    if (n == 0) return m;

    // Products of two shapes oscillate with 2β_n; three nodes per mode and a margin integrate them to rounding.
    const Quadrature rule = gauss_legendre(3 * n + 24, length);
    const Eigen::Index nodes = rule.x.size();
    Eigen::MatrixXd y(n, nodes), y1(n, nodes), y2(n, nodes);
    for (Eigen::Index k = 0; k < nodes; ++k)
        shapes.evaluate(rule.x[k], y.col(k).data(), y1.col(k).data(), y2.col(k).data());
    const Eigen::ArrayXd x = rule.x.array(), w = rho * rule.w.array();
    m.U.noalias() = y * (w * (a + x)).matrix();  // (S8)
    m.W.noalias() = y * w.matrix();              // (S9)
    m.K.noalias() = beam.bending_stiffness() * (y2.cwiseAbs2() * rule.w);
    const auto product = [&](const Eigen::MatrixXd& f, const Eigen::ArrayXd& weight, Eigen::MatrixXd& out) {
        out = weighted_square(f, weight.matrix());
        out = 0.5 * (out + out.transpose()).eval();
    };
    product(y, w, m.M);                                                               // (S10)
    product(y1, w * (a * (length - x) + 0.5 * (length * length - x.square())), m.D);  // (S11)
    product(y1, w * (length - x), m.G);                                               // (S12)
    if (beam.model == ModelKind::paper) {
        product(y1, w, m.P0);
        product(y1, w * x, m.P1);
        product(y1, w * x.square(), m.P2);
    }
    if (basis == Basis::hub_beam) {
        // The hub turns by α = y′(0)·q inside the frame; the root sits at (a − ½aα², aα) (S13).
        shapes.evaluate(0, nullptr, m.slope.data(), nullptr);
        m.U.setZero();
        m.D.noalias() += a * m.S * m.slope * m.slope.transpose();
        m.G.noalias() += a * rho * length * m.slope * m.slope.transpose();
    }
    return m;
}

std::vector<double> bounding_vector(const Eigen::MatrixXd& b, const Eigen::VectorXd& squares) {
    const Eigen::VectorXd c = squares.cwiseSqrt();
    const double share = b.cwiseAbs().cwiseQuotient(c * c.transpose()).maxCoeff();
    const Eigen::VectorXd scaled = std::sqrt(share) * c;
    return {scaled.begin(), scaled.end()};
}

}  // namespace beamcam::sim
