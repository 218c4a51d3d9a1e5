#include "sim/beam/foreshortening.hpp"

#include <cmath>

namespace beamcam::sim {

namespace {

// The antiderivative of φ_i′², of which `i` is the index in `at`.
double diagonal_entry(const ShapesAt& at, std::size_t i, double b4) {
    const double y = at.y[i], y1 = at.y1[i], y2 = at.y2[i], y3 = at.y3[i];
    return 0.25 * (at.x * (y1 * y1 - 2 * y2 * y + y3 * y3 / b4) + 3 * y1 * y - y2 * y3 / b4);
}

}  // namespace

Foreshortening::Foreshortening(const Shapes& shapes) {
    const auto n = static_cast<Eigen::Index>(shapes.count());
    difference_ = root_ = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) beta4_.push_back(std::pow(shapes.beta(i), 4));
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            if (i != j)
                difference_(i, j) = 1 / (beta4_[static_cast<std::size_t>(i)] - beta4_[static_cast<std::size_t>(j)]);
    ShapesAt here;
    here.evaluate(shapes, 0);
    for (Eigen::Index j = 0; j < n; ++j) {
        const Eigen::VectorXd unit_coordinate = Eigen::VectorXd::Unit(n, j);
        antiderivative(here, unit_coordinate.data(), root_.col(j).data());
    }
}

// Σ_j A_ij(x) q_j with A_ij the antiderivative of φ_i′φ_j′, from φ⁗ = β⁴φ and by parts:          (S5a)
//   i ≠ j: (β_i⁴ φ_i φ_j′ − φ_i‴ φ_j″ + φ_i″ φ_j‴ − β_j⁴ φ_i′ φ_j)/(β_i⁴ − β_j⁴)
//   i = j: ¼[x(φ′² − 2φ″φ + φ‴²/β⁴) + 3φ′φ − φ″φ‴/β⁴]
// The inner loops run over i, so that compilers vectorize them without a change of the order of summation.
void Foreshortening::antiderivative(const ShapesAt& here, const double* q, double* out) const {
    const std::size_t n = beta4_.size();
    double s0[kMaxModes] = {}, s1[kMaxModes] = {}, s2[kMaxModes] = {}, s3[kMaxModes] = {};
    for (std::size_t j = 0; j < n; ++j) {
        const double* difference = difference_.col(static_cast<Eigen::Index>(j)).data();
        for (std::size_t i = 0; i < n; ++i) {
            const double c = difference[i] * q[j];
            s0[i] += c * beta4_[j] * here.y[j];
            s1[i] += c * here.y1[j];
            s2[i] += c * here.y2[j];
            s3[i] += c * here.y3[j];
        }
    }
    for (std::size_t i = 0; i < n; ++i)
        out[i] = diagonal_entry(here, i, beta4_[i]) * q[i] +
                 (beta4_[i] * here.y[i] * s1[i] - here.y3[i] * s2[i] + here.y2[i] * s3[i] - here.y1[i] * s0[i]);
}

void Foreshortening::times(const ShapesAt& here, const double* q, double* hq) const {
    antiderivative(here, q, hq);
    for (Eigen::Index j = 0; j < root_.cols(); ++j)
        for (Eigen::Index i = 0; i < root_.rows(); ++i) hq[i] -= root_(i, j) * q[j];
}

void Foreshortening::matrix(const ShapesAt& here, double* h) const {
    const std::size_t n = beta4_.size();
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = 0; i < n; ++i) {
            const auto r = static_cast<Eigen::Index>(i), c = static_cast<Eigen::Index>(j);
            const double value =
                i == j ? diagonal_entry(here, i, beta4_[i])
                       : difference_(r, c) * (beta4_[i] * here.y[i] * here.y1[j] - here.y3[i] * here.y2[j] +
                                              here.y2[i] * here.y3[j] - beta4_[j] * here.y1[i] * here.y[j]);
            h[j * n + i] = value - root_(r, c);
        }
    }
}

}  // namespace beamcam::sim
