#include "sim/integrate/collocation.hpp"

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

const Collocation& Collocation::get() {
    static const Collocation instance;
    return instance;
}

Collocation::Collocation() {
    const Quadrature rule = gauss_legendre(kNodes, 1.0);
    point[0] = 0;
    for (int k = 0; k < kNodes; ++k) {
        c[k] = rule.x[k];
        b[k] = rule.w[k];
        point[static_cast<std::size_t>(k) + 1] = c[k];
    }
    for (int k = 0; k < kNodes; ++k) {
        double p[kNodes];
        sim::legendre(2 * c[k] - 1, kNodes, p);
        for (int j = 0; j < kNodes; ++j)
            legendre[static_cast<std::size_t>(j)][k] = legendre_of_node_[static_cast<std::size_t>(k)][j] =
                (2 * j + 1) * b[k] * p[j];
    }
    for (std::size_t i = 0; i < point.size(); ++i) {
        double p[kNodes][kNodes];
        sim::legendre(2 * point[i] - 1, kNodes, kNodes, p[0]);
        double power = 1;
        for (std::size_t j = 0; j < kNodes; ++j, power *= 2) {
            derive[i][j] = Lanes{};
            for (std::size_t n = 0; n < kNodes; ++n) derive[i][j] += (power * p[j][n]) * legendre[n];
        }
    }
    double middle[kNodes][kNodes], factorial = 1;
    sim::legendre(0, kNodes, kNodes, middle[0]);
    for (std::size_t j = 0; j < kNodes; ++j, factorial *= static_cast<double>(j)) {
        monomial[j] = Lanes{};
        for (std::size_t n = 0; n < kNodes; ++n) monomial[j] += (middle[j][n] / factorial) * legendre[n];
    }
    for (int k = 0; k < kNodes; ++k) {
        const Lanes w = weights_to(c[k]);
        for (std::size_t l = 0; l < kNodes; ++l) {
            integrate[l][k] = w[static_cast<int>(l)];
            slope[l][k] = derive[static_cast<std::size_t>(k) + 1][1][static_cast<int>(l)];
        }
    }
    for (std::size_t l = 0; l < kNodes; ++l) {
        integrate_twice[l] = Lanes{};
        for (std::size_t j = 0; j < kNodes; ++j) integrate_twice[l] += integrate[l][static_cast<int>(j)] * integrate[j];
    }
}

// ∫₀ˢ P_j(2u − 1) du = [P_{j+1} − P_{j−1}](2s − 1)/(2(2j+1)), and s for j = 0.
Lanes Collocation::weights_to(double s) const {
    double p[kNodes + 1];
    sim::legendre(2 * s - 1, kNodes + 1, p);
    Lanes w = s * legendre[0];
    for (std::size_t j = 1; j < kNodes; ++j)
        w += ((p[j + 1] - p[j - 1]) / (2.0 * (2 * static_cast<int>(j) + 1))) * legendre[j];
    return w;
}

Lanes Collocation::legendre_coefficients(const Lanes& nodal) const {
    Lanes out{};
    for (int l = 0; l < kNodes; ++l) out += nodal[l] * legendre_of_node_[static_cast<std::size_t>(l)];
    return out;
}

Lanes at_nodes(double start, double h, const Lanes& rate) {
    const Collocation& gauss = Collocation::get();
    Lanes out = Lanes{} + start;
    for (int l = 0; l < kNodes; ++l) out += (h * rate[l]) * gauss.integrate[static_cast<std::size_t>(l)];
    return out;
}

}  // namespace beamcam::sim
