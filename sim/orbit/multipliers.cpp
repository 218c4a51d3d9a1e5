#include "sim/orbit/multipliers.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <tuple>

#include "sim/base/linear_algebra.hpp"

namespace beamcam::sim {
namespace {

std::vector<std::complex<double>> sorted(const Eigen::VectorXcd& values) {
    std::vector<std::complex<double>> all(values.begin(), values.end());
    const auto key = [](const std::complex<double>& m) { return std::tuple(-std::abs(m), -m.imag()); };
    std::ranges::stable_sort(all, {}, key);
    return all;
}

}  // namespace

// An eigenvalue μ of the product A is uncertain by ε|A|, one of its inverse, 1/μ, by ε|A⁻¹|.
std::vector<std::complex<double>> multipliers(const std::vector<Eigen::MatrixXd>& factors) {
    Eigen::MatrixXd product = factors.front(), inverse = factors.front().inverse();
    for (std::size_t k = 1; k < factors.size(); ++k) {
        product = factors[k] * product;
        inverse = inverse * factors[k].inverse();
    }
    std::vector<std::complex<double>> all = sorted(eigenvalues(product));
    if (factors.size() == 1 || !inverse.allFinite()) return all;
    const std::vector<std::complex<double>> small = sorted(eigenvalues(inverse).cwiseInverse());
    const double equal = product.norm() / inverse.norm();  // |μ|² of the same relative uncertainty
    for (std::size_t i = 0; i < all.size(); ++i)
        if (std::norm(all[i]) < equal) all[i] = small[i];
    return all;
}

}  // namespace beamcam::sim
