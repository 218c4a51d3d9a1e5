#include "sim/base/numerics.hpp"

#include <map>
#include <mutex>
#include <numbers>
#include <vector>

namespace beamcam::sim {

void legendre(double z, int count, double* values) {
    if (count > 0) values[0] = 1;
    if (count > 1) values[1] = z;
    for (int j = 1; j + 1 < count; ++j) values[j + 1] = ((2 * j + 1) * z * values[j] - j * values[j - 1]) / (j + 1);
}

// P_n⁽ʲ⁾ = P_{n−2}⁽ʲ⁾ + (2n − 1) P_{n−1}⁽ʲ⁻¹⁾
void legendre(double z, int count, int orders, double* values) {
    legendre(z, count, values);
    for (int j = 1; j < orders; ++j) {
        const double* lower = values;
        values += count;
        values[0] = 0;
        for (int n = 1; n < count; ++n) values[n] = (n > 1 ? values[n - 2] : 0) + (2 * n - 1) * lower[n - 1];
    }
}

namespace {

// Nodes on [−1, 1], and 2 over their weights, by Newton's method.
struct GaussRule {
    explicit GaussRule(int n) {
        std::vector<double> p(static_cast<std::size_t>(n) + 1);
        for (int k = 0; k < n; ++k) {
            double z = -std::cos(std::numbers::pi * (k + 0.75) / (n + 0.5));
            double slope = 1;
            for (int iteration = 0; iteration < 20; ++iteration) {
                legendre(z, n + 1, p.data());
                const double pn = p[static_cast<std::size_t>(n)], pm = p[static_cast<std::size_t>(n) - 1];
                slope = n * (pm - z * pn) / (1 - z * z);
                const double dz = pn / slope;
                z -= dz;
                if (std::fabs(dz) < 1e-15) break;
            }
            nodes.push_back(z);
            inverse_weights.push_back((1 - z * z) * slope * slope);
        }
    }
    std::vector<double> nodes, inverse_weights;
};

// Every model of so many shapes needs the same few rules.
const GaussRule& gauss_rule(int n) {
    static std::mutex mutex;
    static std::map<int, GaussRule> rules;
    const std::lock_guard lock(mutex);
    return rules.try_emplace(n, n).first->second;
}

}  // namespace

Quadrature gauss_legendre(int n, double length) {
    BEAMCAM_ASSERT(n >= 1 && length > 0);
    const GaussRule& unit = gauss_rule(n);
    Quadrature rule{Eigen::VectorXd(n), Eigen::VectorXd(n)};
    for (int k = 0; k < n; ++k) {
        const auto i = static_cast<std::size_t>(k);
        rule.x[k] = 0.5 * length * (1 + unit.nodes[i]);
        rule.w[k] = length / unit.inverse_weights[i];
    }
    return rule;
}

SpectralIntegral::SpectralIntegral(const Quadrature& nodes, double length)
    : length_(length), legendre_(nodes.x.size(), nodes.x.size()), primitive_(nodes.x.size()) {
    const int n = static_cast<int>(nodes.x.size());
    std::vector<double> p(static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k) {
        legendre(2 * nodes.x[k] / length - 1, n, p.data());
        // c_j = (2j+1)/2 Σ_k w_k P_j(z_k) f_k on [−1, 1]; w of [0, L] carries L/2, ∫dx another L/2.
        for (int j = 0; j < n; ++j)
            legendre_(j, k) = (2 * j + 1) / length * nodes.w[k] * p[static_cast<std::size_t>(j)] * length / 2;
    }
}

void SpectralIntegral::weights(double x, double* weights) const {
    const int n = static_cast<int>(legendre_.rows());
    const double z = 2 * x / length_ - 1;
    // ∫₋₁ᶻ P_j = (P_{j+1} − P_{j−1})/(2j+1), and z + 1 for j = 0.
    double before = 1, here = z;
    primitive_[0] = z + 1;
    for (int j = 1; j < n; ++j) {
        const double after = ((2 * j + 1) * z * here - j * before) / (j + 1);
        primitive_[j] = (after - before) / (2 * j + 1);
        before = here;
        here = after;
    }
    Eigen::Map<Eigen::VectorXd>(weights, n).noalias() = legendre_.transpose() * primitive_;
}

Eigen::MatrixXd SpectralIntegral::matrix(const Quadrature& nodes) const {
    const Eigen::Index n = nodes.x.size();
    Eigen::MatrixXd columns(n, n);
    for (Eigen::Index k = 0; k < n; ++k) weights(nodes.x[k], columns.col(k).data());
    return columns.transpose();
}

}  // namespace beamcam::sim
