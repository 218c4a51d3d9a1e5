// The constant matrices of the models that are quadratic in modal coordinates. MODEL.md §4.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/beam/shapes.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// The integrals of MODEL.md (S8)–(S12) over a set of shapes.
struct ModalMatrices {
    double J = 0;                // I_h + ρA∫(a+x)² [kg m²]
    double S = 0;                // ρA∫(a+x) [kg m]
    Eigen::VectorXd U, W;        // ρA∫(a+x)φ [kg m], ρA∫φ [kg]
    Eigen::VectorXd K;           // EI∫φ″², diagonal [N/m]
    Eigen::MatrixXd M, D, G;     // ρA∫φφᵀ, stiffening, gravity [kg], [kg], [kg/m]
    Eigen::MatrixXd P0, P1, P2;  // ρA∫x^k φ′φ′ᵀ, only for the model `paper` (S15)
    Eigen::VectorXd slope;       // φ′(0)
};
ModalMatrices modal_matrices(const Problem& problem, const Shapes& shapes, Basis basis);

// A vector c with |B_ij| <= c_i c_j, in proportion to the roots of `squares` > 0. B need not be definite: a hub of
// negative radius makes D and G negative for some shapes.
std::vector<double> bounding_vector(const Eigen::MatrixXd& b, const Eigen::VectorXd& squares);

}  // namespace beamcam::sim
