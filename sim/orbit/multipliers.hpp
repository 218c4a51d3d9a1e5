// The multipliers of a periodic orbit: eigenvalues of a product of matrices, small ones to the same relative accuracy
// as large ones.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace beamcam::sim {

// The eigenvalues of the product of all factors, the first one rightmost, in descending order of magnitude. A factor
// may be singular.
std::vector<std::complex<double>> multipliers(const std::vector<Eigen::MatrixXd>& factors);

}  // namespace beamcam::sim
